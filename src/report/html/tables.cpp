// The page's tables of trial columns: each arm's, and the differences of pairs.

#include <credence/text.hpp>

#include "report/format.hpp"
#include "report/html/page.hpp"
#include "report/words.hpp"

#include <algorithm>
#include <cmath>

namespace credence::page {

namespace {

/// All names of columns for which some arm has values, in their order.
std::vector<std::string> names_of(const Part& part) {
    std::vector<std::string> names;
    if (part.arms.empty()) return names;
    for (const ColumnReport& column : part.arms.front()->columns)
        for (const ArmReport* arm : part.arms)
            if (column_named(arm->columns, column.name).summary.count > 0) {
                names.push_back(column.name);
                break;
            }
    return names;
}

Cell published(const ColumnReport& column_report) {
    if (!column_report.published) return {};
    const Cell value = number_cell_as(column_report.published->value, to_text(column_report.published->value));
    if (std::isnan(column_report.published->percentile)) return value;
    return value + " (" + number_cell(column_report.published->percentile, 1) + " %)";
}

/// Rows for every arm under a head for every column.
template <class Cells>
void add_rows(const Part& part, Table& table, const Cells& cells) {
    for (const std::string& name : names_of(part)) {
        table.group(column_words(name, column_named(part.arms.front()->columns, name).unit));
        for (const ArmReport* arm : part.arms) {
            const ColumnReport& column_report = column_named(arm->columns, name);
            if (column_report.summary.count > 0) table.row(arm->arm, cells(column_report));
        }
    }
}

bool has_published(const Part& part) {
    const auto any = [](const ArmReport* arm) {
        return std::ranges::any_of(arm->columns, [](auto& one) { return one.published.has_value(); });
    };
    return std::ranges::any_of(part.arms, any);
}

Html arms_table(const Part& part) {
    std::vector<std::string> heads{"arm", "mean", "95 %, Student", "95 %, bootstrap", "median", "sd"};
    const bool published_too = has_published(part);
    if (published_too) heads.push_back("published (percentile)");
    Table table(part.scenario.name + ": columns of the trials", heads);
    add_rows(part, table, [&](const ColumnReport& one) {
        const Summary& s = one.summary;
        const int digits = decimals_for(half_width(s.ci95), s.mean);
        std::vector<Cell> cells{number_cell(s.mean, digits), interval_cell(s.ci95, digits),
                                one.bootstrap95 ? interval_cell(*one.bootstrap95, digits) : Cell(),
                                number_cell(s.median, digits), number_cell(s.standard_deviation, digits)};
        if (published_too) cells.push_back(published(one));
        return cells;
    });
    return html_of(table);
}

Html spread_table(const Part& part) {
    std::vector<std::string> heads{"arm", "trials", "standard error"};
    for (const double p : reported_quantiles) heads.push_back(number(100 * p, 0) + " % quantile");
    Table table(part.scenario.name + ": how the columns are distributed", heads);
    add_rows(part, table, [](const ColumnReport& one) {
        const int digits = decimals_for(half_width(one.summary.ci95), one.summary.mean);
        std::vector<Cell> cells{count_cell(static_cast<double>(one.summary.count)),
                                number_cell_within(one.summary.standard_error, one.summary.standard_error)};
        for (const double quantile : one.quantiles) cells.push_back(number_cell(quantile, digits));
        return cells;
    });
    return html_of(table);
}

}  // namespace

Html difference_table(const Comparison& pair) {
    Table table(pair.scenario + ": " + pair.name() +
                        ", trial by trial (both had the same draws; negative: " + pair.a + " is lower)",
                    {"column", "mean", "95 %, Student", "95 %, bootstrap", "median", "below", "above", "equal",
                     "p (Holm)", "effect size", "reduction"});
    for (const ComparedColumn& one : pair.columns) {
        const PairedComparison& paired = one.paired;
        if (paired.pairs == 0) continue;
        const Summary& s = paired.difference;
        const int digits = decimals_for(half_width(s.ci95), s.mean);
        table.row(column_words(one.name, one.unit),
                  {number_cell(s.mean, digits), interval_cell(s.ci95, digits),
                   interval_cell(paired.bootstrap95, digits), number_cell(s.median, digits), share_cell(paired.wins_a),
                   share_cell(paired.wins_b), share_cell(paired.ties), p_cell(one.holm_p),
                   number_cell(paired.effect_size, 3), number_cell(paired.variance_reduction, 2)});
    }
    return html_of(table);
}

Html difference_spread_table(const Comparison& pair) {
    Table table(pair.scenario + ": " + pair.name() + ", how the differences are spread",
                {"column", "pairs", "standard error", "sd", "Wilcoxon's z", "its p, uncorrected", "sign test's p"});
    for (const ComparedColumn& one : pair.columns) {
        const Summary& s = one.paired.difference;
        if (one.paired.pairs == 0) continue;
        table.row(
            column_words(one.name, one.unit),
            {count_cell(static_cast<double>(one.paired.pairs)), number_cell_within(s.standard_error, s.standard_error),
             number_cell(s.standard_deviation, decimals_for(half_width(s.ci95), s.mean)),
             number_cell(one.paired.wilcoxon_z, 2), p_cell(one.paired.wilcoxon_p), p_cell(one.paired.sign_p)});
    }
    return html_of(table);
}

Html column_tables(const Part& part) {
    Html html = "<h3>Columns of the trials</h3>\n"_html + arms_table(part), more = spread_table(part);
    for (const Comparison* pair : part.pairs) {
        html += difference_table(*pair);
        more += difference_spread_table(*pair);
    }
    return html + folded("How the columns are distributed: standard errors, quantiles, numbers of trials", more);
}

}  // namespace credence::page
