// Trials among landmarks, under every estimator, and their images in another unit of length and with other numbers for
// the landmarks. 

#include "catch.hpp"
#include "landmark_run.hpp"
#include "slam/metamorphic.hpp"

namespace credence::test::landmark_metamorphic_test {

namespace {

ExploreSettings in_unit(ExploreSettings scenario, double factor) {
    for (double* length : {&scenario.features.step, &scenario.prior, &scenario.sensor.range_max, &scenario.sensor.sigma,
                           &scenario.noise.odometry, &scenario.radius, &scenario.cell})
        *length *= factor;
    for (std::vector<Point>* points : {&scenario.features.positions, &scenario.box})
        for (Point& point : *points) point = {factor * point.x, factor * point.y};
    return scenario;
}

/// A scenario whose landmarks have other numbers.
struct Permuted {
    std::vector<int> before;  ///< [M] by its number, its number before
    ExploreSettings scenario;

    Permuted(const ExploreSettings& of, unsigned seed) : before(of.features.positions.size()), scenario(of) {
        std::iota(before.begin(), before.end(), 0);
        std::shuffle(before.begin(), before.end(), std::mt19937(seed));
        for (std::size_t j = 0; j < before.size(); ++j)
            scenario.features.positions[j] = of.features.positions[static_cast<std::size_t>(before[j])];
    }

    AnyNoise noise(const AnyNoise& noise) const {
        return {[*this, noise](Source source, int pose, int index) {
                    const bool of_landmark = source == Source::measurement || source == Source::landmark_prior;
                    return noise.normal(source, pose, of_landmark ? before[static_cast<std::size_t>(index)] : index);
                },
                noise.uniform_draw};
    }
};

RunStep step_of(const Held& held) {
    RunStep step;
    step.truth = held.truth, step.mean = held.mean, step.covariance = held.covariance;
    return step;
}

/// The series that have no unit and no landmark of their own.
std::vector<Eigen::Index> compared_series(const ExploreSettings& scenario) {
    const std::vector<std::string> names{"nees", "nees_pose", "nees_features", "nis", "nis_rows", "unseen_features"};
    std::vector<Eigen::Index> rows;
    const std::vector<Series> declared = explore_series(scenario);
    for (std::size_t i = 0; i < declared.size(); ++i)
        if (std::find(names.begin(), names.end(), declared[i].name) != names.end())
            rows.push_back(static_cast<Eigen::Index>(i));
    return rows;
}

/// Greatest difference of a trial's image from the trial, of which `map` makes the states of the image.
double difference(const ExploreSettings& scenario, const LandmarkRun& run, const LandmarkRun& other,
                  const MatrixXd& map) {
    double greatest = 0;
    for (std::size_t k = 1; k < run.steps.size(); ++k)
        raise(greatest, state_difference(step_of(run.steps[k]), step_of(other.steps[k]), map));
    for (const Eigen::Index row : compared_series(scenario))
        for (Eigen::Index k = 0; k < run.figures.cols(); ++k) {
            const double value = run.figures(row, k);
            raise(greatest, share(other.figures(row, k), value, 1 + std::abs(value)));
        }
    return greatest;
}

MatrixXd scaling(const ExploreSettings& scenario, double factor) {
    MatrixXd map = factor * MatrixXd::Identity(state_size(scenario), state_size(scenario));
    map(0, 0) = 1;
    return map;
}

/// check(scenario, run, estimator, noise) on trials of two loops under every estimator.
template <class Check>
void each_trial(int trials, const Check& check) {
    for (const ExploreSettings& scenario : {classical(70), other()})
        for (const Estimator estimator : all_estimators)
            for (int trial = 0; trial < trials; ++trial) {
                const AnyNoise noise = noise_of(static_cast<std::uint64_t>(trial));
                CAPTURE(scenario.poses, estimator, trial);
                check(scenario, run_landmarks(scenario, estimator, noise), estimator, noise);
            }
}

/// What makes the states of the permuted scenario [n, n].
MatrixXd permutation(const Permuted& permuted) {
    MatrixXd map = MatrixXd::Zero(state_size(permuted.scenario), state_size(permuted.scenario));
    map.topLeftCorner<3, 3>().setIdentity();
    for (std::size_t j = 0; j < permuted.before.size(); ++j)
        map.block<2, 2>(3 + 2 * static_cast<int>(j), 3 + 2 * permuted.before[j]).setIdentity();
    return map;
}

void compare_to_rounding(int trials) {
    each_trial(trials, [](const auto& scenario, const auto& run, auto estimator, const auto& noise) {
        constexpr double rounding = 1e-16 * 1e3 * 70;  // times the condition of S, over 70 poses
        const Permuted permuted(scenario, 3);
        const LandmarkRun other = run_landmarks(permuted.scenario, estimator, permuted.noise(noise));
        CHECK(difference(scenario, run, other, permutation(permuted)) < rounding);
        for (const double factor : {0.1, 1e3}) {
            const LandmarkRun scaled = run_landmarks(in_unit(scenario, factor), estimator, noise);
            CHECK(difference(scenario, run, scaled, scaling(scenario, factor)) < rounding);
        }
    });
}

}  // namespace

TEST_CASE("landmarks metamorphic: in a unit a power of two apart a trial has the same bits") {
    each_trial(1, [](const auto& scenario, const auto& run, Estimator estimator, const auto& noise) {
        const LandmarkRun image = run_landmarks(in_unit(scenario, 0x1p-7), estimator, noise);
        REQUIRE(difference(scenario, run, image, scaling(scenario, 0x1p-7)) == 0);
    });
}

TEST_CASE("landmarks metamorphic: in another unit, and with other numbers, trials are the same to rounding") {
    compare_to_rounding(1);
}

TEST_CASE("landmarks metamorphic: hundreds of trials are the same in another unit and with other numbers", "[long]") {
    compare_to_rounding(40);
}

}  // namespace credence::test::landmark_metamorphic_test
