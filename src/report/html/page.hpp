#pragma once
// The parts of the page, which report_html and compare_html put together.

#include "report/html/html.hpp"
#include <credence/report.hpp>

#include <string>
#include <vector>

namespace credence {
class Svg;
}

namespace credence::page {

/// The data for one scenario's section.
struct Part {
    const Report& report;
    const Scenario& scenario;
    std::vector<const ArmReport*> arms;
    std::vector<const Comparison*> pairs;

    /// Unique on the page: scenario names contain neither `.` nor `:`, and the page's other ids do not use them either.
    std::string id(const std::string& what) const { return scenario.name + "." + what; }
};

/// A page of these parts.
std::string document(const std::string& title, const Html& header, const Html& main);

/// The id of a scenario's section.
inline Html section_id(const std::string& scenario) { return "scenario:"_html + escaped(scenario); }

/// A section with its heading.
inline Html section(const Html& id, const Html& heading, const Html& body) {
    return element("section", "\n"_html + element("h2", heading, "id=\""_html + id + "\""_html) + "\n"_html + body,
                   "aria-labelledby=\""_html + id + "\""_html) + "\n"_html;
}

/// The number of arms with each verdict, in one sentence.
std::string verdict_counts(const Report& report);

/// A line for every arm: the verdict and the first reason for it.
Html verdicts(const Report& report);

/// The findings of every arm, with place and time.
Html findings(const Part& part);

/// Columns of the trials, and planned against fixed.
Html column_tables(const Part& part);

/// The tables of one pair, column by column: the difference, its certainty, and its distribution.
Html difference_table(const Comparison& pair);
Html difference_spread_table(const Comparison& pair);

/// Component groups, coverage, NIS, whiteness, distribution and credibility.
Html evidence_tables(const Part& part);

/// All charts of a scenario.
Html charts(const Part& part);

/// A column's name in words, with its unit: `trace(P), last step [dm²]`.
std::string column_words(const std::string& name, const std::string& unit);

/// One drawing with its caption.
Html chart(const std::string& caption, const Html& svg);
/// The same of the scenario: `what` is the end of its id, and `title` and `description` are its text alternative.
Html chart(const Part& part, const std::string& caption, const Svg& svg, const std::string& what,
           const std::string& title, const std::string& description);
/// Drawings side by side under a heading, with a description; empty without drawings.
Html chart_group(const std::string& head, const std::string& text, const Html& drawings);
/// The text in place of charts of distributions, where no trial is kept.
Html no_distributions(Keep keep);
/// The arms' names beside their marks.
Html legend(const Part& part);

Html equivalence_chart(const Part& part);
Html coverage_chart(const Part& part);
Html direction_charts(const Part& part);
/// The numbers of these charts, and the trials with the largest NEES.
Html direction_tables(const Part& part);
Html worst_trials_table(const Part& part);
Html error_charts(const Part& part);
Html autocorrelation_chart(const Part& part);
Html nees_panels(const Part& part);
Html nis_panels(const Part& part);
Html whiteness_chart(const Part& part);
Html distribution_charts(const Part& part);
/// Drawings of one pair; `number` makes its ids unique within the scenario.
Html difference_charts(const Comparison& pair, std::size_t number);

/// A collapsed section with its summary; `InPrint::open` is expanded in print.
enum class InPrint { closed, open };
Html folded(const std::string& summary, const Html& content, InPrint in_print = InPrint::closed);

Html scenario_part(const Part& part);
Html provenance(const Report& report, const PageOrigin& origin);
Html reproduction(const Report& report, const PageOrigin& origin);
Html terms();

/// A line of a shell, to be copied.
Html command(const std::string& line);

}  // namespace credence::page
