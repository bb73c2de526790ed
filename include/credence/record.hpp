#pragma once
// Module record: the record that `credence judge` reads: errors and covariances written by any program
// [docs/statistics.md]. It is converted to the same results as those of a run, so that report and verdict treat both
// alike.

#include <credence/evidence.hpp>
#include <credence/detail/progress.hpp>
#include <credence/detail/results.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace credence {

/// Why a trial of a record failed or diverged; both counted from 0, as in the file.
struct RecordTrouble {
    std::int64_t trial = 0;
    int step = 0;
    std::string what;  ///< such as `covariance is singular`
    Status status = Status::non_finite;
};

/// Steps within a record's runs that do not exist: their error and covariance are NaN. Of the runs that did not fail.
struct RecordGaps {
    std::int64_t steps = 0, missing = 0;   ///< of all runs
    std::int64_t runs = 0;                 ///< that lack a step
    std::int64_t trial = 0, of_trial = 0;  ///< the run that lacks most, and how many steps it lacks
    std::vector<std::int64_t> by_step;     ///< runs that lack the step
    /// NEES/dim of the whole state at the steps beside a gap and at the others, means over the runs that have both, and
    /// the difference over its standard error; NaN for fewer than ten such runs.
    double beside = std::numeric_limits<double>::quiet_NaN(), elsewhere = beside, difference = beside;
};

/// The normalised innovations squared of some rows, of the runs that count.
struct LargestNis {
    std::string part;             ///< `all`, or a group of rows
    int rows = 0;                 ///< at each step that has any; -1: they differ
    double count = 0, sum = 0;
    std::vector<double> largest;  ///< ten at most, rising
};

/// In place of the steps of a segment: chosen by the errors where there are up to `most_runs_in_segments` runs
/// [evidence.hpp]; no segments.
inline constexpr int segments_auto = -1, segments_off = 0;

/// Segments of the runs of a record that did not fail [docs/statistics.md, One log].
struct RecordSegments {
    int asked = segments_auto;  ///< as given to `read_record`
    SegmentEvidence found{};
    std::shared_ptr<const ScenarioResults> results{};  ///< of segments in place of trials, if they count; else null
    /// The same with errors about their mean [Evidence::centred], also where segments do not count; else null.
    std::shared_ptr<const ScenarioResults> centred{};
};

/// The error of a component over a run.
struct ErrorCurve {
    struct Point {
        std::size_t step = 0;             ///< counted from 0
        double error = 0, sigma = 0;      ///< sigma: what P says
    };
    std::string component, unit;
    std::vector<Point> points{};          ///< of each stretch of steps the lowest and highest, also in sigmas
    std::int64_t steps = 0, outside = 0;  ///< all that have the component; those with an error beyond two sigma
};

/// What a page draws of a run.
struct RunCurves {
    std::vector<double> times;                               ///< by step, in seconds; empty without `time`
    std::vector<std::pair<std::size_t, std::size_t>> gaps;   ///< long ones: the steps before and behind them
    std::vector<ErrorCurve> errors;                          ///< of the first components where there are many
};

/// A record whose errors are about their mean over the trials, step by step [docs/statistics.md, Attribution].
struct AboutMeans {
    ScenarioResults results;
    double share = 0;  ///< of the squared error, in units of P, that the means carry
};

/// A record that was read. `results` has one arm, `record`; its scenario only has a name (the file's stem), a title and
/// poses = steps + 1. Step k of the results is step (k - 1) every of the file. Differences to the results of a run:
/// - runs may differ in length: `present` counts the counted trials that have a step, and `run_sum` and
///   `run_square_sum` of real series (but NIS) are of the trial's mean over its own steps times the number of steps in
///   the file;
/// - NIS and its series are only there with innovations, and `products` are of all trials;
/// - a series may lack a value at some steps of a trial: its own `present` and `runs` count [results.hpp];
/// - the column `unseen` is unknown (-1), and `pose_error` is of the group `pose`, else of the whole state; it and
///   trace(P) are of the components that have the unit of most of them, where units are given;
/// - `distribution_distance` is exact up to 2^24 values; beyond, it is empty and `cells` are used, but over 4096 steps
///   `cells` are empty, and `distribution_distance` is NaN where the values were too many.
struct Record {
    ScenarioResults results;
    int every = 1;  ///< which steps the results by step have: all up to 99,999, of longer runs some 10,000
    bool has_innovations = false;
    bool of_innovations = false;          ///< which stand for errors
    std::vector<RecordTrouble> troubles;  ///< the first 20
    std::int64_t trouble_count = 0;       ///< trials that failed
    RecordGaps gaps{};
    std::vector<LargestNis> largest_nis{};
    RecordSegments segments{};
    std::vector<RunCurves> curves{};      ///< of runs fewer than `least_segments`
    std::string log{};    ///< as words of a shell: the log that it was made of, and how that was read; may be empty
    std::string chart{};  ///< of errors that differ between charts: `local`, `global` or `plain`; else empty
    std::shared_ptr<const TruthEvidence> truth{};  ///< with the covariance of the truth's errors; null without it
    /// Reads the record again, with members of one unit: of P + s^2 I over these, and of errors about the mean of
    /// their run where there are fewer than `runs_that_tell`, the smallest s at which NEES/dimension is at most each of
    /// these. Empty with `truth`.
    std::function<std::vector<double>(const std::vector<int>& members, const std::vector<double>& nees)> truth_sigmas{};
    /// Reads the record again: some of its steps, with those components. Empty without P.
    std::function<SampledSteps(const std::vector<int>& components)> sample{};
    /// Each reads the record again, with its errors in another chart: the other of `local` and `global`, then, of
    /// poses, `plain`, the differences of positions in the world's frame. Empty where charts do not differ.
    std::vector<std::function<Record()>> in_other_charts{};
    /// Reads the record twice more. Empty where there are fewer than `least_segments` trials that count, or no P of the
    /// whole state.
    std::function<AboutMeans()> about_means{};
};

