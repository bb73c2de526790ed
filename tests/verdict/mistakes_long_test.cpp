// Mistakes that were found in well-known tools [docs/theory/statistics.md, Calibration and power], as far as no
// other test would catch them. The others: alpha in each tail (statistics_reference_test, goodness_test,
// calibration_test), the 99th percentile itself (statistics_reference_test), N m degrees (calibration_reference_test),
// seeds that share trials (study_test, draws_test), resumed runs that restart at 0 (study_test, store_test, cli_test).

#include <algorithm>
#include "numeric/chi_square.hpp"
#include <credence/report.hpp>
#include "study/stopping.hpp"
#include <numeric>

#include "calibration_support.hpp"
#include "either_way.hpp"
#include "synthetic.hpp"

namespace credence::test::mistakes_long_test {

namespace {

constexpr std::int64_t trials = 300;

/// How many trials ended so.
int ended(const ArmResults& arm, Status status) {
    int count = 0;
    for (const double one : arm.columns.in_memory()[column_status]) count += one == static_cast<double>(status);
    return count;
}

/// The mean of NEES/n over the trials in which `counts` holds.
double mean_ratio(const ArmResults& arm, const std::function<bool(Status)>& counts) {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < trials; ++i)
        if (counts(static_cast<Status>(static_cast<int>(arm.columns.in_memory()[column_status][i])))) {
            sum += arm.columns.in_memory()[column_nees_ratio][i];
            ++count;
        }
    return sum / count;
}

/// The number of trials with which a step's distribution was counted.
std::int64_t counted_cells(const ArmResults& arm, std::size_t k) {
    const auto first = arm.totals.cells.begin() + static_cast<std::ptrdiff_t>(k * distribution_cells);
    return std::accumulate(first, first + distribution_cells, std::int64_t{0});
}

/// Odometry that is worth nothing against measurements that are near perfect: S and P lose their digits.
DeformableSettings without_odometry(double odometry, double sigma) {
    DeformableSettings s;
    s.noise.odometry = odometry;
    s.sensor.sigma = sigma;
    s.sensor.range_max = std::numeric_limits<double>::infinity();
    s.poses = 6;
    s.arms.controllers = {Controller::fixed};
    return s;
}

/// Values of sd 1, but for one.
std::vector<double> values_with(std::size_t place, double outlier, std::size_t count) {
    Normals normals(71);
    std::vector<double> values(count);
    for (double& value : values) value = normals();
    values[place] = outlier;
    return values;
}

/// An interim analysis of the first values, as the program makes it.
InterimAnalysis look_at_first(const std::vector<double>& values, const StoppingRule& rule, std::int64_t count,
                              int number) {
    const GoalState state =
        decide(moments_of(exact_moments({values.begin(), values.begin() + count})), rule.goals.front(), number);
    return {count, number, analysis_alpha(number), {state}, state.met()};
}

}  // namespace

TEST_CASE("mistakes: a trial whose P is not positive definite has no NEES, and not one of 0") {
    DeformableSettings s = without_odometry(1e6, 1e-2);
    s.noise.heading = 1e-9;
    const ScenarioResults results = replication(s, trials, 9);
    const ArmResults& arm = results.arms.front();
    const int bad = ended(arm, Status::covariance_not_positive_definite);
    REQUIRE(bad > 20);
    REQUIRE(bad < trials - 20);
    const std::vector<std::vector<double>>& columns = arm.columns.in_memory();
    for (std::size_t i = 0; i < trials; ++i)
        if (columns[column_status][i] == static_cast<double>(Status::covariance_not_positive_definite)) {
            CHECK(std::isnan(columns[column_nees_ratio][i]));
            for (std::size_t k = 0; k < 5; ++k) CHECK(std::isnan(arm.nees[i * 5 + k]));
        }
    const Evidence evidence = evidence_of(results, arm);
    const int used = static_cast<int>(trials) - bad - ended(arm, Status::non_finite) - ended(arm, Status::diverged);
    CHECK(evidence.trials == used);
    for (std::size_t k = 0; k < 5; ++k) {
        CHECK(evidence.groups.front().anees.degrees[k] == 9.0 * used);
        CHECK(counted_cells(arm, k) == used);
        CHECK(evidence.credibility.step[k].count == used);
    }
    // Both add up the same NEES, rounded otherwise.
    const double mean = mean_ratio(arm, [](Status status) { return !failed(status) && status != Status::diverged; });
    CHECK(evidence.groups.front().run.mean == Approx(mean).epsilon(1e-12));
}

