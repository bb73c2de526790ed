#pragma once
// A - B, trial by trial: arms of one results file, or of files whose trials share their draws. This file
// declares the selection and its checks, and the output as text, JSON, CSV and HTML; comparison.hpp the computation.
// [docs/statistics.md, Comparison]

#include <credence/detail/comparison.hpp>
#include <credence/study.hpp>
#include <credence/consistency.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace credence {

/// A study and the file that it came from.
struct StudyFile {
    std::string path;
    Study study;
    bool is_record = false;  ///< or records, as arms of one scenario
    std::string label{};  ///< what a record is called; empty: as an arm of its file
    /// Of records: the steps at which each arm has results; those at which any record has, and all.
    std::vector<std::int64_t> steps_of_arms{};
    std::int64_t steps_of_any = 0, steps_of_all = 0;
};

/// An arm as requested: its name, or that of its controller alone.
struct ArmChoice {
    std::size_t file = 0;  ///< its place in the list of files
    std::string arm;
};

/// The value of `--arms A,B`.
struct ArmsChoice {
    std::string text;  ///< as given
    ArmChoice a, b;
};

/// Reads `A,B`, each of them `ARM` or `FILE:ARM`; FILE is a path as given or its stem. Of one file, an arm alone is of
/// that file; of two, A alone is of the first and B alone of the second; else each names its file. Throws InputError.
ArmsChoice read_arms(const std::string& text, const std::vector<std::string>& paths);

/// The conclusion from the pairs on a column: the log score where the arms are different filters; trace(P), pose error
/// and coverage where they are controllers of one. On the trials that failed or diverged: lower, higher or not_shown.
enum class Conclusion {
    lower,      ///< A's mean, or share, is lower
    higher,     ///< it is higher
    equal,      ///< A and B are equal in every trial
    not_shown,  ///< neither is shown
    too_few,    ///< nor could it be by so few pairs, unless their signs agree
    not_run,    ///< A or B has no trial yet
};
const std::string& conclusion_name(Conclusion conclusion);

/// Whether the pairs show that a column differs: by signed ranks, Holm-corrected over all columns that are compared,
/// and with a mean difference of the same sign at 95 %.
bool differs(const ComparedColumn& column);

/// One of the two arms of a comparison.
struct ComparedSide {
    std::string file, source;               ///< its path, and `study UUID`
    std::int64_t trials = 0;                ///< of its file
    std::int64_t failed = 0, diverged = 0;  ///< of the trials that are compared
    std::int64_t steps = 0;                 ///< of a record: at which it has results
    std::optional<Verdict> verdict{};       ///< of one filter on two paths: on all trials of its file
    std::int64_t failed_trials() const { return failed + diverged; }
    /// By column, over the pairs: mean of A - mean of B = mean of A - B. NaN where no trial is kept and some trial is
    /// in no pair.
    std::vector<double> mean{};
};

/// A - B of one scenario.
struct ComparedPair {
    Comparison comparison;
    std::string title;  ///< the scenario's
    ComparedSide a, b;
    std::int64_t trials = 0;                 ///< that both have, from 0 on; those that failed in A or B are no pairs
    std::int64_t steps_of_any = 0, steps_of_all = 0;  ///< of records: at which any has results, and those compared
    bool complete = true;                    ///< the studies of both are
    Keep keep = Keep::trials;
    std::vector<KeyDifference> differences;  ///< of scenarios of different files, but for titles and published values
    double failure_p = 1;            ///< of Fisher's exact test on the shares that failed or diverged
    Conclusion failures = Conclusion::not_shown;    ///< on these shares
    Conclusion conclusion = Conclusion::not_shown;  ///< on the mean of the first column
    /// Of one filter on two paths: on further columns, by their places.
    std::vector<std::pair<std::size_t, Conclusion>> further{};
    std::optional<Summary> with_truth;  ///< the mean difference with the covariance of the truth's errors added to P

    bool not_run() const { return a.trials == 0 || b.trials == 0; }
    std::int64_t pairs() const { return comparison.columns.front().paired.pairs; }
};

struct CompareReport {
    std::uint64_t root_seed = 1;
    std::vector<ComparedPair> pairs;    ///< never empty
    std::vector<std::string> left_out;  ///< scenarios that are not compared, and why
    bool of_records = false;            ///< of the same runs, whose draws are not known
    double failed_limit = Limits().failed;  ///< where a larger share of an arm's trials failed, a warning comes first
};

/// Compares the arms chosen, in every scenario that has both; scenarios of different files are matched by name. Without
/// a choice: of one file, every planned arm with its baseline (baseline_of); of several, each later file's arms with
/// the first file's of the same name (later - first). Arms of several files are called `STEM:arm`.
///
/// The conclusion on failures is drawn by Fisher's exact test at 1 %/m, m the number of comparisons; that on the mean
/// where it is beyond t_{1 - 0.02/k, n - 1} standard errors, k the number of means that are concluded on, and below 30
/// pairs only if the sign test agrees at 4 %/k: all hold together at 95 % [docs/statistics.md, Comparison].
///
/// Throws InputError where files have different root seeds, where a scenario's world is not the same in them (any key
/// but scenario.title and those of filter, control, planner, arms and published), or where nothing has both arms; and
/// for arms of different files of which one keeps no trials.
CompareReport compare_studies(const std::vector<StudyFile>& files, const std::optional<ArmsChoice>& choice);

/// Concludes on a mean only where `added`, the same comparison with the covariance of the truth's errors added to P,
/// does so: that the truth is exact, and that it is not, are both possible.
void require_same_sign(CompareReport& report, const CompareReport& added);

// Texts that every format of a comparison uses.

/// What is compared, and the meaning of the intervals.
std::string compare_head(const CompareReport& report);

/// Failed and diverged trials, studies that are not complete, scenarios that are left out; a line each.
std::string compare_notes(const CompareReport& report);

/// One sentence on each column that is concluded on, and the others that differ.
std::string conclusion_text(const ComparedPair& pair);

/// What is compared, where the arms' names do not show it; the scenario's name and title in the first line.
std::string pair_head(const ComparedPair& pair);

/// The comparison as text: the conclusions first, then a table with a row per column for each pair.
std::string compare_text(const CompareReport& report);
/// An array with an object per scenario and pair; NaN and infinity are null.
std::string compare_json(const CompareReport& report);
/// One self-contained page, like that of report_html.
std::string compare_html(const CompareReport& report, const std::string& made_by);
/// A row per scenario, pair and column; NaN is an empty cell.
std::string compare_csv(const CompareReport& report);

}  // namespace credence
