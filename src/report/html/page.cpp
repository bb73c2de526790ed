// The report as one page: verdict, findings, tables, charts, scenario, provenance, how to reproduce it, terms.

#include "embedded/style.hpp"
#include "report/html/page.hpp"
#include "report/sweep.hpp"

#include <credence/text.hpp>

#include "report/words.hpp"

#include <algorithm>
#include <set>

namespace credence {

namespace page {

namespace {

Html paragraph(const std::string& text) { return element("p", escaped(text)) + "\n"_html; }

Part part_of(const Report& report, const Scenario& scenario) {
    Part part{report, scenario, {}, {}};
    for (const ArmReport& arm : report.arms)
        if (arm.scenario == scenario.name) part.arms.push_back(&arm);
    for (const Comparison& pair : report.pairs)
        if (pair.scenario == scenario.name) part.pairs.push_back(&pair);
    return part;
}

/// The content security policy: nothing is loaded from anywhere, whatever the page's texts contain.
Html head(const std::string& title) {
    return R"(<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; img-src data:">
<link rel="icon" href="data:,">
)"_html + element("title", escaped(title)) +
           "\n<style>\n"_html + Html::trusted(embedded::style) + "</style>\n"_html;
}

Html intro(const Report& report, const PageOrigin& origin) {
    const Html html = element("h1", "Can this filter's covariance be believed?"_html) + "\n"_html +
                      element("p", escaped(origin.file + ": " + trials_text(report) + "."), "class=\"source\""_html) +
                      "\n"_html + element("p", escaped(verdict_counts(report)), "class=\"lead\""_html) + "\n"_html;
    const std::vector<std::string> warnings = warnings_of(report);
    const std::size_t shown = std::min<std::size_t>(5, warnings.size());
    const auto listed = [&](std::size_t from, std::size_t to) {
        Html items;
        for (; from < to; ++from) items += element("li", escaped(warnings[from]));
        return items.empty() ? Html() : element("ul", items, "class=\"warnings\""_html) + "\n"_html;
    };
    const std::size_t more = warnings.size() - shown;
    return html + listed(0, shown) +
           folded(std::to_string(more) + (more == 1 ? " more note" : " more notes"), listed(shown, warnings.size()),
                  InPrint::open);
}

/// The scenarios by themselves; the tables of a sweep lead to its points.
Html contents(const Report& report) {
    if (report.scenarios.size() < 2) return {};
    Html items;
    for (const Scenario& scenario : report.scenarios) {
        if (is_swept(scenario)) continue;
        std::set<std::string> shown;  // each badge once
        Html badges;
        for (const ArmReport* arm : part_of(report, scenario).arms)
            if (shown.insert(verdict_word(*arm)).second) badges += " "_html + html_of(verdict_cell(*arm));
        items += element("li", "<a href=\"#"_html + section_id(scenario.name) + "\">"_html + escaped(scenario.name) +
                                   "</a>"_html + badges);
    }
    if (items.empty()) return {};
    return "<nav aria-labelledby=\"contents\">\n<h2 id=\"contents\">Contents</h2>\n"_html + element("ol", items) +
           "\n</nav>\n"_html;
}

/// The tables by point of every sweep; empty without one.
Html sweeps(const Report& report) {
    Html html;
    std::size_t number = 0;
    for (const Grid& grid : grids_of(report)) {
        const Html id = escaped("sweep:" + std::to_string(number++));
        Html tables;
        for (const SweptTable& one : tables_of(report, grid)) tables += html_of(one.table);
        html += section(id, escaped("Sweep of " + grid.of + " over " + joined(grid.keys)), tables);
    }
    return html;
}

/// All sections on the trials of a scenario.
Html evidence_of_trials(const Part& part) {
    if (std::ranges::all_of(part.arms, &ArmReport::not_run)) return {};
    const Html tables = column_tables(part) + evidence_tables(part);
    return part.arms.front()->curves.empty() ? tables + charts(part) : charts(part) + tables;
}

/// A point of a sweep is folded: the page would be too long to find the tables by point.
Html scenario_section(const Part& part) {
    const std::string& title = part.scenario.title;
    const Html body = findings(part) + evidence_of_trials(part) + scenario_part(part);
    return "<section class=\"scenario\" aria-labelledby=\""_html + section_id(part.scenario.name) + "\">\n"_html +
           element("h2", escaped(part.scenario.name), "id=\""_html + section_id(part.scenario.name) + "\""_html) +
           "\n"_html + (title.empty() ? Html() : paragraph(title)) +
           (is_swept(part.scenario) ? folded("Everything of this point", body, InPrint::open) : body) +
           "</section>\n"_html;
}

}  // namespace

Html folded(const std::string& summary, const Html& content, InPrint in_print) {
    if (content.empty()) return {};
    return element("details", element("summary", escaped(summary)) + "\n"_html + content,
                   in_print == InPrint::open ? "class=\"printed\""_html : Html()) +
           "\n"_html;
}

std::string document(const std::string& title, const Html& header, const Html& main) {
    return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n" + head(title).text() + "</head>\n<body>\n<header>\n" +
           header.text() + "</header>\n<main>\n" + main.text() + "</main>\n</body>\n</html>\n";
}

}  // namespace page

std::string report_html(const Report& report, const PageOrigin& origin) {
    using namespace page;
    Html body = verdicts(report) + contents(report) + sweeps(report);
    const bool points_too = points_have_sections(swept_scenarios(report));
    for (const Scenario& scenario : report.scenarios)
        if (points_too || !is_swept(scenario)) body += scenario_section(part_of(report, scenario));
    body += provenance(report, origin) + reproduction(report, origin) + terms();
    return document("credence: " + origin.file, intro(report, origin), body);
}

}  // namespace credence
