#pragma once
// Module files: the record that `credence judge` reads: errors and covariances that any program wrote [docs/statistics.md].
// It becomes the same results as a run has, so that report and verdict know no difference.

#include <credence/study.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace credence {

/// Why a trial of a record failed; both counted from 0, as in the file.
struct RecordTrouble {
    std::int64_t trial = 0;
    int step = 0;
    std::string what;  ///< such as `covariance is singular`
    Status status = Status::non_finite;  ///< a diverged trial is in the series, the others are in none
};

/// A record read. `results` has one arm, `record`; its scenario only carries a name (the file's stem), a title and
/// poses = steps + 1. Step k of the results is step k - 1 of the file. Differences to the results of a run:
/// - runs may differ in length: `present` counts the counted trials that have a step, and `run_sum` and `run_square_sum` of
///   real series (but NIS) are of the trial's mean over its own steps times the number of steps in the file;
/// - NIS and its series are only there with innovations, and `products` are of all trials;
/// - the column `unseen` is unknown (-1), and `pose_error` is of the block `pose`, else of the whole state;
/// - `distribution_distance` is exact up to 2^24 values; beyond it is empty and `cells` tell, but over 4096 steps `cells` are
///   empty, and `distribution_distance` is NaN where the values were too many.
struct Record {
    ScenarioResults results;
    bool has_innovations = false;
    std::vector<RecordTrouble> troubles;  ///< the first 20
    std::int64_t trouble_count = 0;       ///< trials that failed
};

/// Reads a record, some trials at a time: memory grows with the file only by the columns of each trial, the errors of
/// the first `detailed_trials`, by the declared steps of each, and up to 2^24 values of NEES.
///
/// - `error` [trial, step, n], n to 1000: estimate - truth, in the chart in which the covariance lives. A step whose
///   error and covariance are all NaN does not exist; what else the record says of it is not looked at.
/// - `covariance` [trial, step, n, n]: symmetric to 1e-9 of sqrt(P_ii P_jj); the mean of both halves is used.
/// - `steps` [trial], optional: how many steps each run has; what is behind them is not looked at.
/// - both or neither: `innovation` [trial, step, m], m to 2000, NaN in rows that were not observed, and
///   `innovation_covariance` [trial, step, m, m], of which the observed rows are used.
/// - the attribute `blocks` of the root, optional, half-open and 0-based: `pose 0:3, feature_1 3:5`.
/// A record of one trial may leave out the dimension of trials. Anything else in the file is ignored.
///
/// A trial with a covariance (of the errors or the observed innovations) that is not positive definite has failed: the
/// smallest eigenvalue of its correlation matrix is no more than 2 n eps, which rounding alone can make of 0; eps is
/// 2^-52, or that of the type in the file where it is coarser. So has, as `non_finite`, one with a step of which the
/// error or the covariance alone is NaN or something is not finite, one whose series go beyond 1e140, one without
/// steps, and one that ends before its declared steps or, where none are declared, before the longest trial. They are in
/// no series. One whose error or covariance goes beyond 1e12 has `diverged`, and stays in the series. All are among the
/// troubles.
///
/// Throws InputError `FILE: PLACE: PROBLEM. REMEDY.` for everything else that is not as above. `progress` may be empty.
Record read_record(const std::string& path,
                                   const std::function<void(const Progress&)>& progress = {});

}  // namespace credence
