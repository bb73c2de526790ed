// NEES in another chart of the error is shown beside the Euclidean one, and no verdict uses it.

#include "catch.hpp"
#include "either_way.hpp"
#include "study_support.hpp"

#include <credence/report.hpp>

#include <nlohmann/json.hpp>

namespace credence::test::report_charts_test {

using Catch::Contains;
using Json = nlohmann::json;

namespace {

/// Both charts of two estimators; much heading noise, so that they differ.
Study two_charts() {
    DeformableSettings scenario = small_scenarios().front();
    scenario.noise.heading = 0.1;
    scenario.arms.controllers = {Controller::fixed};
    scenario.arms.estimators = {Estimator::ekf, Estimator::riekf};
    Study study = new_study({scenario}, 1);
    run_study(study, {300, 1, {}});
    return study;
}

std::size_t column_named(const ScenarioResults& results, const std::string& name) {
    for (std::size_t f = 0; f < results.all_series.size(); ++f)
        if (results.all_series[f].name == name) return f;
    FAIL("no figure " + name);
    return 0;
}

}  // namespace

TEST_CASE("charts: the evidence is the series' totals over their dimension") {
    const Study study = two_charts();
    const ScenarioResults& results = study.scenarios.front();
    for (const ArmResults& arm : results.arms) {
        const Evidence evidence = evidence_of(results, arm);
        REQUIRE(evidence.charts.size() == 2);
        for (const auto& [chart, name, group, dimension] :
             {std::tuple{evidence.charts[0], "nees_invariant", "all", 9},
              std::tuple{evidence.charts[1], "nees_invariant_pose", "pose", 3}}) {
            CHECK(chart.chart == "invariant");
            CHECK(chart.name == group);
            CHECK(chart.dimension == dimension);
            const SeriesTotals& totals = arm.totals.series[column_named(results, name)];
            double sum = 0;
            for (std::size_t k = 0; k < totals.sum.size(); ++k) {
                const double mean = totals.sum[k].rounded() / 300 / dimension;
                CHECK(chart.step[k].mean == Approx(mean).epsilon(1e-13));
                CHECK(chart.anees.ratio[k] == Approx(mean).epsilon(1e-13));
                sum += mean / static_cast<double>(totals.sum.size());
            }
            CHECK(chart.run.mean == Approx(sum).epsilon(1e-13));
        }
        CHECK(evidence.charts[0].run.mean != evidence.groups[0].run.mean);
    }
}

TEST_CASE("charts: no verdict, finding or caution depends on them") {
    Study study = two_charts();
    ScenarioResults& results = study.scenarios.front();
    Evidence evidence = evidence_of(results, results.arms[0]);
    const Consistency with = judge(evidence, 0.05);
    for (ChartEvidence& chart : evidence.charts) chart.run.mean = 99, chart.step.assign(chart.step.size(), chart.run);
    const Consistency wrong = judge(evidence, 0.05);
    CHECK(with.verdict == wrong.verdict);
    CHECK(with.findings.size() == wrong.findings.size());
    CHECK(with.cautions.size() == wrong.cautions.size());
    CHECK(with.trials_needed.value == wrong.trials_needed.value);
}

TEST_CASE("charts: text, JSON and CSV show them; scenarios without another estimator have none") {
    const Report report = report_either_way(two_charts(), 0.05);
    CHECK_THAT(report_text(report), Contains("NEES/dim in the invariant chart, not judged: all "));
    const Json arm = Json::parse(report_json(report)).front();
    REQUIRE(arm["other_charts"].size() == 2);
    CHECK(arm["other_charts"][1]["group"] == "pose");
    CHECK(arm["other_charts"][1]["chart"] == "invariant");
    CHECK(arm["other_charts"][1]["nees_ratio"].get<double>() == report.arms[0].evidence.charts[1].run.mean);
    CHECK_THAT(report_csv(report), Contains(",nees_per_dimension_invariant:all,") &&
                                       Contains(",nees_per_dimension_invariant:pose:3,"));
    const Report plain = report_either_way(small_study(1, 20, 1), 0.05);
    CHECK_THAT(report_text(plain), !Contains("invariant"));
    CHECK_THAT(report_csv(plain), !Contains("invariant"));
    CHECK(!Json::parse(report_json(plain)).front().contains("other_charts"));
}

}  // namespace credence::test::report_charts_test
