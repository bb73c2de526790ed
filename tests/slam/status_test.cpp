// Numerical trouble inside a trial is data: its status, the pose where it happened, and the columns that remain.

#include "catch.hpp"
#include "support.hpp"

#include "slam/trial/trial.hpp"

#include <cmath>

namespace credence::test::status_test {

namespace {

constexpr double completed = 0, diverged = 1, not_positive_definite = 2, non_finite = 3;

Run run_with(const DeformableSettings& scenario, const AnyNoise& noise) {
    return run_arm(scenario, Controller::fixed, noise);
}

void check_status(const Run& run, double status, double pose) {
    CHECK(run.columns[column_status] == status);
    CHECK(run.columns[column_status_pose] == pose);
}

/// The outcome of the step evaluation of one belief: only what note_trouble checks.
Outcome<double> trouble_with(const Belief<double, 9>& belief, double squared_errors = 1,
                             bool positive_definite = true) {
    Outcome<double> outcome;
    note_trouble(belief, 9, squared_errors, positive_definite, 4, outcome);
    return outcome;
}

/// NEES/n is about 65: the filter believes in a tenth of the noise.
const Settings overconfident{{"filter.measurement", "0.1"}, {"filter.odometry", "0.1"}};

}  // namespace

TEST_CASE("status: numbers and names of the statuses") {
    CHECK(status_names() ==
          std::vector<std::string>{"completed", "diverged", "covariance_not_positive_definite", "non_finite"});
    CHECK_FALSE(failed(Status::completed));
    CHECK_FALSE(failed(Status::diverged));
    CHECK(counts(Status::completed));
    CHECK_FALSE(counts(Status::diverged));
    CHECK(failed(Status::covariance_not_positive_definite));
    CHECK(failed(Status::non_finite));
}

TEST_CASE("status: a draw that is no number is noticed at its pose, for good") {
    const DeformableSettings scenario = scenario_with({{"sensor.range_min", "0"}, {"sensor.range_max", "inf"}});
    const AnyNoise noise = keyed_noise(scenario, 60, 0);
    check_status(run_with(scenario, noise), completed, -1);
    for (const double bad : {not_a_number, infinity, -infinity}) {
        CAPTURE(bad);
        check_status(run_with(scenario, with_draw(noise, Source::measurement, 0, 1, {bad, 0})), non_finite, 0);
        check_status(run_with(scenario, with_draw(noise, Source::measurement, 5, 1, {0, bad})), non_finite, 5);
        check_status(run_with(scenario, with_draw(noise, Source::walk, 5, 1, {bad, 0})), non_finite, 6);
        check_status(run_with(scenario, with_draw(noise, Source::deformation, 19, 2, {bad, 0})), non_finite, 19);
        check_status(run_with(scenario, with_draw(noise, Source::odometry_position, 7, 0, {bad, 0})), non_finite, 7);
        check_status(run_with(scenario, with_draw(noise, Source::odometry_heading, 7, 0, {bad, 0})), non_finite, 7);
    }
}

TEST_CASE("status: a heading that is off by 10^4 times the sensor's sigma does not make an exact filter fail") {
    for (const char* sigma : {"1e-9", "5e-9"})
        for (const char* estimator : {"ekf", "iekf", "fej", "riekf", "ideal"}) {
            const DeformableSettings scenario = scenario_with(
                {{"features.path", "static"}, {"features.positions", "6 8, -8 6, 3 -9"}, {"sensor.range_min", "0"},
                 {"sensor.range_max", "inf"}, {"sensor.sigma", sigma}, {"noise.heading", "1e-6"},
                 {"noise.odometry", "1e-4"}, {"noise.walk", "1e-4"}, {"noise.deformation", "0"},
                 {"edges.graph", "none"}, {"scenario.poses", "2"}, {"arms.estimators", estimator}});
            constexpr int trials = 200;
            double nees = 0;
            for (std::uint64_t trial = 0; trial < trials; ++trial) {
                const Run run = run_arm(scenario, arms_of(scenario).front(), keyed_noise(scenario, 1, trial));
                CAPTURE(sigma, estimator, trial);
                check_status(run, completed, -1);
                nees += run.columns[column_nees_ratio] / trials;
            }
            // 9 components: 4.5 standard deviations, a false alarm once in 150,000.
            CHECK(std::abs(nees - 1) < 4.5 * std::sqrt(2.0 / 9 / trials));
        }
}

TEST_CASE("status: a feature whose truth is no number is not seen, and the trial fails all the same") {
    const DeformableSettings scenario = scenario_with({{"edges.graph", "none"}});
    const Run run =
        run_with(scenario, with_draw(keyed_noise(scenario, 60, 0), Source::deformation, 5, 1, {not_a_number, 0}));
    check_status(run, non_finite, 5);
    CHECK_FALSE(run.steps[5].seen[1]);
    CHECK(run.steps.back().mean.allFinite());  // the filter never knew
}

TEST_CASE("status: a trial whose NEES/n is beyond 25 diverged, and keeps its columns") {
    const DeformableSettings scenario = scenario_with(overconfident);
    const Run run = run_with(scenario, keyed_noise(scenario, 61, 1));
    check_status(run, diverged, -1);
    CHECK(run.columns[column_nees_ratio] > diverged_nees_ratio);
    CHECK(run.figures.allFinite());
    std::vector<double> columns = run.columns;
    CHECK_FALSE(fill_failed(trial_columns(scenario), columns.data()));
    CHECK(columns == run.columns);
    for (const double ratio : {diverged_nees_ratio, std::nextafter(diverged_nees_ratio, infinity)}) {
        Outcome<double> outcome;
        outcome.note_diverged(ratio, least_diverged_numbers);
        CHECK(outcome.status == (ratio > diverged_nees_ratio ? diverged : completed));
        CHECK(outcome.pose == -1);
    }
}

TEST_CASE("status: no size of P or of an error fails a trial in which all is finite") {
    // Features move 10 a step away from a robot that believes itself lost: P grows beyond 1e12 at pose 1.
    const DeformableSettings scenario = scenario_with({{"noise.odometry", "1e7"}});
    const Run run = run_with(scenario, keyed_noise(scenario, 61, 1));
    check_status(run, completed, -1);
    CHECK(run.columns[column_trace_P] > 1e12);
}

TEST_CASE("status: a trial that would diverge may fail, and a trial that failed stays so") {
    const DeformableSettings scenario = scenario_with(overconfident);
    const AnyNoise noise = keyed_noise(scenario, 61, 1);
    check_status(run_with(scenario, with_draw(noise, Source::walk, 7, 0, {not_a_number, 0})), non_finite, 8);
    Outcome<double> outcome;
    outcome.note(false, Status::non_finite, 3);
    CHECK(outcome.status == completed);
    outcome.note(true, Status::covariance_not_positive_definite, 4);
    outcome.note(true, Status::non_finite, 5);
    outcome.note_diverged(1e9, least_diverged_numbers);
    CHECK(outcome.status == not_positive_definite);
    CHECK(outcome.pose == 4);
}

TEST_CASE("status: an entry of x or P above 1e70 in size, in either sign, counts as not finite") {
    const double bound = largest_number, above = std::nextafter(bound, infinity);
    const auto with = [](double mean, double covariance) {
        Belief<double, 9> belief{};
        belief.mean[8] = mean;
        belief.covariance.entry[3][7] = covariance;
        return trouble_with(belief);
    };
    CHECK(with(bound, -bound).status == completed);
    for (const double sign : {-1.0, 1.0}) {
        CHECK(with(sign * above, 0).status == non_finite);
        CHECK(with(0, sign * above).status == non_finite);
    }
    CHECK(with(above, 0).pose == 4);
}

TEST_CASE("status: whatever is not finite in x, P or the squared errors is noticed") {
    for (const double bad : {not_a_number, infinity, -infinity}) {
        Belief<double, 9> belief{};
        CHECK(trouble_with(belief).status == completed);
        CHECK(trouble_with(belief, bad).status == non_finite);
        belief.mean[0] = bad;
        CHECK(trouble_with(belief).status == non_finite);
        belief.mean[0] = 0;
        belief.covariance.entry[0][8] = bad;
        CHECK(trouble_with(belief).status == non_finite);
        CHECK(trouble_with(belief, 1, false).status == non_finite);
    }
    CHECK(trouble_with(Belief<double, 9>{}, not_a_number, false).status == not_positive_definite);
    CHECK(trouble_with(Belief<double, 9>{}, 1, false).status == not_positive_definite);
}

TEST_CASE("status: the short check finds trouble wherever the long one does") {
    const Layout<Process::heading, 3> layout(3);
    const auto agree = [&](const Belief<double, 9>& belief, double squared_errors, bool positive_definite) {
        const bool found = trouble_with(belief, squared_errors, positive_definite).status != completed;
        CHECK((!found || trouble(belief, layout, squared_errors, positive_definite)));
        return found;
    };
    Belief<double, 9> sound{};
    for (int i = 0; i < 9; ++i) sound.covariance.entry[i][i] = 1;
    CHECK_FALSE(agree(sound, 1, true));
    CHECK_FALSE(trouble(sound, layout, 1.0, true));
    CHECK(agree(sound, 1, false));
    for (const double bad : {not_a_number, infinity, -infinity, 2e70, -2e70}) {
        for (int i = 0; i < 9; ++i) {
            Belief<double, 9> belief = sound;
            belief.mean[i] = bad;
            CHECK(agree(belief, 1, true));
            if (bad < 0) continue;  // a negative variance is no positive definite matrix
            belief = sound;
            belief.covariance.entry[i][i] = bad;
            CHECK(agree(belief, 1, true));
        }
        if (std::abs(bad) != 2e70) CHECK(agree(sound, bad, true));
    }
}

TEST_CASE("status: an innovation covariance that is not positive definite is noticed") {
    // With P at 1e16 and N at 1e-6, S of a sighting after the first is all rounding; P itself recovers.
    const DeformableSettings scenario = scenario_with({{"model.process", "translation"},
                                                       {"noise.odometry", "1e8"},
                                                       {"sensor.sigma", "1e-3"},
                                                       {"sensor.range_max", "inf"}});
    const Run run = run_with(scenario, keyed_noise(scenario, 30, 0));
    CHECK(smallest_eigenvalue(run.steps[1].covariance) > 0);
    check_status(run, not_positive_definite, 1);
}

TEST_CASE("status: a covariance that is not positive definite has its own status") {
    // x and P are finite here; the NEES is not, and must not be taken for the trouble.
    const DeformableSettings scenario = scenario_with({{"noise.odometry", "1e7"},
                                                       {"sensor.sigma", "1e-3"},
                                                       {"sensor.range_max", "inf"},
                                                       {"model.process", "translation"}});
    const Run run = run_with(scenario, keyed_noise(scenario, 30, 0));
    REQUIRE(run.steps[1].covariance.allFinite());
    REQUIRE(smallest_eigenvalue(run.steps[1].covariance) < 0);
    check_status(run, not_positive_definite, 1);
}

TEST_CASE("status: a failed trial keeps its status and pose; its other columns are filled") {
    const DeformableSettings scenario = scenario_with({{"sensor.range_max", "inf"}});
    const Run run =
        run_with(scenario, with_draw(keyed_noise(scenario, 60, 0), Source::measurement, 5, 1, {not_a_number, 0}));
    std::vector<double> columns = run.columns;
    CHECK(fill_failed(trial_columns(scenario), columns.data()));
    for (const int column : {column_trace_P, column_pose_error, column_nees_ratio, column_nis_ratio})
        CHECK(std::isnan(columns[static_cast<std::size_t>(column)]));
    CHECK(columns[column_unseen] == -1);
    CHECK(columns[column_status] == non_finite);
    CHECK(columns[column_status_pose] == 5);
    // Fills do not depend on what was there.
    columns.assign(column_count, 7);
    columns[column_status] = not_positive_definite;
    CHECK(fill_failed(trial_columns(scenario), columns.data()));
    CHECK(std::isnan(columns[column_trace_P]));
    CHECK(columns[column_unseen] == -1);
    CHECK(columns[column_status] == not_positive_definite);
    CHECK(columns[column_status_pose] == 7);
}

TEST_CASE("status: columns of a completed trial are left alone") {
    std::vector<double> columns{0.1, 3, 0.2, 1.1, 0.9, completed, -1};
    const std::vector<double> before = columns;
    CHECK_FALSE(fill_failed(trial_columns(DeformableSettings{}), columns.data()));
    CHECK(columns == before);
}

}  // namespace credence::test::status_test
