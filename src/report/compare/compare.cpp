#include <algorithm>
#include <cmath>
#include "report/compare/compare.hpp"
#include <credence/error.hpp>
#include <credence/text.hpp>

#include "report/compare/choice.hpp"

namespace credence {

namespace {

/// Trials by how they ended.
std::vector<std::int64_t> counted(const std::vector<double>& statuses) {
    std::vector<std::int64_t> counts(status_names().size());
    for (const double status : statuses) ++counts[static_cast<std::size_t>(status)];
    return counts;
}

/// Counts of the arm; `statuses`: of the trials that are compared, by how they ended.
ComparedSide side_of(const ComparedArm& compared, const StudyFile& file, const std::vector<std::int64_t>& statuses) {
    ComparedSide side{file.path, "study " + study_hash(file.study), compared.results.trials};
    if (const auto arm = static_cast<std::size_t>(&compared.arm - compared.results.arms.data()); file.is_record)
        side.steps = file.steps_of_arms[arm];
    for (std::size_t status = 0; status < statuses.size(); ++status)
        if (failed(static_cast<Status>(status))) side.failed += statuses[status];
    side.diverged = statuses[static_cast<std::size_t>(Status::diverged)];
    return side;
}

/// Arms of different files. Two shards of one study, for example, have no trial in common.
void require_common_trials(const ChosenPair& chosen, const CommonTrials& common) {
    if (common.count() > 0 || chosen.a.results.trials == 0 || chosen.b.results.trials == 0) return;
    throw InputError("have no trial of " + printable(chosen.a.results.scenario.name) + " in common", {},
                     "Merge the shards of each study, or compare the same shard of both")
        .at(chosen.file_a.path + " and " + chosen.file_b.path);
}

/// The estimator of an arm, such as `ekf` of `greedy.ekf`; all of a name without a controller.
std::string estimator_of(const std::string& arm) { return arm.substr(arm.find('.') + 1); }

/// Whether the pair is of different filters: its arms are no controllers of one estimator, or what the filter believes
/// differs.
bool is_of_filters(const ChosenPair& chosen, const std::vector<KeyDifference>& differences) {
    const std::string &a = chosen.a.arm.name, &b = chosen.b.arm.name;
    return controller_of(a) == a || controller_of(b) == b || estimator_of(a) != estimator_of(b) ||
           std::ranges::any_of(differences,
                               [](const KeyDifference& one) { return one.key.starts_with("filter."); });
}

/// Moves the log score to the front: of filters trace(P) is what each says of itself.
void lead_with_log_score(std::vector<ComparedColumn>& columns) {
    const auto score = std::ranges::find(columns, "log_score", &ComparedColumn::name);
    if (score != columns.end()) std::rotate(columns.begin(), score, score + 1);
}

/// One filter on two paths: columns to conclude on behind trace(P), which is of what each path has found, and whether
/// the filter can be believed on either path.
void compare_paths(const ChosenPair& chosen, ComparedPair& pair) {
    const std::vector<ComparedColumn>& columns = pair.comparison.columns;
    for (std::size_t c = 1; c < columns.size(); ++c)
        if (columns[c].name == "pose_error" || columns[c].name == "coverage")
            pair.further.emplace_back(c, Conclusion::not_shown);
    const auto verdict = [](const ComparedArm& one) {
        const WithTotals with_totals(one.results);
        const auto& arm = (*with_totals).arms[static_cast<std::size_t>(&one.arm - one.results.arms.data())];
        return judge(evidence_of(*with_totals, arm), Limits()).verdict;
    };
    pair.a.verdict = verdict(chosen.a);
    pair.b.verdict = verdict(chosen.b);
}

ComparedPair compared(const ChosenPair& chosen, std::uint64_t root_seed) {
    const ScenarioResults &a = chosen.a.results, &b = chosen.b.results;
    ComparedPair pair;
    pair.comparison = compare_arms(chosen.a, chosen.b, root_seed);
    pair.title = a.scenario.title;
    pair.complete = chosen.file_a.study.complete && chosen.file_b.study.complete;
    pair.steps_of_any = chosen.file_a.steps_of_any;
    pair.steps_of_all = chosen.file_a.steps_of_all;
    pair.keep = a.keep;
    if (&a == &b) {
        pair.trials = a.trials;
        pair.a = side_of(chosen.a, chosen.file_a, chosen.a.arm.totals.trials.statuses);
        pair.b = side_of(chosen.b, chosen.file_b, chosen.b.arm.totals.trials.statuses);
    } else {
        const CommonTrials common(a, b);
        require_common_trials(chosen, common);
        pair.trials = common.count();
        const auto statuses = [](const ComparedArm& one) {
            return column_values(one.results, one.arm, status_column(one.results.columns));
        };
        pair.a = side_of(chosen.a, chosen.file_a, counted(common.of_a(statuses(chosen.a))));
        pair.b = side_of(chosen.b, chosen.file_b, counted(common.of_b(statuses(chosen.b))));
        pair.differences = shown_differences(a.scenario, b.scenario);
    }
    if (is_of_filters(chosen, pair.differences))
        lead_with_log_score(pair.comparison.columns);
    else if (!pair.not_run() && !chosen.file_a.is_record)
        compare_paths(chosen, pair);
    for (const ComparedColumn& column : pair.comparison.columns) {
        pair.a.mean.push_back(column.paired.mean_a);
        pair.b.mean.push_back(column.paired.mean_b);
    }
    return pair;
}

/// The levels of the conclusions on failures and on the mean, each shared by all comparisons (Bonferroni).
constexpr double level_of_failures = 0.01, level_of_mean = 0.04;
/// Of fewer pairs the t interval alone concludes nothing.
constexpr std::int64_t enough_pairs = 30;

Conclusion concluded_on_mean(const ComparedPair& pair, std::size_t column, double level) {
    const PairedComparison& paired = pair.comparison.columns[column].paired;
    if (pair.not_run()) return Conclusion::not_run;
    if (paired.pairs > 0 && paired.ties == 1) return Conclusion::equal;
    const bool few = paired.pairs < enough_pairs;
    const Summary& difference = paired.difference;
    const double half = t_quantile(level, static_cast<double>(paired.pairs - 1)) * difference.standard_error;
    const auto agrees = [&](bool with) { return !few || (with && paired.sign_p <= level); };
    if (difference.mean + half < 0 && agrees(paired.wins_a > paired.wins_b)) return Conclusion::lower;
    if (difference.mean - half > 0 && agrees(paired.wins_b > paired.wins_a)) return Conclusion::higher;
    return few ? Conclusion::too_few : Conclusion::not_shown;
}

void conclude(ComparedPair& pair, std::size_t comparisons, std::size_t means) {
    const std::int64_t a = pair.a.failed_trials(), b = pair.b.failed_trials();
    pair.failure_p = fisher_exact(a, pair.trials, b, pair.trials);
    if (pair.failure_p <= level_of_failures / static_cast<double>(comparisons))
        pair.failures = a < b ? Conclusion::lower : Conclusion::higher;
    const double level = level_of_mean / static_cast<double>(means);
    pair.conclusion = concluded_on_mean(pair, 0, level);
    for (auto& [column, conclusion] : pair.further) conclusion = concluded_on_mean(pair, column, level);
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
    static const std::string names[] = {"lower",
                                        "higher",
                                        "equal",
                                        "no difference shown",
                                        "too few to conclude",
                                        "not run yet"};
    return names[static_cast<std::size_t>(conclusion)];
}

bool differs(const ComparedColumn& column) {
    const Interval& mean = column.paired.difference.ci95;
    return column.holm_p <= 0.05 && (column.paired.wilcoxon_z < 0 ? mean.high < 0 : mean.low > 0);
}

CompareReport compare_studies(const std::vector<StudyFile>& files, const std::optional<ArmsChoice>& choice) {
    CompareReport report;
    report.root_seed = files.front().study.root_seed;
    for (const ChosenPair& chosen : chosen_pairs(files, choice, report.left_out))
        report.pairs.push_back(compared(chosen, report.root_seed));
    correct_together(report.pairs);
    std::size_t means = report.pairs.size();
    for (const ComparedPair& pair : report.pairs) means += pair.further.size();
    for (ComparedPair& pair : report.pairs) conclude(pair, report.pairs.size(), means);
    return report;
}

void require_same_sign(CompareReport& report, const CompareReport& added) {
    for (std::size_t i = 0; i < report.pairs.size(); ++i) {
        ComparedPair& pair = report.pairs[i];
        const ComparedPair& other = added.pairs[i];
        pair.with_truth = other.comparison.columns.front().paired.difference;
        const bool concluded = pair.conclusion == Conclusion::lower || pair.conclusion == Conclusion::higher;
        if (concluded && other.conclusion != pair.conclusion) pair.conclusion = Conclusion::not_shown;
    }
}

}  // namespace credence