/// Reads a record, some trials at a time: memory grows with the file only by the columns of each trial, the errors of
/// the first `detailed_trials`, by the declared steps of each, and up to 2^24 values of NEES.
///
/// docs/judge.md has the format. The root's attribute `record_version` is 2. The datasets and attributes:
/// - `error` [trial, step, n], n to 1000: estimate - truth, in the chart of the covariance. A step whose error and
///   covariance are all NaN does not exist; its other values are ignored.
/// - `covariance` [trial, step, n, n]: symmetric to 1e-9 of sqrt(P_ii P_jj), or to 16 epsilons of its type, if that
///   is more; the mean of both halves is used.
/// - `steps` [trial], optional: the number of steps of each run; values after them are ignored.
/// - both or neither: `innovation` [trial, step, m], m to 2000, NaN in rows that were not observed, and
///   `innovation_covariance` [trial, step, m, m], of which the observed rows are used.
/// - all optional: components that enter and leave the state; `covariance` [trial, step, n] of variances,
///   /group/NAME/covariance and /group/NAME/nees in place of a joint covariance; `truth` and `estimate` on a manifold
///   in place of `error`; the attributes `groups`, `row_groups`, `component_names`, `component_units` and `log`;
///   `time`; `truth_covariance` [n], [n, n], [step, n, n] or [trial, step, n, n] or the attribute `truth_sigma`, and
///   `truth_dependent`. What such a record cannot show is in `results.not_judged`.
/// A record of one trial may leave out the dimension of trials. Anything else in the file is ignored.
///
/// A trial with a covariance (of the errors or the observed innovations) that is not positive definite has failed: the
/// smallest eigenvalue of its correlation matrix is at most 2 n eps, which may be a 0 with rounding errors; eps is
/// 2^-52, or that of the type in the file where it is coarser. A trial has also failed, as `non_finite`, if at some
/// step only the error or only the covariance is NaN or some value is not finite, if its series exceed 1e140, if it has
/// no steps, or if it ends before its declared steps or, where none are declared, before the longest trial. Failed
/// trials are left out of the totals. Those of diverged ones are apart, unless more than half of those that did not
/// fail diverged: then these count as the others. All are listed as troubles.
///
/// Components whose errors and whose rows and columns of every covariance are 0 at all steps are not in the state: they
/// are left out, and `results.not_judged` names them.
///
/// `segments` is the number of steps in a segment, segments_auto or segments_off.
///
/// Throws InputError `FILE: PLACE: PROBLEM. REMEDY.` for any other deviation from this format. `progress` may be empty.
/// `attributes` of the root take the place of those in the file.
Record read_record(const std::string& path, const std::function<void(const Progress&)>& progress = {},
                   int segments = segments_auto, const std::map<std::string, std::string>& attributes = {});

/// The evidence of its runs, and of their segments if these count.
Evidence evidence_of(const Record& record);

/// Throws InputError naming what shows that the runs of a record are not those of the first: another `seed`, names,
/// units or numbers of components, numbers of runs or steps, `trial`, `truth`, `time` or `steps`. What only one of them
/// has shows nothing.
void require_same_runs(const std::string& first, const std::string& path);

/// An array in memory that stands for a dataset of a record.
struct RecordArray {
    enum class Type { real32, real64 };

    std::string path;                   ///< such as `error`, `group/NAME/covariance`
    const void* data = nullptr;         ///< aligned as its type
    Type type = Type::real64;
    std::vector<std::int64_t> extents, strides;  ///< strides in elements
    double epsilon = 0;                 ///< distance of 1 from the next number of the type in which it was computed
};

/// A record in memory.
struct RecordArrays {
    std::vector<RecordArray> arrays;
    std::map<std::string, std::string> texts;       ///< the root's attributes, lists as texts with commas
    std::map<std::string, int> dimensions;          ///< the attribute `dimension` of a NEES, by its path
    /// Attributes in place of such texts: each entry is a name, and behind it the members of a group.
    std::map<std::string, std::vector<std::vector<std::string>>> lists{};
};

/// Reads a record in memory as if it were in a file, a part at a time; the arrays are only read. `name` names the
/// scenario, as a file's path does. Throws InputError `PLACE: PROBLEM. REMEDY.`, its places named as arrays.
Record read_record(const RecordArrays& arrays, const std::string& name,
                   const std::function<void(const Progress&)>& progress = {}, int segments = segments_auto);

}  // namespace credence
