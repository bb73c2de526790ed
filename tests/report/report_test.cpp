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

/// A study of 300 trials in which a tenth of one arm's trials are made to have failed.
Study with_failures() {
    Study study = small_study(1, 300, 1);
    ArmResults& arm = study.scenarios.front().arms.front();
    for (std::size_t i = 0; i < 30; ++i) {
        std::vector<double> values;
        for (const auto& column : arm.columns.in_memory()) values.push_back(column[i]);
        values[column_status] = static_cast<double>(Status::non_finite);
        values[column_status_pose] = 3;
        fill_failed(study.scenarios.front().columns, values.data());
        for (std::size_t c = 0; c < values.size(); ++c) arm.columns.in_memory()[c][i] = values[c];
    }
    recount(study.scenarios.front());
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

TEST_CASE("report: lost trials stay in the columns and are named") {
    Study study = small_study(1, 300, 1);
    study.scenarios.front().arms.front().columns.in_memory()[column_status][7] = static_cast<double>(Status::lost);
    recount(study.scenarios.front());
    const Report report = report_either_way(study, 0.05);
    CHECK(report.arms.front().lost == 1);
    CHECK(report.arms.front().failed == 0);
    CHECK(report.arms.front().columns.front().summary.count == 300);
    CHECK_THAT(report_text(report), Contains("1 trial of heading-straight/fixed.ekf is lost"));
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

TEST_CASE("report: JSON has every number with NaN as null, CSV a row for each") {
    Study study = with_failures();
    std::ranges::fill(study.scenarios.front().arms.front().columns.in_memory()[column_status], 3);  // all failed
    recount(study.scenarios.front());
    const Report report = report_either_way(study, 0.05);
    const Json arms = Json::parse(report_json(report));
    REQUIRE(arms.size() == 4);
    CHECK(arms[0]["failed"] == 300);
    CHECK(arms[0]["trace_P"]["mean"].is_null());
    CHECK(arms[1]["trace_P"]["mean"] == report.arms[1].columns[column_trace_P].summary.mean);
    CHECK(arms[1]["groups"].size() == 8);  // all, pose, heading, position, features, 3 features
    const std::string csv = report_csv(report);
    std::int64_t evidence_rows = 0;
    for (const ArmReport& arm : report.arms) {
        const auto count = [](const auto& list) { return static_cast<std::int64_t>(list.size()); };
        const Evidence& e = arm.evidence;
        const std::int64_t steps = e.steps;
        // A direction of a group: its ratio and a row for each of its components; a level a group; the spectrum.
        const DirectionsFound& directions = arm.consistency.directions;
        std::int64_t direction_rows = count(directions.largest) + count(directions.spectrum);
        for (const auto* list : {&directions.largest, &directions.smallest})
            for (const DirectionOfGroup& one : *list) direction_rows += 1 + count(one.loadings);
        if (arm.failed_trials() < 100) CHECK(direction_rows > 20);
        // A group: NEES, its rounding, RMSE, and by step NEES, four levels of coverage and the variance; NIS and by
        // step; NCI and I2.
        evidence_rows += count(e.groups) * (3 + steps * 6) + count(e.nis) * (1 + steps) + count(e.whiteness) +
                         count(e.bias) * steps + steps + 2 + direction_rows;
    }
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + 8 * (4 + 2) + evidence_rows);
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
