// Approved texts of a small study, a sweep, a record and a comparison: as text whole, and of the other formats what
// they have: the members of JSON, the names of CSV, the headings, tables and charts of pages.

#include "approved.hpp"

#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "compare_support.hpp"
#include "record_support.hpp"
#include "study_support.hpp"

namespace credence::test::approved_test {

namespace {

/// A scenario by itself, with failed and diverged trials and a published value, and two points of a sweep.
const Study& small_study() {
    static const Study study = [] {
        const std::string world = "[scenario]\nposes = 3\n[features]\npositions = 0.5 0.5\n[edges]\ngraph = none\n" +
                                  std::string("[planner]\nspeeds = 1\n");
        std::vector<Scenario> scenarios{read_scenario_text(world + "[published]\ntrace_P = greedy.ekf 0.2\n",
                                                           "alone.ini", "alone", {{"scenario.title", "A title"}})};
        for (const char* sigma : {"0.05", "0.2"})
            scenarios.push_back(read_scenario_text(world + "[sweep]\nof = base\nat = sensor.sigma=" + sigma, "x.ini",
                                                   "base_" + std::string(sigma).substr(2), {{"sensor.sigma", sigma}}));
        Study run = new_study(scenarios, 1);
        run_study(run, {300, 1, {}});
        fail_trials(run.scenarios.front(), 0, 0, 4);
        run.scenarios.front().arms.front().columns.in_memory()[column_status][9] =
            static_cast<double>(Status::diverged);
        recount(run.scenarios.front());
        return run;
    }();
    return study;
}

Report record_report() {
    return report_written([&](const Handle& root) {
        write_drawn(root, DrawnRecord(60, 4, 3, 2));
        hdf5::write_text(root, "groups", "pose 0:2, rest 2");
    });
}

CompareReport comparison() {
    Study alone = small_study();
    alone.scenarios.resize(1);
    return compared({{"small.h5", alone}});
}

/// A line for each object with the names of its members, lists by their first entry.
void members(const Json& json, const std::string& path, std::ostream& out) {
    if (json.is_array() && !json.empty()) return members(json[0], path + "[]", out);
    if (!json.is_object()) return;
    out << path << ":";
    for (const auto& [name, child] : json.items()) out << " " << name;
    out << "\n";
    std::set<std::string> said;  // columns have the same members
    for (const auto& [name, child] : json.items()) {
        std::ostringstream inner;
        members(child, "", inner);
        if (!inner.str().empty() && said.insert(inner.str()).second) members(child, path + "/" + name, out);
    }
}

std::string members(const std::string& json) {
    std::ostringstream out;
    members(Json::parse(json), "", out);
    return out.str();
}

/// The head, and the names of the rows, a line for those of one kind; N: numbers, of which the last is there.
std::string names(const std::string& csv) {
    std::istringstream lines(csv);
    std::string line, text;
    std::getline(lines, text);
    const std::size_t column = text.starts_with("scenario,arm") ? 4 : 3;
    std::map<std::string, std::map<std::string, std::string>> kinds;
    while (std::getline(lines, line)) {
        for (std::size_t i = 0; i < column; ++i) line.erase(0, line.find(',') + 1);
        const std::string name = line.substr(0, line.find(',')), kind = name.substr(0, name.find(':')),
                          rest = name.substr(std::min(name.size(), kind.size() + 1));
        std::smatch number;
        if (std::regex_search(rest, number, std::regex("(^|:)([0-9]+)$")))
            kinds[kind][number.prefix().str() + ":N"] = number[2];
        else
            kinds[kind][rest];
    }
    for (const auto& [kind, of_kind] : kinds) {
        text += "\n" + kind;
        for (const auto& [rest, last] : of_kind)
            text += (rest.empty() ? "" : " " + rest) + (last.empty() ? "" : "=" + last);
    }
    return text + "\n";
}

/// Headings, captions, and heads of columns, each once, whatever scenario and arm they are of.
std::string outline(const std::string& page) {
    const std::regex part("<(h[1-4]|caption|figcaption|summary|thead)[^>]*>([^]*?)</\\1>"), tag("<[^>]*>"),
        head("</th><th[^>]*>"), scenario("alone|base_[0-9]+"), arm("(fixed|greedy).ekf");
    std::string text;
    std::set<std::string> said;
    for (std::sregex_iterator one(page.begin(), page.end(), part); one != std::sregex_iterator(); ++one) {
        std::string words = (*one)[2].str();
        words = std::regex_replace(std::regex_replace(words, head, " | "), tag, "");
        words = std::regex_replace(std::regex_replace(words, scenario, "SCENARIO"), arm, "ARM");
        if (said.insert(words).second) text += (*one)[1].str() + " " + words + "\n";
    }
    return text;
}

}  // namespace

TEST_CASE("approved: reports and comparisons as text") {
    const std::regex hash("study [0-9a-f-]{36}");  // it changes with the schema
    check_approved("report/approved/study.txt",
                   std::regex_replace(report_text(make_report(small_study(), Limits())), hash, "study UUID"));
    check_approved("report/approved/record.txt", report_text(record_report()));
    check_approved("report/approved/compare.txt", compare_text(comparison()));
}

TEST_CASE("approved: what JSON, CSV and pages have") {
    const Report study = report_either_way(small_study(), Limits()), record = record_report();
    const auto all = [](const std::string& of_study, const std::string& of_record, const std::string& of_comparison) {
        return "study\n" + of_study + "\nrecord\n" + of_record + "\ncomparison\n" + of_comparison;
    };
    check_approved("report/approved/json.txt",
                   all(members(report_json(study)), members(report_json(record)), members(compare_json(comparison()))));
    check_approved("report/approved/csv.txt",
                   all(names(report_csv(study)), names(report_csv(record)), names(compare_csv(comparison()))));
    check_approved("report/approved/html.txt",
                   all(outline(page_of(study)), outline(page_of(record)), outline(compare_html(comparison(), "test"))));
}

}  // namespace credence::test::approved_test
