// The comparison as one page: conclusions, then each pair's tables and charts, and the sources.

#include "report/compare/compare.hpp"

#include "report/format.hpp"
#include "report/html/page.hpp"

#include <filesystem>

namespace credence {

namespace {

using namespace page;

std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

/// A text whose line breaks are kept.
Html lines(const std::string& text, const Html& classes) {
    return text.empty() ? Html() : element("p", escaped(text), "class=\""_html + classes + "\""_html) + "\n"_html;
}

Html conclusion_list(const CompareReport& report) {
    Html items;
    for (const ComparedPair& pair : report.pairs)
        items += element("li",
                         element("b", escaped(pair.comparison.scenario)) + ": "_html + escaped(conclusion_text(pair))) +
                 "\n"_html;
    return "<section aria-labelledby=\"conclusions\">\n<h2 id=\"conclusions\">Conclusions</h2>\n"_html +
           element("ul", items) + "</section>\n"_html;
}

Html means_table(const ComparedPair& pair) {
    Table table(pair.comparison.scenario + ": means over the pairs",
                    {"column", "A = " + pair.comparison.a, "B = " + pair.comparison.b});
    for (std::size_t f = 0; f < pair.comparison.columns.size(); ++f) {
        const ComparedColumn& one = pair.comparison.columns[f];
        const Summary& difference = one.paired.difference;
        const int digits = decimals_for(half_width(difference.ci95), difference.mean);
        table.row(column_words(one.name, one.unit),
                  {number_cell(pair.a.mean[f], digits), number_cell(pair.b.mean[f], digits)});
    }
    return html_of(table);
}

/// The conclusions of the pairs.
Html pair_evidence(const ComparedPair& pair, std::size_t number) {
    const Comparison& comparison = pair.comparison;
    return difference_table(comparison) + means_table(pair) +
           folded("How the differences are spread", difference_spread_table(comparison)) + "<h3>Charts</h3>\n"_html +
           chart_group("Differences of pairs",
                       "Trial by trial, with the same draws. Left of 0, A is lower. The mark is the mean with its 95 % "
                       "interval.",
                       difference_charts(comparison, number)) +
           no_distributions(pair.keep);
}

Html pair_section(const ComparedPair& pair, std::size_t number) {
    const Html id = "pair:"_html + escaped(std::to_string(number));
    return "<section class=\"scenario\" aria-labelledby=\""_html + id + "\">\n<h2 id=\""_html + id + "\">"_html +
           escaped(pair.comparison.scenario + ": " + pair.comparison.name()) + "</h2>\n"_html +
           lines(pair_head(pair).substr(1), "lines"_html) + (pair.not_run() ? Html() : pair_evidence(pair, number)) +
           "</section>\n"_html;
}

Html origin_part(const CompareReport& report, const std::string& made_by) {
    Table table("Where the numbers came from", {"side", "file", "study", "trials", "failed", "diverged"});
    for (const ComparedPair& pair : report.pairs) {
        table.group(pair.comparison.scenario);
        for (const auto& [name, side] : {std::pair(pair.comparison.a, &pair.a), std::pair(pair.comparison.b, &pair.b)})
            table.row(name,
                      {file_name(side->file), side->source, count_cell(static_cast<double>(side->trials)),
                       count_cell(static_cast<double>(side->failed)), count_cell(static_cast<double>(side->diverged))});
    }
    return "<section aria-labelledby=\"provenance\">\n<h2 id=\"provenance\">Provenance</h2>\n"_html + html_of(table) +
           element("p", escaped("Root seed " + std::to_string(report.root_seed) + ". Page made by " + made_by + ".")) +
           "\n</section>\n"_html;
}

}  // namespace

std::string compare_html(const CompareReport& report, const std::string& made_by) {
    const Html header = "<h1>What does it change?</h1>\n"_html + element("p", escaped(compare_head(report))) +
                        lines(compare_notes(report), "lines warnings"_html);
    Html body = conclusion_list(report);
    for (std::size_t i = 0; i < report.pairs.size(); ++i) body += pair_section(report.pairs[i], i);
    return document("credence: comparison", header, body + origin_part(report, made_by) + terms());
}

}  // namespace credence
