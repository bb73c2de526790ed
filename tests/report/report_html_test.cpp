// The page has the same values as the JSON, whatever names a file contains, and loads nothing.

#include "catch.hpp"
#include "either_way.hpp"
#include "program.hpp"
#include "study_support.hpp"

#include "report/format.hpp"
#include "report/html/html.hpp"
#include <credence/report.hpp>
#include <credence/text.hpp>

#include <nlohmann/json.hpp>

#include <limits>
#include <set>

namespace credence::test::report_html_test {

using Catch::Contains;
using Json = nlohmann::json;

namespace {

/// A small study of one scenario under both arms, with a published value.
Report titled_report(const std::string& title) {
    DeformableSettings scenario = small_scenarios().back();
    scenario.title = title;
    scenario.published.trace_P = {{"greedy.kf", 0.1234}};
    Study study = new_study({scenario}, 1);
    run_study(study, {300, 1, {}});
    return report_either_way(study, 0.05);
}

const Report& small_report() {
    static const Report report = titled_report("");
    return report;
}

/// Two estimators, so that there is a second chart of the error.
Report charts_report() {
    DeformableSettings scenario = small_scenarios().front();
    scenario.arms.controllers = {Controller::fixed};
    scenario.arms.estimators = {Estimator::ekf, Estimator::riekf};
    Study study = new_study({scenario}, 1);
    run_study(study, {300, 1, {}});
    return report_either_way(study, 0.05);
}

std::string page_of_run(const Report& report) {
    return report_html(report,
                       {"study.h5", {{"command_line", "credence run a.ini & <b>"}, {"threads", "2"}}, "credence test"});
}

/// Everything on the page that could be a number.
std::set<std::string> numbers_of(const std::string& page) {
    std::set<std::string> numbers;
    std::string word;
    for (const char c : page) {
        if (is_name_character(c) || c == '.' || c == '+') {
            word += c;
        } else {
            numbers.insert(word.substr(0, word.find_last_not_of('.') + 1));
            word.clear();
        }
    }
    return numbers;
}

/// Numbers of the JSON that the page shows neither exactly nor to five digits, but for those by step, of which it has
/// charts. Keys name levels as percents there.
void missing_numbers(const Json& json, std::size_t steps, const std::string& key, const std::set<std::string>& shown,
                     std::vector<std::string>& missing) {
    if (json.is_array() && json.size() == steps) return;
    if (json.is_structured()) {
        for (const auto& [name, child] : json.items())
            missing_numbers(child, steps, json.is_array() ? key : key + "/" + name, shown, missing);
    } else if (json.is_number() && !key.ends_with("/level")) {
        const double value = json.get<double>();
        if (shown.count(to_text(value)) + shown.count(short_number(value)) + shown.count(json.dump()) == 0)
            missing.push_back(key + " = " + json.dump());
    }
}

std::size_t steps_of(const Json& arms) { return arms.front()["groups"][0]["anees_se"].size(); }

}  // namespace

TEST_CASE("page: every number of the JSON is on it, but those by step") {
    const Report with_charts = charts_report();
    for (const Report* report : {&with_charts, &small_report()}) {
        std::vector<std::string> missing;
        const Json json = Json::parse(report_json(*report));
        missing_numbers(json, steps_of(json), "", numbers_of(page_of_run(*report)), missing);
        CAPTURE(joined(missing));
        CHECK(missing.empty());
    }
    const Json arms = Json::parse(report_json(small_report()));
    const std::set<std::string> shown = numbers_of(page_of_run(small_report()));
    std::vector<std::string> missing;
    Json changed = arms.front();  // the test itself: a missing number is detected
    changed["trials"] = 123456789;
    missing_numbers(changed, steps_of(arms), "", shown, missing);
    CHECK(missing.size() == 1);
}

TEST_CASE("page: it has the verdicts, the findings, the published value, and how to run the study again") {
    const Report& report = small_report();
    const std::string page = page_of_run(report);
    for (const ArmReport& arm : report.arms) {
        CHECK_THAT(page, Contains("<b>" + arm.arm + "</b>"));
        CHECK_THAT(page, Contains("<span class=\"badge " + verdict_name(arm.consistency.verdict) + "\">"));
        for (const Finding& finding : arm.consistency.findings) CHECK_THAT(page, Contains(finding.when));
    }
    CHECK_THAT(page, Contains("published 0.1234 ("));
    CHECK_THAT(page, Contains("credence run translation-circle.ini --trials 300 --seed 1 -o again.h5"));
}

TEST_CASE("page: every chart has marks with their values, and words for who does not see it") {
    const std::string page = page_of_run(small_report());
    // The verdict's picture and coverage; directions and 2 ellipses; NEES of 6 groups; NIS of 3 groups; whiteness of 2
    // arms; 3 distributions; 8 differences.
    CHECK(count_of(page, "<svg viewBox") == 2 + 3 + 6 + 3 + 2 + 3 + 8);
    for (auto at = page.find("<svg viewBox"); at != std::string::npos; at = page.find("<svg viewBox", at + 1)) {
        const std::string svg = page.substr(at, page.find("</svg>", at) - at);
        CHECK(count_of(svg, "class=\"mark") + count_of(svg, "class=\"bar") >= 4);
        CHECK(count_of(svg, "role=\"img\" aria-labelledby=") == 1);
        CHECK_THAT(svg, Contains("<desc id=") && !Contains("<desc></desc>") && !Contains("nan") && !Contains("inf"));
    }
}

TEST_CASE("page: it loads nothing and runs nothing, whatever a file says") {
    const std::string title =
        "</title></style><script src=https://example.org/x.js></script><img src=x onerror=alert(1)> & \"co\"";
    Report report = titled_report(title);
    report.arms.front().arm = "<b>\"arm'";
    const std::string page = page_of_run(report);
    CHECK_THAT(page, !Contains("<script") && !Contains("<img") && !Contains("<iframe") && !Contains("@import") &&
                         !Contains("url(") && !Contains("<b>\"arm"));
    CHECK_THAT(page, Contains(escaped(title).text()));
    CHECK_THAT(page, Contains("credence run a.ini &amp; &lt;b&gt;"));
    for (const char* attribute : {" href=\"", " src=\""})
        for (auto at = page.find(attribute); at != std::string::npos; at = page.find(attribute, at + 1)) {
            const std::string target = page.substr(page.find('"', at) + 1, 5);
            CHECK((target.starts_with("#") || target == "data:"));
        }
    CHECK_THAT(page, Contains("default-src 'none'"));
}

TEST_CASE("page: the same report gives the same bytes, and arms without a trial left have no charts") {
    CHECK(page_of_run(small_report()) == page_of_run(titled_report("")));
    Study study = small_study(1, 300, 1);
    for (ScenarioResults& results : study.scenarios)
        for (ArmResults& arm : results.arms) {
            const std::string name = arm.name;
            arm = empty_results(results.scenario).arms.front();
            arm.name = name;
            arm.columns.in_memory().assign(results.columns.size(),
                                           std::vector<double>(300, std::numeric_limits<double>::quiet_NaN()));
            arm.columns.in_memory()[column_status].assign(300, static_cast<double>(Status::non_finite));
            arm.columns.in_memory()[column_status_pose].assign(300, 3);
            arm.errors.assign(300 * 7 * static_cast<std::size_t>(results.state_size()),
                              std::numeric_limits<double>::quiet_NaN());
            arm.nees.assign(300 * 7, std::numeric_limits<double>::quiet_NaN());
        }
    for (ScenarioResults& results : study.scenarios) recount(results);
    const std::string page = page_of_run(make_report(study, 0.05));
    CHECK_THAT(page, Contains("WARNING: 300 of 300 trials") && Contains("no trial is left that could be judged") &&
                         !Contains("<svg") && !Contains(">nan"));
}

TEST_CASE("page: report, compare and judge write it") {
    const Workplace work;
    REQUIRE(work.credence("run " + seed_scenario("kf-straight-constant") + " --trials 40 --quiet -o s.h5").exit_code ==
            0);
    CHECK(work.credence("report s.h5 --format html -o page.html").exit_code == 0);
    const std::string page = work.read("page.html");
    CHECK_THAT(page, Contains("s.h5: 40 trials of each arm, root seed 1.") && Contains("git revision") &&
                         Contains("instruction set"));
    CHECK(work.credence("report s.h5 --format html").out == page);
    CHECK(work.credence("report s.h5 --format html -o page.html").exit_code == 2);  // it is there already
    CHECK_THAT(work.credence("report --help").out, Contains("html"));

    const std::string compared = work.credence("compare s.h5 --format html").out;
    CHECK(count_of(compared, "<svg ") == 8);
    std::vector<std::string> missing;
    missing_numbers(Json::parse(work.credence("compare s.h5 --format json").out), 0, "", numbers_of(compared), missing);
    CAPTURE(joined(missing));
    CHECK(missing.empty());

    const std::string record = CREDENCE_SOURCE "/tests/reference/record_single.h5";
    const std::string judged = work.credence("judge '" + record + "' --format html --quiet").out;
    CHECK_THAT(judged, Contains("record_single.h5") && Contains("<svg ") && !Contains("<h3>Scenario</h3>") &&
                           !Contains(CREDENCE_SOURCE));
}

}  // namespace credence::test::report_html_test
