#pragma once
// Module report: the report. It is computed once from a study and then rendered as text, JSON, CSV or HTML.

#include <credence/detail/comparison.hpp>
#include <credence/consistency.hpp>
#include <credence/detail/histogram.hpp>
#include <credence/record.hpp>
#include <credence/detail/store.hpp>

#include <optional>
#include <string>
#include <vector>

namespace credence {

/// A published single-run value and its place in the distribution over the trials, in percent (mid-rank).
struct PublishedPlace {
    double value = 0, percentile = 0;
};

/// Quantiles that a report gives beside the median.
inline constexpr double reported_quantiles[] = {0.05, 0.25, 0.75, 0.95};

/// One per-trial column of one arm.
struct ColumnReport {
    std::string name, unit;
    Summary summary;
    std::vector<double> quantiles;          ///< of type 7, at reported_quantiles; NaN where no trial is kept
    std::optional<Interval> bootstrap95;    ///< of the mean; not of columns that have their own tests; NaN likewise
    std::optional<PublishedPlace> published;  ///< its percentile NaN likewise
    std::optional<Histogram> histogram;     ///< of the columns that may have a published value; none likewise
    ColumnPlaces places{};
};

/// How most of an arm's failed trials ended, and at which pose most of these did.
struct FailureCause {
    Status status = Status::completed;
    std::int64_t trials = 0;   ///< that ended so
    std::int64_t pose = -1;    ///< -1 where no trial is kept
    std::int64_t at_pose = 0;  ///< trials that ended so at this pose
    std::string place;         ///< what a pose is called: `pose`, or `step` of a record
};

struct ArmReport {
    std::string scenario, arm;
    std::int64_t trials = 0;                ///< all that are present; 0: the arm has not run yet
    std::int64_t failed = 0;                ///< of them, those that are left out of the columns
    std::int64_t diverged = 0;              ///< of them, those that diverged, whose columns are kept
    std::vector<ColumnReport> columns;      ///< the real and integer columns, in their order, status columns left out
    Evidence evidence;
    Consistency consistency;
    std::optional<FailureCause> cause{};  ///< none where no trial failed
    RecordGaps gaps{};                    ///< of a record
    int every = 1;                        ///< of a record [Record::every]
    std::vector<RunCurves> curves{};      ///< of a record, by run where there are few

    bool not_run() const { return trials == 0; }
    /// The largest share of failed trials without the verdict `failed`.
    std::int64_t failed_trials() const { return failed + diverged; }
};

struct Report {
    std::string source;                     ///< `study UUID`, or `record FILE`
    std::optional<std::uint64_t> root_seed; ///< none for a record
    std::int64_t trials = 0;  ///< of each scenario that were asked for
    bool complete = true;
    Keep keep = Keep::trials;
    Limits limits;
    int segments = segments_auto;           ///< of a record, as asked for [record.hpp]
    std::vector<Scenario> scenarios;
    std::vector<ArmReport> arms;
    std::vector<RecordTrouble> troubles;    ///< of a record: trials that failed, the first ones
    std::vector<std::string> not_judged;    ///< of a record: what cannot be judged by what it holds, in sentences
    std::vector<Comparison> pairs;          ///< greedy - fixed and horizon - greedy of the same estimator, by trial
};

/// Failed trials are left out (their values are NaN); diverged ones are left out of the verdict alone.
Report make_report(const Study& study, const Limits& limits);

/// The same of a record: one arm, `record`; `path` names it.
Report make_record_report(Record record, const std::string& path, const Limits& limits);

/// Several reports of records as one, an arm for each, scenarios of the same name told apart by a number.
Report together(std::vector<Report> reports);

/// One arm's part of a report.
ArmReport report_arm(const ScenarioResults& results, const ArmResults& arm, Evidence evidence, std::uint64_t root_seed,
                     const Limits& limits);

/// The report as text: the verdicts, their reasons, and the steps.
std::string report_text(const Report& report);
/// An array with an object per scenario and arm; NaN is null.
std::string report_json(const Report& report);
/// A row per scenario, arm and column or series; and one per pair and column.
std::string report_csv(const Report& report);

/// The origin of the numbers on a page.
struct PageOrigin {
    std::string file;       ///< the results file or the record, without its folder
    RunFacts run;           ///< the results file's /run; empty for a record
    std::string made_by;    ///< the program that makes the page
};
/// One self-contained page: it loads nothing and runs no scripts. The same bytes for the same report and origin.
std::string report_html(const Report& report, const PageOrigin& origin);

/// What a gate asks of every arm: that it is shown to be `consistent`, or that it is not refuted, so that `undecided`
/// passes.
enum class Requirement { consistent, no_finding };

/// Throws Failure naming the arms that do not meet it. An arm without a trial that can be judged meets neither; if
/// `strict`, one with a note [Consistency::cautions] meets neither.
void require(const Report& report, Requirement requirement, bool strict = false);

}  // namespace credence
