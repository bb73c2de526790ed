// The report has the values of the study.

#include <cmath>
#include <credence/error.hpp>
#include <credence/report.hpp>
#include <credence/text.hpp>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "either_way.hpp"
#include "study_support.hpp"

namespace credence::test::report_test {

using Catch::Contains;
using Json = nlohmann::json;

namespace {

/// A study of 300 trials in which a tenth of one arm's trials are made to have failed, most of them at pose 3.
Study with_failures() {
    Study study = small_study(1, 300, 1);
    ScenarioResults& results = study.scenarios.front();
    fail_trials(results, 0, 0, 20);
    fail_trials(results, 0, 20, 6, Status::non_finite, 5);
    fail_trials(results, 0, 26, 4, Status::covariance_not_positive_definite);
    recount(results);
    return study;
}

}  // namespace

TEST_CASE("report: its means are the means of the columns") {
    const Study study = small_study(1, 300, 1);
    const Report report = report_either_way(study, 0.05);
    REQUIRE(report.arms.size() == 4);
    REQUIRE(report.pairs.size() == 2);
    const auto& planned = study.scenarios[1].arms[1].columns.in_memory()[column_trace_P];
    const auto& fixed = study.scenarios[1].arms[0].columns.in_memory()[column_trace_P];
    double mean = 0, difference = 0;
    for (std::size_t i = 0; i < 300; ++i) mean += planned[i] / 300, difference += (planned[i] - fixed[i]) / 300;
    CHECK(report.arms[3].columns[column_trace_P].summary.mean == Approx(mean).epsilon(1e-13));
    CHECK(report.pairs[1].columns[column_trace_P].paired.difference.mean == Approx(difference).epsilon(1e-12));
    CHECK(report.pairs[1].name() == std::string("greedy.kf - fixed.kf"));
}

TEST_CASE("report: failed trials are counted and shown, and columns are summarised without them") {
    const Study study = with_failures();
    const Report report = report_either_way(study, 0.05);
    CHECK(report.arms.front().trials == 300);
    CHECK(report.arms.front().failed == 30);
    CHECK(report.arms.front().columns[column_unseen].summary.count == 270);
    CHECK(report.arms.front().columns[column_unseen].summary.mean >= 0);  // the fill, -1, is not a value
    CHECK(report.pairs.front().columns[column_trace_P].paired.pairs == 270);
    CHECK(report_text(report).find("WARNING: 30 of 300 trials of heading-straight/fixed.ekf failed") == 0);
    CHECK(report_text(report_either_way(small_study(1, 300, 1), 0.05)).find("WARNING") == std::string::npos);
}

TEST_CASE("report: where trials failed it says with which status, and at which pose most of them did") {
    const Report report = report_either_way(with_failures(), 0.05);
    const std::string says = "30 of 300 trials failed, more than 1 %: 26 with status non_finite, 20 of these at pose 3";
    CHECK_THAT(report_text(report), Contains(says));
    CHECK_THAT(report_html(report, {"study.h5", {}, "test"}), Contains(says));
    const Json arms = Json::parse(report_json(report));
    CHECK(arms.front()["reason"] == says);
    CHECK(arms.front()["failed_most"] ==
          Json{{"status", "non_finite"}, {"trials", 26}, {"pose", 3}, {"trials_there", 20}});
    CHECK_FALSE(arms.back().contains("failed_most"));
}

TEST_CASE("report: diverged trials stay in the columns and are named") {
    Study study = small_study(1, 300, 1);
    study.scenarios.front().arms.front().columns.in_memory()[column_status][7] = static_cast<double>(Status::diverged);
    recount(study.scenarios.front());
    const Report report = report_either_way(study, 0.05);
    CHECK(report.arms.front().diverged == 1);
    CHECK(report.arms.front().failed == 0);
    CHECK(report.arms.front().columns.front().summary.count == 300);
    CHECK_THAT(report_text(report), Contains("1 trial of heading-straight/fixed.ekf diverged"));
}

TEST_CASE("report: a published value is shown at its percentile") {
    std::vector<DeformableSettings> scenarios = small_scenarios();
    scenarios.front().published.unseen = {{"greedy.ekf", 2}};
    Study study = new_study(scenarios, 1);
    run_study(study, {300, 1, {}});
    const Report report = report_either_way(study, 0.05);
    const auto& unseen = study.scenarios.front().arms[1].columns.in_memory()[column_unseen];
    double below = 0, equal = 0;
    for (const double value : unseen) below += value < 2, equal += value == 2;
    const ColumnReport& figure = report.arms[1].columns[column_unseen];
    REQUIRE(figure.published);
    CHECK(figure.published->percentile == Approx(100 * (below + equal / 2) / 300).epsilon(1e-13));
    CHECK_FALSE(report.arms[0].columns[column_unseen].published);
}

TEST_CASE("report: JSON and CSV have the report's numbers, with NaN as null or an empty cell") {
    Study study = with_failures();
    std::ranges::fill(study.scenarios.front().arms.front().columns.in_memory()[column_status], 3);  // all failed
    recount(study.scenarios.front());
    const Report report = report_either_way(study, 0.05);
    const Json arms = Json::parse(report_json(report));
    CHECK(arms[0]["failed"] == 300);
    CHECK(arms[0]["trace_P"]["mean"].is_null());
    CHECK(arms[1]["trace_P"]["mean"] == report.arms[1].columns[column_trace_P].summary.mean);
    CHECK(arms[1]["groups"].size() == 8);  // all, pose, heading, position, features, 3 features
    const std::string csv = report_csv(report);
    const DirectionOfGroup& largest = report.arms[1].consistency.directions.largest.front();
    CHECK_THAT(csv, Contains(",direction_largest:all,1," + to_text(largest.ratio) + ",," +
                             to_text(largest.interval.low) + "," + to_text(largest.interval.high) + ","));
    CHECK_THAT(csv, Contains(",direction_largest:all:" + largest.loadings[0].component + ",1," +
                             to_text(largest.loadings[0].weight)));
    const Json same = arms[1]["directions"]["largest"][0];
    CHECK(same["loadings"][largest.loadings[0].component] == largest.loadings[0].weight);
    CHECK(same["level"] == largest.level);
    CHECK_THAT(csv, Contains("heading-straight,fixed.ekf,300,300,trace_P,dm^2 + rad^2,,,,,,,,,"));
}

TEST_CASE("report: requiring consistency names the arms that are not") {
    const Report report = report_either_way(small_study(1, 300, 1), 0.05);
    CHECK_THROWS_WITH(require(report, Requirement::consistent), Contains("heading-straight/fixed.ekf is "));
    Report none = report;
    none.arms.clear();
    CHECK_NOTHROW(require(none, Requirement::consistent));
}

}  // namespace credence::test::report_test
