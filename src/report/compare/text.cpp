// The comparison as text: conclusions first, then the numbers.

#include <algorithm>
#include <cmath>
#include "report/compare/compare.hpp"
#include <credence/text.hpp>

#include "base/wording.hpp"
#include "report/compare/choice.hpp"
#include "report/format.hpp"
#include "report/table.hpp"
#include "report/words.hpp"

namespace credence {

namespace {

/// Decimals that show two digits of the mean difference's uncertainty.
int decimals_of(const PairedComparison& paired) {
    return decimals_for(half_width(paired.difference.ci95), paired.difference.mean);
}

/// `10000 pairs`, or the lowest and highest number; of several comparisons also the number of those that have run.
std::string pairs_text(const CompareReport& report) {
    std::vector<std::int64_t> pairs;
    for (const ComparedPair& pair : report.pairs)
        if (!pair.not_run()) pairs.push_back(pair.pairs());
    if (pairs.empty()) return "not run yet";
    const auto [least, most] = std::minmax_element(pairs.begin(), pairs.end());
    return (*least == *most ? "" : std::to_string(*least) + " to ") + std::to_string(*most) +
           (*most == 1 ? " pair" : " pairs") +
           (pairs.size() > 1 ? " in each of " + std::to_string(pairs.size()) + " comparisons" : "");
}

/// Which of the two arms has no trial yet.
std::string not_run_text(const ComparedPair& pair) {
    if (pair.b.trials > 0) return pair.comparison.a + " is not run yet";
    return (pair.a.trials > 0 ? "" : pair.comparison.a + " and ") + pair.comparison.b +
           (pair.a.trials > 0 ? " is" : " are") + " not run yet";
}

/// How Wilcoxon's test relates to a mean difference that is not shown.
std::string despite(const Comparison& comparison, const ComparedColumn& column) {
    const PairedComparison& paired = column.paired;
    if (!(column.holm_p <= 0.05)) return "";
    const bool below = paired.wilcoxon_z < 0;
    return "; yet " + comparison.a + " is " + (below ? "lower" : "higher") + " in " +
           percent(below ? paired.wins_a : paired.wins_b) + " of trials (p " +
           p_text(column.holm_p) + ")";
}

/// The pairs that carry the mean, where it has not the sign of the median.
std::string carried(const ComparedPair& pair, const ComparedColumn& column) {
    const CarryingPairs& carrying = column.paired.carrying;
    if (carrying.count == 0) return "";
    std::vector<std::string> trials;
    for (const std::int64_t trial : carrying.first) trials.push_back(std::to_string(trial));
    if (carrying.count > std::ssize(trials)) trials.push_back("...");
    return "; the median has the other sign: " + std::to_string(carrying.count) + " of " +
           std::to_string(pair.pairs()) + " trials carry the mean (" + joined(trials) + ")";
}

/// Which of the two has no result where other records have, maybe because these steps are hard.
std::string steps_text(const ComparedPair& pair) {
    if (pair.steps_of_all == pair.steps_of_any) return "";
    const auto share = [&](std::int64_t steps) {
        return percent(static_cast<double>(steps) / static_cast<double>(pair.steps_of_any)) + " of the steps";
    };
    std::vector<std::string> lacking;
    for (const auto& [name, side] : {std::pair(pair.comparison.a, &pair.a), std::pair(pair.comparison.b, &pair.b)})
        if (side->steps < pair.steps_of_any)
            lacking.push_back(name + " has no result at " + share(pair.steps_of_any - side->steps));
    return joined(lacking, " and ") + (lacking.empty() ? "" : ": ") + "A - B is of the " + share(pair.steps_of_all) +
           " at which all records have results of the same components; ";
}

/// That on trials that failed or diverged, which comes before the means of the others.
std::string failure_conclusion(const ComparedPair& pair) {
    if (pair.failures == Conclusion::not_shown) return "";
    const auto share = [&](const ComparedSide& side) {
        const double part = static_cast<double>(side.failed_trials()) / static_cast<double>(pair.trials);
        return std::to_string(side.failed_trials()) + " of " + std::to_string(pair.trials) + " (" + percent(part) + ")";
    };
    return pair.comparison.a + " fails or diverges " +
           (pair.failures == Conclusion::lower ? "less often" : "more often") + " than " + pair.comparison.b + ", in " +
           share(pair.a) + " trials against " + share(pair.b) + " (Fisher p " + p_text(pair.failure_p) + "); ";
}

std::string conclusions(const CompareReport& report) {
    int width = 0;
    for (const ComparedPair& pair : report.pairs)
        width = std::max(width, static_cast<int>(pair.comparison.scenario.size()) + 2);
    std::string text;
    for (const ComparedPair& pair : report.pairs)
        text += "  " + wrapped(padded(pair.comparison.scenario, width, false) + conclusion_text(pair), 2) + "\n";
    return text;
}

std::string row_label(const ComparedColumn& column) {
    return "  " + (column.unit == "1" ? column.name : column.name + " [" + column.unit + "]");
}

/// The table of the differences' sizes.
Table sizes(const ComparedPair& pair) {
    Table table("", {"how much", "A", "B", "A - B ± 95 %", "bootstrap 95 %", "median"});
    for (std::size_t f = 0; f < pair.comparison.columns.size(); ++f) {
        const ComparedColumn& column = pair.comparison.columns[f];
        const PairedComparison& paired = column.paired;
        const int digits = decimals_of(paired);
        table.row({row_label(column), number_cell(pair.a.mean[f], digits), number_cell(pair.b.mean[f], digits),
                   mean_cell(paired.difference.mean, paired.difference.ci95), interval_cell(paired.bootstrap95, digits),
                   number_cell(paired.difference.median, digits)});
        if (paired.pairs != pair.pairs()) table.group("    of " + std::to_string(paired.pairs) + " pairs");
    }
    return table;
}

/// The table of the differences' certainty and regularity.
Table tests(const ComparedPair& pair) {
    Table table("", {"how surely", "A below", "A above", "equal", "Wilcoxon z", "p (Holm)", "d_z", "reduction"});
    for (const ComparedColumn& column : pair.comparison.columns) {
        const PairedComparison& paired = column.paired;
        table.row({row_label(column), share_cell(paired.wins_a), share_cell(paired.wins_b), share_cell(paired.ties),
                   number_cell(paired.wilcoxon_z, 2), p_cell(column.holm_p), number_cell(paired.effect_size, 3),
                   number_cell(paired.variance_reduction, 2)});
    }
    return table;
}

/// What the covariance of the truth's errors makes of the mean difference.
std::string truth_text(const ComparedPair& pair) {
    const int digits = decimals_of(pair.comparison.columns.front().paired);
    return "; with the truth's own covariance " + number(pair.with_truth->mean, digits) + " " +
           bracketed(pair.with_truth->ci95, digits);
}

/// That on a column; with_truth is of the first.
std::string concluded_text(const ComparedPair& pair, std::size_t c, Conclusion conclusion) {
    const Comparison& comparison = pair.comparison;
    const ComparedColumn& column = comparison.columns[c];
    const PairedComparison& paired = column.paired;
    const bool with_truth = c == 0 && pair.with_truth;
    const int digits = decimals_of(paired);
    const double mean = paired.difference.mean;
    const Interval& interval = paired.difference.ci95;
    const bool is_score = column.name == "log_score";
    const std::string text = is_score ? "log score (lower is better): " : column.name + ": ",
                      both = comparison.a + " and " + comparison.b;
    if (pair.not_run()) return text + not_run_text(pair);
    if (paired.pairs == 0)
        return text + (is_score ? "nothing to compare without covariances of the whole state"
                                : "no pairs, nothing to compare");
    if (conclusion == Conclusion::equal) return text + both + " are equal in every trial";
    const bool few = conclusion == Conclusion::too_few;
    const std::string not_shown = few ? "too few pairs to conclude (" : "no difference shown (";
    if ((few || conclusion == Conclusion::not_shown) && !std::isfinite(mean))
        return text + not_shown + "the mean of " + comparison.name() + " is not finite)";
    const std::string doubt = with_truth                                  ? truth_text(pair)
                              : !(interval.low > 0 || interval.high < 0) ? ""
                              : few ? "; the sign test has p " + p_text(paired.sign_p)
                                    : "; not enough for all conclusions to hold together";
    if (few || conclusion == Conclusion::not_shown)
        return text + not_shown + comparison.name() + " is " + number(mean, digits) +
               (paired.pairs == 1                       ? ", one pair"
                : std::isfinite(half_width(interval)) ? " " + bracketed(interval, digits)
                                                      : "") + ")" +
               doubt + despite(comparison, column) + carried(pair, column);
    const bool lower = conclusion == Conclusion::lower;
    const double share = lower ? paired.wins_a : paired.wins_b, against = lower ? paired.wins_b : paired.wins_a;
    const Interval size = lower ? Interval{-interval.high, -interval.low} : interval;
    return text + comparison.a + " is " + (lower ? "lower" : "higher") + " than " + comparison.b + " by " +
           number(std::abs(mean), digits) + " " + bracketed(size, digits) +
           (share < against ? " on average, though only in " : ", in ") + percent(share) + " of trials" +
           (paired.ties >= 0.005 ? " (equal in " + percent(paired.ties) + ")" : "") +
           (with_truth ? truth_text(pair) : "") + carried(pair, column);
}

/// That on one filter's two paths behind the first column, and the verdicts.
std::string further_text(const ComparedPair& pair) {
    std::string text;
    for (const auto& [column, conclusion] : pair.further) text += "; " + concluded_text(pair, column, conclusion);
    if (!pair.a.verdict) return text;
    return text + "; verdicts: " + pair.comparison.a + " " + verdict_name(*pair.a.verdict) + ", " + pair.comparison.b +
           " " + verdict_name(*pair.b.verdict);
}

/// The columns that differ but are not concluded on, with their mean differences. The log score compares filters.
std::string others_text(const ComparedPair& pair) {
    std::vector<std::string> others;
    for (std::size_t c = 1; c < pair.comparison.columns.size(); ++c) {
        const ComparedColumn& column = pair.comparison.columns[c];
        const bool concluded = std::ranges::any_of(pair.further, [&](const auto& one) { return one.first == c; });
        if (differs(column) && !concluded && (column.name != "log_score" || !pair.a.verdict)) {
            const double mean = column.paired.difference.mean;
            others.push_back(column.name + (mean < 0 ? " lower by " : " higher by ") +
                             number(std::abs(mean), decimals_of(column.paired)));
        }
    }
    return others.empty() ? "" : "; besides, " + pair.comparison.a + " has " + joined(others);
}

}  // namespace

std::string compare_head(const CompareReport& report) {
    const ComparedPair& first_pair = report.pairs.front();
    const Comparison& first = first_pair.comparison;
    const bool one = std::all_of(report.pairs.begin(), report.pairs.end(),
                                 [&](const ComparedPair& pair) { return pair.comparison.name() == first.name(); });
    std::string text = (one ? first.name() : "A - B") + ", trial by trial: " + pairs_text(report);
    text += ". Negative: " + (one ? first.a : "A") + " is lower.\n";
    const bool trials = first_pair.keep == Keep::trials;
    text += report.of_records
                ? "Both of a pair are of the same run"
                : "Both of a pair had the same draws (root seed " + std::to_string(report.root_seed) + ")";
    return text + ". Intervals are two-sided 95 %" +
           (trials ? "; p is that of Wilcoxon's signed ranks,\nHolm-corrected over all columns below"
                   : " (Student's). Medians, bootstrap and signed ranks\nneed the trials: " + program_name() +
                         " run --keep trials") +
           "; conclusions hold together at 95 %.\n";
}

std::string conclusion_text(const ComparedPair& pair) {
    return steps_text(pair) + failure_conclusion(pair) + concluded_text(pair, 0, pair.conclusion) + further_text(pair) +
           others_text(pair);
}

std::string compare_notes(const CompareReport& report) {
    std::string text;
    const auto note = [&](const ComparedPair& pair, const ComparedSide& side, const std::string& arm) {
        const FailureWords words{"are left out, with their partners", "compared, too"};
        for (const std::string& line :
             failure_lines(pair.comparison.scenario + "/" + arm, {pair.trials, side.failed, side.diverged},
                           report.failed_limit, words))
            text += line + "\n";
    };
    bool complete = true;
    std::size_t not_run = 0;
    for (const ComparedPair& pair : report.pairs) {
        note(pair, pair.a, pair.comparison.a);
        note(pair, pair.b, pair.comparison.b);
        complete = complete && pair.complete;
        not_run += pair.not_run();
    }
    std::vector<std::string> other_worlds;
    for (const ComparedPair& pair : report.pairs)
        if (of_different_worlds(pair)) other_worlds.push_back(pair.comparison.scenario);
    if (!other_worlds.empty())
        text +=
            wrapped("note: A and B are different worlds, as their sensors differ: " + joined(other_worlds) +
                    ". Their trials still share the truth of the features, the noise of the motion and the draws of "
                    "the measurements, so differences are of pairs. They show what the sensor does, too.") +
            "\n";
    if (!complete)
        text += "note: a study is not complete" +
                (not_run == 0 ? "" : ": " + std::to_string(not_run) + " of " + std::to_string(report.pairs.size()) +
                                         " comparisons are not run yet") + ".\n";
    if (!report.left_out.empty()) text += wrapped_list("note: left out:", report.left_out, 0) + "\n";
    return text;
}

std::string pair_head(const ComparedPair& pair) {
    const Comparison& comparison = pair.comparison;
    std::string text = "\n" + wrapped(comparison.scenario + (pair.title.empty() ? "" : ": " + pair.title)) + "\n";
    std::string sides = "A = " + comparison.a + ", B = " + comparison.b + ": " +
                        (pair.not_run() ? not_run_text(pair) : std::to_string(pair.pairs()) + " pairs");
    if (pair.a.trials != pair.b.trials)
        sides += ", of the " + std::to_string(pair.trials) + " trials that both have: A has " +
                 std::to_string(pair.a.trials) + ", B has " + std::to_string(pair.b.trials);
    text += "  " + wrapped(sides, 2) + "\n";
    std::vector<std::string> parts;
    for (const KeyDifference& key : pair.differences)
        parts.push_back(key.key + " (" + key.a + " in A, " + key.b + " in B)");
    if (!parts.empty())
        text += "  " + wrapped_list("they differ in", parts, 2) + "\n";
    else if (pair.a.file != pair.b.file)
        text += "  the scenario is the same in both files\n";
    return text;
}

std::string compare_text(const CompareReport& report) {
    std::string text = compare_head(report) + compare_notes(report) + "\n" + conclusions(report);
    for (const ComparedPair& pair : report.pairs)
        text += pair_head(pair) + (pair.not_run() ? "" : table_text(sizes(pair)) + table_text(tests(pair)));
    return text +
           "\nd_z: mean of the differences / their standard deviation. reduction: (V_A + V_B) / V_(A-B): arms with "
           "draws of their own\nwould need that many times the trials. nees_ratio and nis_ratio are best at 1.\n";
}

}  // namespace credence
