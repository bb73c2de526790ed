#include <algorithm>
#include <cmath>
#include "report/compare/compare.hpp"
#include <credence/error.hpp>
#include <credence/text.hpp>

#include "report/compare/choice.hpp"

namespace credence {

namespace {

/// Counts of the arm; `statuses`: of the trials that are compared.
ComparedSide side_of(const ComparedArm& compared, const StudyFile& file, const std::vector<double>& statuses) {
    ComparedSide side{file.path, "study " + study_hash(file.study), compared.results.trials, 0, 0, {}};
    for (const double value : statuses) {
        const auto status = static_cast<Status>(static_cast<int>(value));
        side.failed += failed(status);
        side.diverged += status == Status::diverged;
    }
    return side;
}

/// The same where no trial is kept; all trials are compared.
ComparedSide side_of_aggregates(const ComparedArm& compared, const StudyFile& file, const Comparison& comparison) {
    const ArmAggregates& aggregates = compared.arm.aggregates;
    ComparedSide side{file.path, "study " + study_hash(file.study), compared.results.trials,
                      aggregates.trials() - aggregates.counted(),
                      aggregates.statuses[static_cast<std::size_t>(Status::diverged)], {}};
    std::size_t f = 0;
    for (std::size_t c = 0; c < compared.results.columns.size(); ++c) {
        if (!is_reported(compared.results.columns[c])) continue;
        const bool all_paired = aggregates.columns[c].count == comparison.columns[f++].paired.pairs;
        side.mean.push_back(all_paired ? moments_of(aggregates.columns[c]).mean : std::nan(""));
    }
    return side;
}

/// The arms' own means of every column, over the pairs of its difference.
void add_means(ComparedPair& pair, const ChosenPair& chosen, const CommonTrials& common) {
    const std::vector<Column>& columns = chosen.a.results.columns;
    for (std::size_t c = 0; c < columns.size(); ++c) {
        if (!is_reported(columns[c])) continue;
        std::vector<double> a = common.of_a(figure_values(chosen.a.results, chosen.a.arm, c)),
                            b = common.of_b(figure_values(chosen.b.results, chosen.b.arm, c));
        for (std::size_t i = 0; i < a.size(); ++i)
            if (std::isnan(a[i]) || std::isnan(b[i])) a[i] = b[i] = std::nan("");
        pair.a.mean.push_back(summarise(std::move(a)).mean);
        pair.b.mean.push_back(summarise(std::move(b)).mean);
    }
}

/// Arms of different files. Two shards of one study, for example, have no trial in common.
void require_common_trials(const ChosenPair& chosen, const CommonTrials& common) {
    if (common.count() > 0 || chosen.a.results.trials == 0 || chosen.b.results.trials == 0) return;
    throw InputError(chosen.file_a.path + " and " + chosen.file_b.path + ": have no trial of " +
                     printable(chosen.a.results.scenario.name) +
                     " in common. Merge the shards of each study, or compare the same shard of both.");
}

/// Two arms of one file that keeps no trials.
ComparedPair compared_aggregates(const ChosenPair& chosen, std::uint64_t root_seed) {
    ComparedPair pair;
    pair.comparison = compare_arms(chosen.a, chosen.b, root_seed);
    pair.title = chosen.a.results.scenario.title;
    pair.trials = chosen.a.results.trials;
    pair.a = side_of_aggregates(chosen.a, chosen.file_a, pair.comparison);
    pair.b = side_of_aggregates(chosen.b, chosen.file_b, pair.comparison);
    pair.complete = chosen.file_a.study.complete;
    pair.keep = Keep::aggregates;
    return pair;
}

ComparedPair compared(const ChosenPair& chosen, std::uint64_t root_seed) {
    if (chosen.a.results.keep == Keep::aggregates) return compared_aggregates(chosen, root_seed);
    const ScenarioResults &a = chosen.a.results, &b = chosen.b.results;
    const CommonTrials common(a, b);
    require_common_trials(chosen, common);
    ComparedPair pair;
    pair.comparison = compare_arms(chosen.a, chosen.b, root_seed);
    pair.title = a.scenario.title;
    pair.trials = common.count();
    pair.a = side_of(chosen.a, chosen.file_a, common.of_a(column_values(a, chosen.a.arm, status_column(a.columns))));
    pair.b = side_of(chosen.b, chosen.file_b, common.of_b(column_values(b, chosen.b.arm, status_column(b.columns))));
    pair.complete = chosen.file_a.study.complete && chosen.file_b.study.complete;
    pair.differences = shown_differences(a.scenario, b.scenario);
    add_means(pair, chosen, common);
    return pair;
}

/// Whether a difference is shown, as one of `comparisons`: Bonferroni over their t intervals, and the bootstrap's own
/// 95 % where there is one.
Conclusion concluded(const ComparedPair& pair, std::size_t comparisons) {
    const PairedComparison& paired = pair.comparison.columns.front().paired;
    if (pair.not_run()) return Conclusion::not_run;
    if (paired.pairs > 0 && paired.ties == 1) return Conclusion::equal;
    if (paired.pairs < 2) return Conclusion::not_shown;
    const Summary& difference = paired.difference;
    const double half = t_quantile(0.05 / static_cast<double>(comparisons), static_cast<double>(paired.pairs - 1)) *
                        difference.standard_error;
    const bool resampled = pair.keep == Keep::trials;
    if (difference.mean + half < 0 && (!resampled || paired.bootstrap95.high < 0)) return Conclusion::lower;
    if (difference.mean - half > 0 && (!resampled || paired.bootstrap95.low > 0)) return Conclusion::higher;
    return Conclusion::not_shown;
}

/// Holm's correction over all comparisons that are shown, as for the pairs of a report.
void correct_together(std::vector<ComparedPair>& pairs) {
    std::vector<Comparison> comparisons;
    for (ComparedPair& pair : pairs) comparisons.push_back(std::move(pair.comparison));
    correct_together(comparisons);
    for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i].comparison = std::move(comparisons[i]);
}

}  // namespace

const std::string& conclusion_name(Conclusion conclusion) {
    static const std::string names[] = {"lower", "higher", "equal", "no difference shown", "not run yet"};
    return names[static_cast<std::size_t>(conclusion)];
}

CompareReport compare_studies(const std::vector<StudyFile>& files, const std::optional<ArmsChoice>& choice) {
    CompareReport report;
    report.root_seed = files.front().study.root_seed;
    for (const ChosenPair& chosen : chosen_pairs(files, choice, report.left_out))
        report.pairs.push_back(compared(chosen, report.root_seed));
    correct_together(report.pairs);
    for (ComparedPair& pair : report.pairs)
        pair.conclusion = concluded(pair, report.pairs.size());
    return report;
}

}  // namespace credence
