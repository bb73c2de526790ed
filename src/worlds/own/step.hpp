#pragma once
// One step of a record: checked, and turned into series.
//
//   e  error [n], P  covariance [n, n]; nu  innovation [m], S  its covariance [m, m]; NaN in rows not observed

#include "scenario/state_series.hpp"

#include <Eigen/Dense>

#include <cstdint>
#include <string>
#include <vector>

namespace credence {

/// What a record holds.
struct RecordShape {
    std::int64_t trials = 0;
    int steps = 0;
    int n = 0;                       ///< components of the state
    int m = 0;                       ///< rows of an innovation; 0 without innovations
    std::vector<ComponentGroup> groups;  ///< all, and those of the attribute `blocks`
    double covariance_epsilon = 0, innovation_epsilon = 0;  ///< of the types in the file
    std::vector<int> declared;       ///< [trials] steps of each trial by the dataset `steps`; empty without it
    int longest = 0;                 ///< steps of the longest trial, by its errors

    bool has_innovations() const { return m > 0; }
    /// Steps that a trial must have.
    int steps_of(std::int64_t trial) const {
        return declared.empty() ? longest : declared[static_cast<std::size_t>(trial)];
    }
    /// Whether the file's step is one of the trial's: what stands behind its declared end is not looked at.
    bool covers(std::int64_t trial, int step) const { return declared.empty() || step < steps_of(trial); }
};

/// A step of a record as it stands in the file.
struct RecordStep {
    std::int64_t trial = 0;
    int step = 0;
    const double* error = nullptr;                  ///< [n]
    const double* covariance = nullptr;             ///< [n, n]
    const double* innovation = nullptr;             ///< [m]; null without innovations, and so is the next
    const double* innovation_covariance = nullptr;  ///< [m, m]
};

/// What a record says of a step.
enum class Presence {
    absent,   ///< all of its error and of its covariance is NaN
    there,
    broken,   ///< something of it is not finite
};

/// A step that is there; of a broken one only what is wrong.
struct CheckedStep {
    Eigen::VectorXd e;
    Eigen::MatrixXd P;       ///< symmetric
    std::vector<int> rows;   ///< observed rows of the innovation
    Eigen::VectorXd nu;      ///< [rows]
    Eigen::MatrixXd S;       ///< [rows, rows], symmetric
    std::string broken;      ///< such as `the covariance is not finite`
};

/// Reads a step. It is broken where its error is NaN and its covariance is not, or where some of its error, of its
/// covariance, of an observed row of its innovation or of that row's covariance is not finite. Throws hdf5::Error,
/// naming dataset, trial and step, where a covariance is not symmetric.
Presence check_step(const RecordStep& step, const RecordShape& shape, CheckedStep& checked);

/// What of a step is beyond the bound at which a trial counts as diverged, as in a study: its error or its covariance.
/// Empty where nothing is.
std::string divergence_of(const CheckedStep& step);

/// The series of a record, whose components are called x0, x1 ...
StateSeries record_series(const RecordShape& shape);

/// Whether every series of a step is a number whose square, over all steps, still adds up.
bool figures_add_up(const double* all_series, std::size_t count);

/// Whether a symmetric matrix, of values with the relative spacing `epsilon`, is positive definite beyond rounding.
bool is_positive_definite(const Eigen::Ref<const Eigen::MatrixXd>& matrix, double epsilon);

/// Turns checked steps into series. Keeps its matrices from step to step.
class StepEvaluator {
public:
    StepEvaluator(const RecordShape& shape, const StateSeries& all_series);

    /// Writes the step's series [series_count], and L^-1 nu [m], S = LL', NaN in rows not observed; without
    /// innovations that is left alone. Returns what is wrong with a covariance; empty where nothing is.
    std::string judge(const CheckedStep& step, double* all_series, double* whitened);

private:
    using Factor = Eigen::LLT<Eigen::MatrixXd>;

    const RecordShape& shape_;
    const StateSeries& places_;
    std::vector<Factor> factors_;  ///< by block
    std::vector<Eigen::VectorXd> solved_;
    Factor innovation_factor_;
    Eigen::VectorXd white_;
};

}  // namespace credence
