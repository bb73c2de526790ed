// Of trials that failed the report says how most of them ended, and where.

#include <credence/report.hpp>
#include <credence/slam_columns.hpp>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "either_way.hpp"
#include "study_support.hpp"

namespace credence::test::failure_test {

using Catch::Contains;
using Json = nlohmann::json;

namespace {

/// 40 of 100 trials of the first arm are not finite, 30 of them at pose 3; 10 have no covariance.
Study failing_study() {
    Study study = small_study(1, 100, 1);
    std::vector<std::vector<double>>& columns = study.scenarios.front().arms.front().columns.in_memory();
    for (std::size_t i = 0; i < 50; ++i) {
        columns[column_status][i] =
            static_cast<double>(i < 40 ? Status::non_finite : Status::covariance_not_positive_definite);
        columns[column_status_pose][i] = i < 30 ? 3 : 5;
    }
    recount(study.scenarios.front());
    return study;
}

}  // namespace

TEST_CASE("report: where trials failed it says with which status, and at which pose most of them did") {
    const Report report = report_either_way(failing_study(), 0.05);
    const std::string says = "50 of 100 trials failed, more than 1 %: 40 with status non_finite, 30 of these at pose 3";
    CHECK_THAT(report_text(report), Contains(says));
    CHECK_THAT(report_html(report, {"study.h5", {}, "test"}), Contains(says));
    const Json arm = Json::parse(report_json(report)).front();
    CHECK(arm["reason"] == says);
    CHECK(arm["failed_most"] == Json{{"status", "non_finite"}, {"trials", 40}, {"pose", 3}, {"trials_there", 30}});
    CHECK_FALSE(Json::parse(report_json(report)).back().contains("failed_most"));
}

}  // namespace credence::test::failure_test
