// The page's last sections: the scenario, the sources of the numbers, the commands to reproduce them, and a glossary.

#include <credence/text.hpp>

#include "base/wording.hpp"
#include "embedded/terms.hpp"
#include "report/html/page.hpp"
#include "report/sweep.hpp"

#include <algorithm>

namespace credence::page {

namespace {

Table& add(Table& table, const std::string& name, const std::string& value) { return table.row(name, {value}); }

std::string fact(const RunFacts& facts, const std::string& name) {
    for (const auto& [known, value] : facts)
        if (known == name) return value;
    return {};
}

/// The options that give the same verdicts again.
std::string options_of(const Report& report) {
    const Limits& limits = report.limits;
    const Limits usual(limits.margin);
    std::string options = " --margin " + to_text(limits.margin);
    if (limits.failed != usual.failed) options += " --failed " + to_text(limits.failed);
    if (limits.direction != usual.direction) options += " --margin-direction " + to_text(limits.direction);
    if (limits.bias != usual.bias) options += " --bias " + to_text(limits.bias);
    if (report.segments == segments_off) options += " --segments off";
    if (report.segments > 0) options += " --segments " + std::to_string(report.segments);
    return options;
}

/// The command that makes the study's file from the scenarios on this page.
std::string run_again(const Report& report) {
    std::string line = program_name() + " run";
    for (const Scenario& scenario : report.scenarios) line += " " + scenario.name + ".ini";
    return line + " --trials " + std::to_string(report.trials) + " --seed " + std::to_string(*report.root_seed) +
           (report.keep == Keep::trials ? "" : " --keep " + keep_name(report.keep)) + " -o again.h5";
}

}  // namespace

Html command(const std::string& line) { return element("pre", element("code", escaped(line))) + "\n"_html; }

Html scenario_part(const Part& part) {
    if (!part.report.root_seed) return {};  // a record does not describe its world
    const Html text = element("pre", element("code", escaped(scenario_text(part.scenario))), "tabindex=\"0\""_html);
    return "<h3>Scenario</h3>\n"_html + folded("The scenario as resolved, every key of it: save it as " +
                                                   part.scenario.name + ".ini to run it again",
                                               text, InPrint::open);
}

Html provenance(const Report& report, const PageOrigin& origin) {
    Table table("Where the numbers came from", {"fact", "value"});
    if (fact(origin.run, "log").empty()) add(table, "file", origin.file);
    if (report.root_seed) {
        add(table, "source", report.source);
        add(table, "root seed", std::to_string(*report.root_seed));
        add(table, "trials of each scenario that were asked for", std::to_string(report.trials));
        add(table, "complete", report.complete ? "yes, all of them are there" : "no, trials are missing");
    } else if (!report.arms.empty()) {
        add(table, "trials", std::to_string(report.arms.front().trials));
        const ArmReport& arm = report.arms.front();
        add(table, "steps", std::to_string(arm.evidence.steps) +
                                (arm.every > 1 ? ", one in " + std::to_string(arm.every) : ""));
    }
    add(table, "margin", to_text(report.limits.margin));
    add(table, "share of trials that may fail", to_text(report.limits.failed));
    for (auto [name, value] : origin.run) {
        std::replace(name.begin(), name.end(), '_', ' ');
        add(table, name, value);
    }
    add(table, "page made by", origin.made_by);
    return section("provenance"_html, "Provenance"_html, html_of(table));
}

Html reproduction(const Report& report, const PageOrigin& origin) {
    const std::string log = fact(origin.run, "log"), file = log.empty() ? shell_word(origin.file) : log,
                      options = options_of(report);
    Html html;
    if (!report.root_seed) {
        html += "<p>This page, and the same as text or with every digit:</p>\n"_html +
                command(program_name() + " judge " + file + options + " --format html -o page.html") +
                command(program_name() + " judge " + file + options + " --format json");
        return section("again"_html, "How to reproduce it"_html, html);
    }
    if (const std::string line = fact(origin.run, "command_line"); !line.empty())
        html += "<p>The file was made by</p>\n"_html + command(line);
    const bool all_shown = points_have_sections(swept_scenarios(report));
    html +=
        all_shown
            ? "<p>Without the scenario files: save the scenarios of this page, each under its name, and run the same "
              "trials. Any number of threads gives the same bits, which the second command checks.</p>\n"_html +
                  command(run_again(report)) + command("h5diff --exclude-path /run " + file + " again.h5")
            : "<p>The points of large grids have no section of their own here. The text of every scenario is in the "
              "file: the attribute <code>scenario</code> of its group.</p>\n"_html;
    html += "<p>This page, and the same with every digit:</p>\n"_html +
            command(program_name() + " report " + file + options + " --format html -o page.html") +
            command(program_name() + " report " + file + options + " --format json");
    return section("again"_html, "How to reproduce it"_html, html);
}

Html terms() { return Html::trusted(embedded::terms); }

}  // namespace credence::page
