// No sentence of a report says `nan` or `inf`, whatever became of the trials; and an arm that is not run yet is
// said to be so, in every form.

#include "catch.hpp"
#include "either_way.hpp"
#include "study_support.hpp"

#include "report/compare/compare.hpp"
#include <credence/report.hpp>

#include "report/words.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <regex>

namespace credence::test::no_nan_test {

using Catch::Contains;
using Json = nlohmann::json;

namespace {

Study run(const std::vector<DeformableSettings>& scenarios, std::int64_t trials, Keep keep = Keep::trials) {
    Study study = new_study(scenarios, 1, keep);
    run_study(study, {trials, 1, {}});
    return study;
}

DeformableSettings small(const std::function<void(DeformableSettings&)>& change) {
    DeformableSettings scenario = small_scenarios().front();
    change(scenario);
    return resolved(scenario);
}

/// P is beyond 1e12 in some of its trials, with an S that has no whitened innovation.
Study noise_of_1e9() {
    return run({small([](DeformableSettings& s) {
                   s.poses = 20;
                   s.noise.heading = 1e9;
               })}, 150);
}

/// Every trial of the first arm ends like that.
Study all_ended(Status status) {
    Study study = run(small_scenarios(), 40);
    ArmResults& arm = study.scenarios.front().arms.front();
    std::ranges::fill(arm.columns.in_memory()[column_status], static_cast<double>(status));
    recount(study.scenarios.front());
    return study;
}

/// A study in which nothing is a number any more, of the totals and of the columns.
Study without_numbers(double value) {
    Study study = run(small_scenarios(), 40);
    for (ScenarioResults& results : study.scenarios)
        for (ArmResults& arm : results.arms) {
            for (std::size_t c = 0; c < results.columns.size(); ++c)
                if (is_reported(results.columns[c])) std::ranges::fill(arm.columns.in_memory()[c], value);
            for (SeriesTotals& totals : arm.totals.series) {
                for (ExactSum& sum : totals.sum) sum.add(value);
                for (ExactSum& sum : totals.square_sum) sum.add(value);
                totals.run_square_sum.add(value);
            }
            for (ExactSum& sum : arm.totals.products.sum) sum.add(value);
            for (double& one : arm.nees) one = value;
        }
    for (ScenarioResults& results : study.scenarios) recount(results);
    return study;
}

/// Without the scenario's text, in which a range may be infinite.
std::string without_scenario(const std::string& page) {
    return std::regex_replace(page, std::regex("<pre[^>]*>[^<]*</pre>"), "");
}

/// The first line that has one of these words.
std::string first_with_nan(const std::string& text) {
    static const std::regex word("(^|[^A-Za-z_])-?(nan|inf|infinity)([^A-Za-z_]|$)", std::regex::icase);
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        if (std::regex_search(line, word)) return line.substr(0, 300);
    return "";
}

/// `is_stored`: a file can hold it.
void check_renderings(const Study& study, bool is_stored = true) {
    Report report = is_stored ? report_either_way(study, {}) : make_report(study, {});
    for (const double failed_share : {0.01, 1.0}) {
        report.limits.failed = failed_share;
        for (ArmReport& arm : report.arms) arm.consistency = judge(arm.evidence, report.limits);
        CHECK(first_with_nan(report_text(report)) == "");
        CHECK(first_with_nan(report_json(report)) == "");
        CHECK(first_with_nan(report_csv(report)) == "");
        CHECK(first_with_nan(without_scenario(report_html(report, {"r.h5", {}, "test"}))) == "");
        for (const ArmReport& arm : report.arms)
            for (const Reason& reason : reasons_of(arm)) CHECK(first_with_nan(reason_text(reason)) == "");
    }
    const auto compare = [](const Study& either) { return compare_studies({{"r.h5", either}}, std::nullopt); };
    const CompareReport compared = is_stored ? either_way(study, read_back(study), compare) : compare(study);
    for (const auto& text : {compare_text(compared), compare_json(compared), compare_csv(compared),
                             without_scenario(compare_html(compared, "test"))})
        CHECK(first_with_nan(text) == "");
}

/// Stopped in its first scenario: the others have no trial.
Study interrupted(Keep keep) {
    Study study = new_study(small_scenarios(), 1, keep);
    int blocks = 0;
    RunOptions options{600, 1, {}};
    options.stop = [&] { return blocks++ == 1; };
    run_study(study, options);
    return study;
}

}  // namespace

TEST_CASE("report: no sentence says nan or inf, of studies that fail in every way") {
    constexpr double not_finite = std::numeric_limits<double>::infinity();
    SECTION("noise of 1e9") { check_renderings(noise_of_1e9()); }
    SECTION("P beyond 1e12") { check_renderings(run({small([](DeformableSettings& s) { s.noise.odometry = 1e7; })}, 20)); }
    SECTION("one trial") { check_renderings(run(small_scenarios(), 1)); }
    SECTION("two trials") { check_renderings(run(small_scenarios(), 2)); }
    SECTION("no trial") { check_renderings(new_study(small_scenarios(), 1)); }
    SECTION("all failed") { check_renderings(all_ended(Status::non_finite)); }
    SECTION("all diverged") { check_renderings(all_ended(Status::diverged)); }
    SECTION("nothing is a number") { check_renderings(without_numbers(std::nan("")), false); }
    SECTION("everything is infinite") { check_renderings(without_numbers(not_finite), false); }
    SECTION("aggregates, one trial") { check_renderings(run(small_scenarios(), 1, Keep::aggregates)); }
    SECTION("interrupted") { check_renderings(interrupted(Keep::trials)); }
}

TEST_CASE("report: an unknown correlation of innovations is said to be so, and is no finding") {
    const Report report = report_either_way(noise_of_1e9(), 0.05);
    const Evidence& evidence = report.arms.front().evidence;
    REQUIRE(std::any_of(evidence.whiteness.begin(), evidence.whiteness.end(), [](auto& lag) { return !lag.known(); }));
    for (const Finding& caution : report.arms.front().consistency.cautions) CHECK(caution.what != Fault::correlated);
    CHECK_THAT(report_text(report), Contains("note, innovations: their correlation could not be computed"));
}

TEST_CASE("report: an arm that is not run yet is said to be so, in every form") {
    for (const Keep keep : {Keep::trials, Keep::aggregates}) {
        const Study study = interrupted(keep);
        REQUIRE(study.scenarios.front().trials == block_size);
        REQUIRE(study.scenarios.back().trials == 0);
        const Report report = report_either_way(study, 0.05);
        const std::string text = report_text(report);
        CHECK_THAT(text, Contains("256 trials of each arm run so far, root seed 1") &&
                             Contains("asked for 600 trials of each arm, and 2 of 4 arms are not run yet.") &&
                             Contains("translation-circle/fixed.kf   not run yet ") &&
                             Contains("\ntranslation-circle\n  not run yet\n") && !Contains("no trial is left"));
        const Json json = Json::parse(report_json(report));
        CHECK(json[0].value("reason", "").find("not run") == std::string::npos);
        CHECK(json[3]["trials"] == 0);
        CHECK(json[3]["verdict"] == "undecided");
        CHECK(json[3]["reason"] == "not run yet: no trial of it is in the file");
        CHECK_THAT(report_csv(report),
                   Contains("translation-circle,fixed.kf,0,0,trace_P,dm^2,,,,,,,,,,,not run yet,0\n"));
        const std::string page = report_html(report, {"r.h5", {}, "test"});
        CHECK_THAT(page, Contains("2 not run yet.") && Contains("</span> not run yet</span>") &&
                             !Contains("no trial is left"));
        CHECK_THROWS_WITH(require(report, Requirement::consistent), Contains("translation-circle/greedy.kf is not run yet"));

        const CompareReport compared = compare_studies({{"r.h5", study}}, std::nullopt);
        CHECK(compared.pairs.back().conclusion == Conclusion::not_run);
        CHECK(conclusion_name(Conclusion::not_run) == "not run yet");
        CHECK_THAT(compare_text(compared),
                   Contains("trace_P: greedy.kf and fixed.kf are not run yet") &&
                       Contains("trial by trial: 256 pairs. Negative") &&
                       Contains("note: a study is not complete: 1 of 2 comparisons are not run yet."));
        CHECK_THAT(compare_html(compared, "test"), Contains("greedy.kf and fixed.kf are not run yet"));
        CHECK(Json::parse(compare_json(compared))[1]["conclusion"] == "not run yet");
    }
}

}  // namespace credence::test::no_nan_test