TEST_CASE("mistakes: where the others diverged they are judged, and counted beside those that failed") {
    const ScenarioResults results = replication(without_odometry(5e4, 1e-3), trials, 9);
    const ArmResults& arm = results.arms.front();
    const int bad = ended(arm, Status::covariance_not_positive_definite), diverged = ended(arm, Status::diverged);
    REQUIRE(bad > 0);
    REQUIRE(diverged == trials - bad);
    const ArmReport report = report_arm(results, arm, evidence_of(results, arm), 9, 0.05);
    CHECK(report.evidence.trials == diverged);
    CHECK(report.failed == bad);
    CHECK(report.diverged == diverged);
    CHECK(report.cause->status == Status::diverged);
    CHECK(report.cause->trials == diverged);
}

TEST_CASE("mistakes: quantiles in a report are the sample's, not those of a normal of its mean and deviation") {
    DeformableSettings s;  // trace(P) is heavy-tailed here
    s.arms.controllers = {Controller::fixed};
    Study study = new_study({resolved(s)}, 1);
    run_study(study, {trials, 1, {}});
    std::vector<double> sorted = study.scenarios.front().arms.front().columns.in_memory()[column_trace_P];
    std::sort(sorted.begin(), sorted.end());
    const Report report = report_either_way(study, 0.05);
    const ColumnReport& figure = report.arms.front().columns[column_trace_P];
    REQUIRE(reported_quantiles[0] == 0.05);
    REQUIRE(reported_quantiles[3] == 0.95);
    // Type 7: at places 0.05 * 299 = 14.95 and 284.05 of the sorted values, counted from 0.
    CHECK(figure.quantiles[0] == Approx(sorted[14] + 0.95 * (sorted[15] - sorted[14])).epsilon(1e-12));
    CHECK(figure.quantiles[3] == Approx(sorted[284] + 0.05 * (sorted[285] - sorted[284])).epsilon(1e-12));
    CHECK(figure.summary.mean - 1.645 * figure.summary.standard_deviation < 0);
}

TEST_CASE("mistakes: diverged trials are in none of the evidence, and are counted") {
    DeformableSettings s;
    s.filter.measurement = s.filter.odometry = 0.2;  // NEES/n is about 17
    s.arms.controllers = {Controller::fixed};
    const ScenarioResults results = replication(s, trials, 61);
    const ArmResults& arm = results.arms.front();
    const int diverged = ended(arm, Status::diverged), completed = ended(arm, Status::completed);
    REQUIRE(diverged > 3);
    REQUIRE(completed > diverged);
    const Evidence evidence = evidence_of(results, arm);
    CHECK(evidence.trials == completed);
    CHECK(evidence.diverged == diverged);
    CHECK(evidence.diverged_trials.size() == static_cast<std::size_t>(std::min(diverged, 10)));
    for (std::size_t k = 0; k < 19; ++k) {
        CHECK(evidence.groups.front().step[k].count == completed);
        CHECK(counted_cells(arm, k) == completed);
    }
    const double mean = mean_ratio(arm, counts);
    CHECK(evidence.groups.front().run.mean == Approx(mean).epsilon(1e-12));
}

TEST_CASE("mistakes: an analysis uses its own values, not the widest or narrowest analysis so far") {
    // An outlier of 100 among the first 16: their half-width is 16, and falls about as 1/N. Had the rule kept the
    // running maximum, it would never stop.
    const StoppingRule rule{{parse_goal("x=0.5")}, 4096, 16};
    std::vector<double> values = values_with(3, 100, 4096);
    std::vector<double> widths;
    const InterimAnalysis last = run_analyses(rule, [&](std::int64_t count, int number) {
        widths.push_back(look_at_first(values, rule, count, number).states.front().half_width);
        return look_at_first(values, rule, count, number);
    });
    CHECK(last.met);
    CHECK(last.trials < 4096);
    CHECK(widths.front() > 10);
    CHECK(last.states.front().half_width < 0.5);
    const Summary summary = summarise({values.begin(), values.begin() + last.trials});
    const double width =
        t_quantile(analysis_alpha(last.number), static_cast<double>(last.trials) - 1) * summary.standard_error;
    CHECK(last.states.front().half_width == Approx(width).epsilon(1e-12));
    // After a late outlier the next analysis is wider than the one before, and shows it.
    values = values_with(20, 100, 64);
    CHECK(look_at_first(values, rule, 16, 1).states.front().half_width < 1);
    CHECK(look_at_first(values, rule, 32, 2).states.front().half_width > 5);
}

}  // namespace credence::test::mistakes_long_test
