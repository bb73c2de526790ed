// Trials of random scenarios, often badly conditioned, and their images in a world whose difference the equations do not
// know: another unit of length, other numbers for the features, left for right, more poses to come. The robot always
// starts at the origin and heads along x, so that a shifted or a turned world is no scenario.

#include "catch.hpp"
#include "hard_planning.hpp"
#include "images.hpp"

#include "statistics/moments/conditioning.hpp"

#include <optional>

using namespace credence;
using namespace credence::test;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// None where the keys that were drawn contradict each other.
std::optional<DeformableSettings> random_scenario(unsigned seed, const Settings& more = {}) {
    Settings settings = Lottery(seed).settings();
    settings.insert(settings.end(), more.begin(), more.end());
    if (seed % 2 == 0) settings.emplace_back("truth.edge_noise", "independent");
    if (seed % 3 == 0) settings.emplace_back("sensor.detection", "0.8");
    if (seed % 5 == 0) settings.emplace_back("truth.deformation", "walk");
    try {
        return scenario_with(settings);
    } catch (const InputError&) {
        return {};
    }
}

void raise(double& greatest, double difference) {
    greatest = std::isnan(difference) ? infinity : std::max(greatest, difference);
}

/// |a - b| as a share of `size`; 0 where both are the same, NaN included.
double share(double a, double b, double size) {
    return a == b || (std::isnan(a) && std::isnan(b)) ? 0 : std::abs(a - b) / size;
}

/// Greatest difference of the image's belief and truth at a pose from the image of the belief and the truth, in standard
/// deviations of the belief.
double state_difference(const RunStep& step, const RunStep& other, const MatrixXd& map) {
    const VectorXd mean = map * step.mean, truth = map * step.truth;
    const MatrixXd P = map * step.covariance * map.transpose();
    const VectorXd sigma = P.diagonal().cwiseSqrt();
    double greatest = 0;
    for (Eigen::Index i = 0; i < mean.size(); ++i) {
        raise(greatest, share(other.mean[i], mean[i], sigma[i]));
        raise(greatest, share(other.truth[i], truth[i], sigma[i]));
        for (Eigen::Index j = 0; j < mean.size(); ++j)
            raise(greatest, share(other.covariance(i, j), P(i, j), sigma[i] * sigma[j]));
    }
    return greatest;
}

/// Greatest difference of the series without a unit at pose k, as a share of 1 + the value; infinite where other features
/// are seen.
double series_difference(const Run& run, const Run& other, const Image& image, int k) {
    double greatest = 0;
    const auto compare = [&](const std::string& name, const std::string& before) {
        const double value = run.figure(before, k);
        raise(greatest, share(other.figure(name, k), value, 1 + std::abs(value)));
    };
    for (const char* name : {"nees", "nees_pose", "nees_features", "nis", "nis_features", "nis_edges", "nis_rows",
                             "unseen_features"})
        compare(name, name);
    const auto at = static_cast<std::size_t>(k);
    for (std::size_t j = 0; j < image.feature.size(); ++j) {
        const int before = image.feature[j];
        compare("nees_feature_" + std::to_string(j), "nees_feature_" + std::to_string(before));
        if (other.steps[at].seen[j] != run.steps[at].seen[static_cast<std::size_t>(before)]) greatest = infinity;
    }
    return greatest;
}

/// The sum over the poses of the squared error of the pose, in the image's units.
double pose_error_of(const Run& run, const Image& image) {
    const Eigen::Index pose = pose_size(image.scenario);
    double sum = 0;
    for (const RunStep& step : run.steps) {
        VectorXd error = (step.mean - step.truth).head(pose);
        if (image.scenario.process == Process::heading) error[0] = std::remainder(error[0], 2 * std::acos(-1.0));
        sum += (image.map.topLeftCorner(pose, pose) * error).squaredNorm();
    }
    return sum;
}

double column_difference(const Run& run, const Run& other, const Image& image) {
    const double trace = (image.map * run.steps.back().covariance * image.map.transpose()).trace();
    const double pose_error = pose_error_of(run, image);
    double greatest = share(other.columns[column_trace_P], trace, trace);
    raise(greatest, share(other.columns[column_pose_error], pose_error, pose_error + trace));
    for (const int column : {column_unseen, column_nees_ratio, column_nis_ratio}) {
        const double value = run.columns[static_cast<std::size_t>(column)];
        if (!std::isnan(value)) raise(greatest, share(other.columns[static_cast<std::size_t>(column)], value, 1 + value));
    }
    return greatest;
}

/// Greatest difference of a trial's image from the trial, over its poses.
double difference(const Run& run, const Run& other, const Image& image) {
    double greatest = state_difference(run.steps[0], other.steps[0], image.map);
    for (int k = 1; k < image.scenario.poses; ++k) {
        const auto at = static_cast<std::size_t>(k);
        raise(greatest, state_difference(run.steps[at], other.steps[at], image.map));
        raise(greatest, series_difference(run, other, image, k));
    }
    return greatest;
}

