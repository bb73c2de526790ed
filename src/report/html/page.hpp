#pragma once
// The parts of the page [report_html.cpp puts them together].

#include "report/html/html.hpp"
#include <credence/report.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace credence::page {

/// What the page says of one scenario.
struct Part {
    const Report& report;
    const Scenario& scenario;
    std::vector<const ArmReport*> arms;
    std::vector<const Comparison*> pairs;

    /// Unique on the page: names hold neither `.` nor `:`, and the page's own ids neither.
    std::string id(const std::string& what) const { return scenario.name + "." + what; }
};

/// Colours, layout, print: all that the page looks like.
std::string_view style_sheet();

/// A page of these parts.
std::string document(const std::string& title, const Html& header, const Html& main);

/// Whether a scenario has a section of its own: the points of grids only where there are few, or the page would be long
/// and large.
bool has_section(const Report& report, const std::string& scenario);

/// The id of a scenario's section.
inline Html section_id(const std::string& scenario) { return "scenario:"_html + escaped(scenario); }

/// An arm's verdict as a shape, a word and a colour.
Html badge(const ArmReport& arm);

/// How many trials of an arm failed; `-` where it is not run yet.
Html failed_count(const ArmReport& arm);

/// How many arms have which verdict, in one sentence.
std::string verdict_counts(const Report& report);

/// A line for every arm: the verdict and the first reason for it.
Html verdicts(const Report& report);

/// Every grid: curves along a swept key, and tables by point; nothing without one.
Html sweeps(const Report& report);

/// What was found, where and when, of every arm.
Html findings(const Part& part);

/// Figures of a trial, and planned against fixed.
Html figure_tables(const Part& part);

/// Of one pair, figure by figure: what it is, how surely, and how it is spread.
Html difference_table(const Comparison& pair);
Html difference_spread_table(const Comparison& pair);

/// Blocks of the state, coverage, NIS, whiteness, shape and credibility.
Html evidence_tables(const Part& part);

/// Everything by step; of an arm that nobody opens it is out of the way.
Html step_tables(const Part& part);

/// All charts of a scenario.
Html charts(const Part& part);

/// A figure's name in words, with its unit: `trace(P), last step [dm²]`.
std::string figure_words(const std::string& name, const std::string& unit);

/// One drawing with its caption.
Html chart(const std::string& caption, const Html& svg);
/// Drawings side by side under a head, and what they show; nothing without drawings.
Html chart_group(const std::string& head, const std::string& text, const Html& drawings);
/// What stands in the place of charts of distributions, where no trial is kept.
Html no_distributions(Keep keep);
/// Names beside their marks; those of the arms.
Html legend(const std::vector<std::string>& names);
Html legend(const Part& part);

Html equivalence_chart(const Part& part);
Html coverage_chart(const Part& part);
Html nees_panels(const Part& part);
Html nis_panels(const Part& part);
Html whiteness_chart(const Part& part);
Html distribution_charts(const Part& part);
/// Of one pair; `number` tells it from the scenario's others.
Html difference_charts(const Comparison& pair, std::size_t number);

/// What stands behind a summary until it is opened; `print_open` is shown in print all the same.
enum class InPrint { closed, open };
Html folded(const std::string& summary, const Html& content, InPrint in_print = InPrint::closed);

Html scenario_part(const Part& part);
Html provenance(const Report& report, const PageOrigin& origin);
Html reproduction(const Report& report, const PageOrigin& origin);
Html terms();

/// A line of a shell, to be copied.
Html command(const std::string& line);

}  // namespace credence::page
