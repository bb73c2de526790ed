// Means over thousands of trials, against those of an independent implementation [docs/model.md]. Both sides have an
// error: bounds are 4 standard errors of the difference, a false alarm in 16,000 for each number.

#include "catch.hpp"
#include "matched.hpp"
#include "of_scenarios.hpp"

#include <credence/consistency.hpp>
#include <credence/study.hpp>

#include <cmath>

namespace credence::test::figures_long_test {

namespace {

DeformableSettings cell(Process process, Path path, RangeNoise noise) {
    DeformableSettings s;
    s.process = process;
    s.features.path = path;
    s.sensor.noise = noise;
    return s;
}

ScenarioResults run(const DeformableSettings& scenario, std::int64_t trials) {
    Study study = new_study({resolved(scenario)}, 1);
    run_study(study, {trials, 0, {}});
    return study.scenarios.front();
}

Summary column(const ScenarioResults& results, std::size_t arm, int which) {
    return summarise(results.arms[arm].columns.in_memory()[static_cast<std::size_t>(which)]);
}

void check_mean(const Summary& ours, double theirs, double their_error) {
    INFO("ours " << ours.mean << " +- " << ours.standard_error << ", theirs " << theirs << " +- " << their_error);
    CHECK(std::abs(ours.mean - theirs) < 4 * std::hypot(ours.standard_error, their_error));
}

double group_ratio(const ScenarioResults& results, std::size_t arm, const std::string& name) {
    for (const GroupEvidence& group : evidence_of(results, results.arms[arm]).groups)
        if (group.name == name) return group.run.mean;
    FAIL("no group " << name);
    return 0;
}

/// The truth that the filter assumes, every feature always in range.
DeformableSettings matched(Process process, double sigma_heading) {
    DeformableSettings s = test::matched_linear();
    s.process = process;
    s.noise.heading = sigma_heading;
    return s;
}

}  // namespace

TEST_CASE("figures: translation, straight, constant noise, fixed path", "[long]") {
    const ScenarioResults r = run(cell(Process::translation, Path::straight, RangeNoise::constant), 10000);
    const Summary trace = column(r, 0, column_trace_P);
    check_mean(trace, 0.157, 0.003);
    CHECK(trace.median == Approx(0.106).margin(0.0005));
    CHECK(trace.standard_deviation == Approx(0.21).margin(0.05));  // heavy-tailed: its own error is large
    check_mean(column(r, 0, column_unseen), 12.2, 0.13);
    CHECK(column(r, 1, column_unseen).mean > column(r, 0, column_unseen).mean);  // planning sees fewer here
}

TEST_CASE("figures: translation, circle, constant noise, fixed path", "[long]") {
    const ScenarioResults r = run(cell(Process::translation, Path::circle, RangeNoise::constant), 10000);
    check_mean(column(r, 0, column_trace_P), 0.491, 0.018);
    CHECK(column(r, 0, column_unseen).mean == Approx(44.9).margin(0.3));
}

TEST_CASE("figures: heading, circle, constant noise, both paths", "[long]") {
    const ScenarioResults r = run(cell(Process::heading, Path::circle, RangeNoise::constant), 10000);
    check_mean(column(r, 0, column_trace_P), 0.260, 0.009);
    CHECK(column(r, 0, column_unseen).mean == Approx(30.8).margin(0.4));
    check_mean(column(r, 1, column_trace_P), 0.120, 0.003);
    CHECK(column(r, 1, column_unseen).mean == Approx(12.5).margin(1.2));  // theirs: 400 trials
}

TEST_CASE("figures: the filter is pessimistic about the features and right about the robot in all 16 cells", "[long]") {
    for (const Process process : {Process::heading, Process::translation})
        for (const Path path : {Path::straight, Path::circle})
            for (const RangeNoise noise : {RangeNoise::constant, RangeNoise::ranged}) {
                const ScenarioResults r = run(cell(process, path, noise), 2000);
                for (std::size_t arm = 0; arm < 2; ++arm) {
                    const double nees = column(r, arm, column_nees_ratio).mean,
                                 nis = column(r, arm, column_nis_ratio).mean;
                    CHECK((nees > 0.57 && nees < 0.91));
                    CHECK(nis == Approx(0.715).margin(0.025));
                    CHECK(group_ratio(r, arm, "pose") == Approx(1).margin(0.1));
                    // 0.45 to 0.76 on the fixed path; planning brings the features back into sight, and nearer to 1.
                    const double features = group_ratio(r, arm, "features");
                    CHECK((features > 0.43 && features < (arm == 0 ? 0.78 : 0.88)));
                }
            }
}

TEST_CASE("figures: the matched linear filter is exact", "[long]") {
    const ScenarioResults r = run(matched(Process::translation, 0.001), 20000);
    check_mean(column(r, 0, column_nees_ratio), 1, 0);
    check_mean(column(r, 0, column_nis_ratio), 1, 0);
}

TEST_CASE("figures: the matched heading filter shows its linearisation error", "[long]") {
    check_mean(column(run(matched(Process::heading, 0.001), 10000), 0, column_nees_ratio), 1.0006, 0.0040);
    check_mean(column(run(matched(Process::heading, 0.01), 10000), 0, column_nees_ratio), 1.019, 0.004);
    check_mean(column(run(matched(Process::heading, 0.05), 10000), 0, column_nees_ratio), 1.188, 0.005);
}

TEST_CASE("figures: gating on the true range biases even the linear filter a little", "[long]") {
    DeformableSettings s = matched(Process::translation, 0.001);
    s.sensor.range_min = 0.1;
    s.sensor.range_max = 2;
    const Summary gated = column(run(s, 40000), 0, column_nees_ratio);
    check_mean(gated, 1.0085, 0.0039);
    CHECK(gated.ci95.low > 1);
}

TEST_CASE("figures: misinformed filters are off where they were misinformed", "[long]") {
    DeformableSettings s = matched(Process::translation, 0.001);
    s.filter.measurement = 0.8;
    ScenarioResults r = run(s, 10000);
    check_mean(column(r, 0, column_nees_ratio), 1.382, 0.006);
    CHECK(group_ratio(r, 0, "pose") == Approx(0.98).margin(0.08));
    CHECK(group_ratio(r, 0, "feature_0") == Approx(1.165).margin(0.05));
    s.filter = {};
    s.filter.heading = s.filter.odometry = s.filter.features = std::sqrt(0.7);  // Q times 0.7
    r = run(s, 10000);
    check_mean(column(r, 0, column_nees_ratio), 1.107, 0.006);
    CHECK(group_ratio(r, 0, "pose") == Approx(1.41).margin(0.08));
    CHECK(group_ratio(r, 0, "feature_0") == Approx(1.215).margin(0.05));
}

}  // namespace credence::test::figures_long_test
