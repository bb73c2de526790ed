#pragma once
// Module report: what people read. A report is computed once from a study and then rendered as text, JSON, CSV or HTML.

#include <credence/comparison.hpp>
#include <credence/consistency.hpp>
#include <credence/histogram.hpp>
#include <credence/record.hpp>
#include <credence/store.hpp>

#include <optional>
#include <string>
#include <vector>

namespace credence {

/// A published single-run figure and its place in our distribution, in percent (mid-rank).
struct PublishedPlace {
    double value = 0, percentile = 0;
};

/// Quantiles that a report gives beside the median.
inline constexpr double reported_quantiles[] = {0.05, 0.25, 0.75, 0.95};

/// One per-trial figure of one arm.
struct ColumnReport {
    std::string name, unit;
    Summary summary;
    std::vector<double> quantiles;          ///< of type 7, at reported_quantiles; NaN where no trial is kept
    std::optional<Interval> bootstrap95;    ///< of the mean; not of figures that have their own tests; NaN likewise
    std::optional<PublishedPlace> published;  ///< its percentile NaN likewise
    std::optional<Histogram> histogram;     ///< of the figures that may have a published one; none likewise
};

struct ArmReport {
    std::string scenario, arm;
    std::int64_t trials = 0;                ///< all that are there; 0: the arm is not run yet
    std::int64_t failed = 0;                ///< of them, those that are in no figure
    std::int64_t diverged = 0;              ///< of them, those that diverged and are in the figures
    std::vector<ColumnReport> columns;      ///< the real and integer columns, in their order, status columns left out
    Evidence evidence;
    Consistency consistency;

    bool not_run() const { return trials == 0; }
    /// What the verdict counts as failed.
    std::int64_t failed_trials() const { return failed + diverged; }
};

struct Report {
    std::string source;                     ///< `study UUID`, or `record FILE`
    std::optional<std::uint64_t> root_seed; ///< none for a record
    std::int64_t trials = 0;  ///< of each scenario that were asked for
    bool complete = true;
    Keep keep = Keep::trials;
    Limits limits;
    std::vector<Scenario> scenarios;
    std::vector<ArmReport> arms;
    std::vector<RecordTrouble> troubles;    ///< of a record: trials that failed, the first ones
    std::vector<Comparison> pairs;          ///< greedy - fixed and horizon - greedy of the same estimator, by trial
};

/// Figures of failed trials are left out (they are NaN), but for those that diverged; their number is given beside.
Report make_report(const Study& study, const Limits& limits);

/// The same of a record: one arm, `record`; `path` names it.
Report make_record_report(Record record, const std::string& path, const Limits& limits);

/// One arm's part of a report.
ArmReport report_arm(const ScenarioResults& results, const ArmResults& arm, std::uint64_t root_seed,
                     const Limits& limits);

/// For people: the verdicts, why, and where.
std::string report_text(const Report& report);
/// An array with an object per scenario and arm; NaN is null.
std::string report_json(const Report& report);
/// A row per scenario, arm and figure; and one per pair and figure.
std::string report_csv(const Report& report);

/// What a page says of where its figures came from.
struct PageOrigin {
    std::string file;       ///< the results file or the record, without its folder
    RunFacts run;           ///< the results file's /run; empty for a record
    std::string made_by;    ///< the program that makes the page
};
/// One self-contained page: nothing is loaded, nothing runs. The same bytes for the same report and origin.
std::string report_html(const Report& report, const PageOrigin& origin);

/// Throws Failure naming the arms that are not `consistent`.
void require_consistent(const Report& report);

}  // namespace credence
