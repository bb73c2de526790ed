// What the page shows: values without a place on an axis, sensors that speak now and then, mixed verdicts, sweeps.

#include <credence/report.hpp>

#include "catch.hpp"
#include "either_way.hpp"
#include "of_scenarios.hpp"
#include "program.hpp"
#include "record_support.hpp"
#include "report/html/charts/chart.hpp"
#include "study_support.hpp"

namespace credence::test::page_test {

using Catch::Contains;

namespace {

/// The drawing whose title begins so.
std::string drawing_of(const std::string& page, const std::string& title) {
    const std::size_t at = page.find("-t\">" + title), from = page.rfind("<svg", at);
    REQUIRE(at != std::string::npos);
    return page.substr(from, page.find("</svg>", from) - from);
}

}  // namespace

TEST_CASE("page: a published value that is not positive is at the end of a logarithmic axis") {
    for (const double published : {0.0, -1.0, 1e-300}) {
        DeformableSettings scenario = small_scenarios().back();
        scenario.published.trace_P = {{"greedy.kf", published}};
        Study study = new_study({scenario}, 1);
        run_study(study, {60, 1, {}});
        const std::string page = page_of(report_either_way(study, 0.05)),
                          drawing = drawing_of(page, scenario.name + ": distribution of trace(P)");
        CHECK(drawing.size() < 100000);
        CHECK_THAT(drawing, Contains("class=\"published\"") && !Contains("nan") && !Contains("inf"));
    }
}

TEST_CASE("page: of a sensor that speaks at every tenth step each innovation has a mark of its own") {
    DrawnRecord record(20, 300, 2, 1);
    for (int i = 0; i < 20; ++i)
        for (int k = 0; k < 300; ++k)
            if (k % 10 != 9) record.innovation[record.at(i, k)].setConstant(std::nan(""));
    const std::string page = page_of(report_of(record)),
                      drawing = drawing_of(page, "record: NIS/m of rows: all by step");
    CHECK(count_of(drawing, "class=\"mark") == 30);
}

TEST_CASE("page: a mixed verdict has all of its reasons beside it") {
    DrawnRecord record(2000, 3, 2);
    for (Eigen::VectorXd& error : record.error) error(0) *= 1.6;
    for (Eigen::MatrixXd& P : record.covariance) P.col(1) *= 2, P.row(1) *= 2;
    const Report report = report_of(record);
    REQUIRE(report.arms.front().consistency.verdict == Verdict::mixed);
    const std::string page = page_of(report), why = page.substr(page.find("class=\"why\""), 600);
    CHECK_THAT(why, Contains("optimistic (") && Contains("; pessimistic ("));
}

TEST_CASE("page: the tables of a sweep come before its points, which are folded, and units have raised powers") {
    const Workplace work;
    REQUIRE(work.credence("run " + seed_scenario("kf-circle-constant") +
                          " --trials 30 --quiet -o s.h5 --sweep noise.deformation=0.1,0.2,0.3")
                .exit_code == 0);
    const std::string page = work.credence("report s.h5 --format html").out;
    CHECK(page.find("by point: mean") < page.find("Everything of this point"));
    CHECK(count_of(page, "class=\"arm\"") == 0);  // their verdicts are in the table
    CHECK(count_of(page, "<summary>Everything of this point</summary>") == 3);
    const std::string without_scenarios = page.substr(0, page.find("Everything of this point"));
    CHECK_THAT(without_scenarios, Contains("trace_P [dm²]") && !Contains("dm^2"));
}

TEST_CASE("page: a text that is longer than its drawing is moved and narrowed into it, and a cut one says so") {
    Svg svg(100, 20);
    svg.text({90, 5}, Anchor::start, "twelve signs");
    svg.text({50, 5}, Anchor::middle, std::string(40, 'x'));
    const std::string drawn = svg.html("id", "title", "words").text();
    CHECK_THAT(drawn, Contains("x=\"23.6\"") && Contains("textLength=\"96\""));
    CHECK(shortened("größer", 6) == "größer");
    CHECK(shortened("größtes", 6) == "größt…");
    CHECK(shortened("0.71 theta - 0.62 r_x + 0.22 r_y", 28) == "0.71 theta - 0.62 r_x +…");
}

}  // namespace credence::test::page_test