/// What rounding may do to all of this. An update that leaves a share 1/loss of a variance leaves rounding errors of
/// loss epsilon in P, and NEES multiplies them by n over the smallest eigenvalue of the correlation matrix
/// [statistics/moments/conditioning.hpp]; the errors are small differences of coordinates, which have `size` standard
/// deviations; and all poses before have added their share.
double rounding_of(const Run& run) {
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    double bound = 0, loss = 1, size = 1;
    for (std::size_t k = 1; k < run.steps.size(); ++k) {
        const RunStep& step = run.steps[k];
        const VectorXd prior = step.prior_covariance.diagonal(), left = step.covariance.diagonal();
        if (!(left.minCoeff() > 0)) return infinity;
        raise(bound, std::max(rounding_bound(step.prior_covariance, epsilon), rounding_bound(step.covariance, epsilon)));
        raise(loss, prior.cwiseQuotient(left).maxCoeff());
        raise(size, step.truth.cwiseQuotient(left.cwiseSqrt()).cwiseAbs().maxCoeff());
    }
    return bound * loss * size * static_cast<double>(run.steps.size());
}

/// Trials compared, and those in which rounding may change more than the sixth digit of a number.
struct Compared {
    int trials = 0, left_out = 0;
    double closest = 0;  ///< greatest difference as a share of what rounding may do
};

using Making = std::function<Image(const DeformableSettings& scenario, const AnyNoise& noise, unsigned seed)>;

/// Compares trials with their images, which no bit may tell apart where `exact`. The columns are sums that this test
/// adds up in another order: 1e-9 is far above the rounding of 63 terms that are not negative, and of a turn of 2 pi.
Compared compare(const char* relation, unsigned scenarios, bool exact, const Making& make) {
    Compared all;
    for (unsigned seed = 0; seed < scenarios; ++seed) {
        const std::optional<DeformableSettings> scenario = random_scenario(seed);
        if (!scenario) continue;
        const AnyNoise noise = keyed_noise(*scenario, 5, seed);
        const Image image = make(*scenario, noise, seed);
        const Run run = run_arm(*scenario, Controller::fixed, noise);
        const Run other = run_arm(image.scenario, Controller::fixed, image.noise);
        const double allowed = exact ? 0 : rounding_of(run), found = difference(run, other, image);
        if (allowed > 1e-6) {
            ++all.left_out;
            continue;
        }
        CAPTURE(relation, seed, allowed, found);
        REQUIRE(found <= allowed);
        REQUIRE(column_difference(run, other, image) <= 1e-9 + allowed);
        if (!exact) raise(all.closest, found / allowed);
        ++all.trials;
    }
    return all;
}

constexpr bool to_the_bit = true, to_rounding = false;

/// In units that are no power of two apart, and with the features in another order.
void compare_to_rounding(unsigned scenarios) {
    for (const double factor : {1e-3, 0.1, 1e3}) {
        const Compared units = compare("unit", scenarios, to_rounding, [&](const auto& scenario, const auto& noise, unsigned) {
            return in_unit(scenario, noise, factor);
        });
        CHECK(units.trials > units.left_out);
        CHECK(units.closest > 1e-4);  // or the bound would say little
    }
    const Compared features = compare("features", scenarios, to_rounding, permuted);
    CHECK(features.trials > features.left_out);
    CHECK(features.closest > 1e-4);
}

}  // namespace

TEST_CASE("metamorphic: in another unit of length, and with features in another order, trials are the same to rounding") {
    compare_to_rounding(60);
}

TEST_CASE("metamorphic: thousands of trials are the same in another unit and with features in another order", "[long]") {
    compare_to_rounding(3000);
}

TEST_CASE("metamorphic: in a mirror a trial has the same bits, its left for its right") {
    CHECK(compare("mirror", 100, to_the_bit, [](const auto& scenario, const auto& noise, unsigned) {
              return mirrored(scenario, noise);
          }).trials > 50);
}

TEST_CASE("metamorphic: in a unit a power of two apart a random trial has the same bits, and plans the same") {
    for (const double factor : {0x1p-10, 0x1p7})
        CHECK(compare("power of two", 60, to_the_bit, [&](const auto& scenario, const auto& noise, unsigned) {
                  return in_unit(scenario, noise, factor);
              }).trials > 30);
    for (unsigned seed = 0; seed < 30; ++seed) {
        const std::optional<DeformableSettings> scenario =
            random_scenario(seed, {{"scenario.poses", "5"}, {"planner.speeds", "4"}, {"planner.heading_weight", "3"}});
        if (!scenario) continue;
        const AnyNoise noise = keyed_noise(*scenario, 6, seed);
        const Image image = in_unit(*scenario, noise, 0x1p7);
        const Run run = run_arm(*scenario, Controller::greedy, noise);
        const Run other = run_arm(image.scenario, Controller::greedy, image.noise);
        CAPTURE(seed);
        REQUIRE(difference(run, other, image) == 0);
    }
}

TEST_CASE("metamorphic: a random trial with more poses to come begins with the same bits") {
    for (const Controller controller : {Controller::fixed, Controller::greedy})
        for (unsigned seed = 0; seed < 30; ++seed) {
            const Settings few{{"scenario.poses", "4"}, {"planner.speeds", "4"}};
            const std::optional<DeformableSettings> scenario = random_scenario(seed, few);
            if (!scenario) continue;
            DeformableSettings longer = *scenario;
            longer.poses = 9;
            const AnyNoise noise = keyed_noise(*scenario, 7, seed);
            const Run run = run_arm(*scenario, controller, noise), other = run_arm(longer, controller, noise);
            CAPTURE(seed);
            for (std::size_t k = 0; k < 4; ++k) {
                REQUIRE(same_bits(MatrixXd(run.steps[k].mean), MatrixXd(other.steps[k].mean)));
                REQUIRE(same_bits(run.steps[k].covariance, other.steps[k].covariance));
            }
            REQUIRE(same_bits(run.figures, MatrixXd(other.figures.leftCols(3))));
        }
}
