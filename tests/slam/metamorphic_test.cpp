// Trials of random scenarios, often badly conditioned, and their images in a world whose difference the equations do
// not know: another unit of length, other numbers for the features, left for right, more poses to come. The robot
// always starts at the origin and heads along x, so that a shifted or a turned world is no scenario
// (rigid_motion_test.cpp).

#include "catch.hpp"
#include "metamorphic.hpp"

namespace credence::test::metamorphic_test {

namespace {

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
        if (!std::isnan(value))
            raise(greatest, share(other.columns[static_cast<std::size_t>(column)], value, 1 + value));
    }
    return greatest;
}

/// Trials compared, and those in which rounding may change more than the sixth digit of a number or the filter is lost.
struct Compared {
    int trials = 0, left_out = 0;
    double closest = 0;  ///< greatest difference as a share of what rounding may do
};

/// Compares a trial with its image, which no bit may tell apart where `exact`. The columns are sums that this test adds
/// up in another order: 1e-9 is far above the rounding of 63 terms that are not negative, and of a turn of 2 pi.
void compare(const DeformableSettings& scenario, const AnyNoise& noise, const Image& image, const Arm& arm, bool exact,
             Compared& all) {
    const Run run = run_arm(scenario, arm, noise), other = run_arm(image.scenario, arm, image.noise);
    const double allowed = exact ? 0 : rounding_of(run), found = difference(run, other, image);
    if (!exact && (allowed > 1e-6 || is_lost(run))) return void(++all.left_out);
    CAPTURE(arm.estimator, allowed, found);
    REQUIRE(found <= allowed);
    REQUIRE(column_difference(run, other, image) <= 1e-9 + allowed);
    if (!exact) raise(all.closest, found / allowed);
    ++all.trials;
}

using Making = std::function<Image(const DeformableSettings& scenario, const AnyNoise& noise, unsigned seed)>;

/// Compares trials of random scenarios, under one estimator after another, with their images.
Compared compare(const char* relation, unsigned scenarios, bool exact, const Making& make) {
    Compared all;
    for (unsigned seed = 0; seed < scenarios; ++seed) {
        const std::optional<DeformableSettings> scenario = random_scenario(seed);
        if (!scenario) continue;
        const AnyNoise noise = keyed_noise(*scenario, 5, seed);
        const Image image = make(*scenario, noise, seed);
        CAPTURE(relation, seed);
        const std::vector<Estimator> estimators = estimators_of(scenario->process);
        const Arm arm{Controller::fixed, estimators[seed / 5 % estimators.size()]};  // the keys change with seed % 5
        compare(*scenario, noise, image, arm, exact, all);
    }
    return all;
}

constexpr bool to_the_bit = true, to_rounding = false;

/// In units that are no power of two apart, and with the features in another order.
void compare_to_rounding(unsigned scenarios) {
    for (const double factor : {1e-3, 0.1, 1e3}) {
        const Compared units = compare(
            "unit", scenarios, to_rounding,
            [&](const auto& scenario, const auto& noise, unsigned) { return in_unit(scenario, noise, factor); });
        CHECK(units.trials > units.left_out);
        CHECK(units.closest > 1e-4);  // or the bound would say little
    }
    const Compared features = compare("features", scenarios, to_rounding, permuted);
    CHECK(features.trials > features.left_out);
    CHECK(features.closest > 1e-4);
}

}  // namespace

TEST_CASE(
    "metamorphic: in another unit of length, and with features in another order, trials are the same to rounding") {
    compare_to_rounding(100);
}

TEST_CASE("metamorphic: thousands of trials are the same in another unit and with features in another order",
          "[long]") {
    compare_to_rounding(2000);
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

}  // namespace credence::test::metamorphic_test
