#pragma once
// The expected snapshots, for the tests of watching a run.

#include "report/watch/watch.hpp"

#include "journal_support.hpp"

namespace credence::test {

/// Two scenarios of two arms each.
inline Asked small(std::int64_t trials, Shard shard = {}) { return {trials, 1, shard, small_scenarios(), 1}; }

/// The mean is that of the exact sum up to the rounding of some hundred additions; so is the spread.
inline void check_same(const Moments& moments, const Summary& expected) {
    CHECK(moments.count == static_cast<double>(expected.count));
    CHECK(moments.mean == Approx(expected.mean).epsilon(1e-13).margin(1e-15));
    CHECK(moments.standard_deviation == Approx(expected.standard_deviation).epsilon(1e-12));
    CHECK(t_interval(moments).low == Approx(expected.ci95.low).epsilon(1e-12).margin(1e-15));
}

/// Those of the pairs that have both values.
inline std::vector<double> paired_differences(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> differences;
    for (std::size_t i = 0; i < a.size(); ++i) differences.push_back(a[i] - b[i]);
    return differences;  // of others they are NaN
}

inline std::vector<double> trace_of(const ScenarioResults& results, const ArmResults& arm) {
    return figure_values(results, arm, column_trace_P);
}

/// The snapshot has the means of these trials.
inline void check_says(const Snapshot& snapshot, const Study& study) {
    REQUIRE(snapshot.scenarios.size() == study.scenarios.size());
    for (std::size_t s = 0; s < study.scenarios.size(); ++s) {
        const ScenarioResults& results = study.scenarios[s];
        const WatchedScenario& scenario = snapshot.scenarios[s];
        CHECK(scenario.name == results.scenario.name);
        CHECK(scenario.trials == results.trials);
        CHECK(scenario.blocks == static_cast<std::int64_t>(results.blocks.size()));
        REQUIRE(scenario.arms.size() == results.arms.size());
        if (results.trials == 0) continue;
        for (std::size_t a = 0; a < results.arms.size(); ++a) {
            const WatchedArm& arm = scenario.arms[a];
            CAPTURE(scenario.name, arm.name);
            CHECK(arm.failed == results.trials - results.arms[a].totals.trials.counted());
            for (std::size_t f = 0; f < arm.columns.size(); ++f)
                check_same(arm.columns[f],
                           summarise(figure_values(results, results.arms[a], watched_columns(results.columns)[f])));
            const ArmResults* fixed = baseline_of(results, results.arms[a]);
            CHECK(arm.other == (fixed ? fixed->name : ""));
            if (fixed) {
                const std::vector<double> own = trace_of(results, results.arms[a]), other = trace_of(results, *fixed);
                check_same(arm.difference, summarise(paired_differences(own, other)));
            }
        }
    }
}

}  // namespace credence::test
