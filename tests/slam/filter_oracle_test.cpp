// Whole trials against the oracle's joint updates, pose by pose.

#include "catch.hpp"
#include "support.hpp"

namespace credence::test::filter_oracle_test {

namespace {

/// Checks one trial of the seed's size: x^ and P to 1e-12 of their norms, NEES and NIS to 1e-10. cond(S) is below 200
/// in these cells: one update may err by 12 rows * 200 * 2^-53 = 3e-13 of P^- (filter_long_test.cpp says why), and what
/// is seen is 3e-14 of P. NEES and NIS divide by eigenvalues up to 100 times smaller than the norms.
void check_trial(const Settings& settings, Controller controller, std::uint64_t trial) {
    const DeformableSettings scenario = scenario_with(settings);
    const AnyNoise noise = keyed_noise(scenario, 20, trial);
    const Run ours = run_arm(scenario, controller, noise);
    const Difference worst = difference(ours, oracle::run(scenario, controller, for_oracle(noise)));
    CAPTURE(described(settings), static_cast<int>(controller), trial);
    CHECK(worst.condition < 200);
    CHECK(worst.same_sight);
    CHECK(worst.same_control);
    CHECK(worst.same_rows);
    CHECK(worst.same_unseen);
    CHECK(worst.prior_mean < 1e-12);
    CHECK(worst.prior_covariance < 1e-12);
    CHECK(worst.mean < 1e-12);
    CHECK(worst.covariance < 1e-12);
    CHECK(worst.trace_P < 1e-12);
    CHECK(worst.nees < 1e-10);
    CHECK(worst.nis < 1e-10);
    CHECK(worst.cost < 1e-10);
    CHECK(worst.pose_error < 1e-10);
    CHECK(worst.nees_ratio < 1e-10);
    CHECK(worst.nis_ratio < 1e-10);
    CHECK(worst.log_score < 1e-10);
    CHECK(worst.path_length < 1e-10);
}

}  // namespace

TEST_CASE("filter: fixed paths agree with the oracle at every pose, in all cells") {
    for (const Settings& cell : seed_cells())
        for (std::uint64_t trial = 0; trial < 25; ++trial) check_trial(cell, Controller::fixed, trial);
}

TEST_CASE("filter: planned paths agree with the oracle at every pose, in all cells") {
    for (const Settings& cell : seed_cells())
        for (std::uint64_t trial = 0; trial < 5; ++trial) check_trial(cell, Controller::greedy, trial);
}

TEST_CASE("filter: large heading noise agrees with the oracle") {
    // The linearisation errs, but both err alike.
    for (const char* path : {"straight", "circle"})
        for (std::uint64_t trial = 0; trial < 5; ++trial)
            check_trial({{"features.path", path}, {"noise.heading", "0.05"}}, Controller::fixed, trial);
}

TEST_CASE("filter: the matched world agrees with the oracle") {
    for (const char* process : {"heading", "translation"})
        for (std::uint64_t trial = 0; trial < 5; ++trial) {
            Settings settings = matched_world();
            settings.emplace_back("model.process", process);
            check_trial(settings, Controller::fixed, trial);
        }
}

}  // namespace credence::test::filter_oracle_test
