#pragma once
// One step of a record: checked, and turned into series.
//
//   e  error [n], P  covariance [n, n]; nu  innovation [m], S  its covariance [m, m]; NaN in rows not observed

#include "base/nan.hpp"
#include "numeric/decompositions.hpp"
#include "scenario/state_series.hpp"

#include <Eigen/Dense>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace credence {

/// By what a component group of a record is judged.
enum class GroupSource {
    joint,      ///< its part of the covariance of the whole state
    variances,  ///< the variances of its components alone: no NEES, unless it is one component
    own,        ///< a covariance of its own
    nees,       ///< its NEES and nothing else
    nothing,
};

/// Rows of an innovation that are judged by themselves.
struct RowGroup {
    std::string name;
    std::vector<int> rows;
};

/// What is done with the covariance R of the truth's own errors: nothing beside P, or P + R or P - R in place of P.
enum class TruthUse { beside, added, subtracted };

/// What a record holds.
struct RecordShape {
    std::int64_t trials = 0;
    int steps = 0;
    int n = 0;                       ///< components of the state
    int m = 0;                       ///< rows of an innovation; 0 without innovations
    std::vector<ComponentGroup> groups;  ///< all, and those that the record names
    double covariance_epsilon = 0, innovation_epsilon = 0;  ///< of the types in the file
    std::vector<int> declared;       ///< [trials] steps of each trial by the dataset `steps`; empty without it
    int longest = 0;                 ///< steps of the longest trial, by its errors

    std::vector<Component> components;   ///< [n] names and units; empty: x0, x1 ... without a unit
    std::vector<GroupSource> sources;    ///< [groups]; empty: all `joint`
    /// [groups] of the types in the file, where a group has a covariance of its own.
    std::vector<double> group_epsilons;
    std::vector<RowGroup> row_groups;
    /// Of a record of few runs, in seconds: [1] of all runs, or [trials]; empty without the dataset `time`.
    std::vector<std::vector<double>> times;
    std::vector<std::string> known, known_groups;  ///< left out: components that are known exactly, and groups of these
    std::string arm = "record";          ///< what the record says that it is of
    /// Its own columns, beside those that every record has, and their values [columns][trials].
    std::vector<Column> columns;
    std::vector<std::vector<double>> column_values;
    /// Whether a step of a trial counts in a comparison with other records; empty: all do. Others must be right, too.
    std::function<bool(std::int64_t trial, int step)> compared{};
    bool has_errors = true;              ///< false: NEES alone
    bool of_innovations = false;         ///< the errors are innovations
    bool has_variances = false;          ///< the covariance is [trial, step, n]
    bool has_truth_covariance = false;
    bool truth_depends = false;          ///< on the filter's own data
    TruthUse truth = TruthUse::beside;

    GroupSource source(std::size_t group) const { return sources.empty() ? GroupSource::joint : sources[group]; }
    bool has_joint() const { return source(0) == GroupSource::joint; }
    bool has_innovations() const { return m > 0; }
    /// Steps that a trial must have.
    int steps_of(std::int64_t trial) const {
        return declared.empty() ? longest : declared[static_cast<std::size_t>(trial)];
    }
    /// Whether the file's step is one of the trial's: what comes after its declared end is not read.
    bool covers(std::int64_t trial, int step) const { return declared.empty() || step < steps_of(trial); }
};

/// The name of a component: x0, x1 ... where the record has none.
std::string component_name(const RecordShape& shape, int j);

/// A step of a record as the file has it.
struct RecordStep {
    std::int64_t trial = 0;
    int step = 0;
    const double* error = nullptr;                  ///< [n]
    const double* covariance = nullptr;             ///< [n, n]
    const double* truth_covariance = nullptr;       ///< [n, n]; null without
    const double* innovation = nullptr;             ///< [m]; null without innovations, and so is the next
    const double* innovation_covariance = nullptr;  ///< [m, m]
    std::vector<const double*> own{};               ///< [groups] covariance [d, d] or NEES of a group; else null
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
    Eigen::MatrixXd P;       ///< symmetric; empty where the record has no joint covariance
    Eigen::VectorXd variances;  ///< [n] where the record has these alone
    Eigen::MatrixXd R;       ///< of the truth's own errors, already in P as RecordShape::truth says; empty without
    std::vector<int> rows;   ///< observed rows of the innovation
    Eigen::VectorXd nu;      ///< [rows]
    Eigen::MatrixXd S;       ///< [rows, rows], symmetric
    std::string broken;      ///< such as `the covariance is not finite`

    // Components that are not in the state are 0 in e and P.
    std::vector<char> here;             ///< [n] whether the component is in the state; empty: all are
    std::vector<Eigen::MatrixXd> own;   ///< [groups] a group's own covariance
    std::vector<double> nees;           ///< [groups] a group's NEES as given; NaN where it has none at this step

    bool has(int component) const { return here.empty() || here[static_cast<std::size_t>(component)]; }
    /// Whether all components of the group are in the state.
    bool whole(const ComponentGroup& group) const;
};

/// The series of a record.
StateSeries record_series(const RecordShape& shape);

/// Whether every series of a step is a number whose square, over all steps, still adds up.
bool figures_add_up(const double* all_series, std::size_t count);

/// Turns checked steps into series. Keeps its matrices from step to step.
class StepEvaluator {
public:
    StepEvaluator(const RecordShape& shape, const StateSeries& all_series);

    /// Writes the step's series [series_count], and L^-1 nu [m], S = LL', NaN in rows not observed; without
    /// innovations that is left alone. A series that has no value at this step is 0. Returns what is wrong with a
    /// covariance; empty where nothing is.
    std::string evaluate(const CheckedStep& step, double* all_series, double* whitened);

    /// After `evaluate`: replaces the series that have no value at this step by NaN.
    void forget_unknown(double* all_series) const;

    /// After `evaluate`: the log score of the state as it is at this step [columns.hpp], of
    /// variances the sum of their components' own; NaN without either.
    double log_score() const { return log_score_; }

    /// After `evaluate`: what rounding may have done to NEES, by group, as a share of it; 0 where that is too little to
    /// matter.
    const std::vector<double>& rounding() const { return rounding_; }
    /// The same of its NIS; and that the step counts as one in which no row was observed.
    double innovation_rounding() const { return innovation_rounding_; }
    void leave_out_innovation(double* all_series, double* whitened) const;

private:
    std::string evaluate_group(std::size_t b, const CheckedStep& step, double* all_series);
    template <class Matrix, class Vector>
    std::string evaluate_part(std::size_t b, const Matrix& P, const Vector& e, double epsilon, double* all_series);
    std::string evaluate_variances(std::size_t b, const CheckedStep& step, double* all_series);
    void choose(const ComponentGroup& group, const CheckedStep& step);
    void gather(const Eigen::VectorXd& e, const Eigen::MatrixXd& P);
    void standardise(const CheckedStep& step, double* all_series);
    std::string evaluate_innovation(const CheckedStep& step, double* all_series, double* whitened);
    std::string evaluate_row_group(std::size_t g, const CheckedStep& step, double* all_series);
    void set_unknown(std::size_t series, double* all_series);
    void set_size_unknown(std::size_t b, double* all_series);

    /// Where the variance of a component is found: in the group's own covariance, or, with a group below 0, in P.
    struct VariancePlace {
        int group = -1, index = 0;
    };

    const RecordShape& shape_;
    const StateSeries& places_;
    std::vector<CholeskyFactor> factors_;  ///< by group
    std::vector<Eigen::VectorXd> solved_;
    std::vector<double> rounding_;         ///< by group
    double log_score_ = nan;
    std::vector<VariancePlace> variance_places_;  ///< by component, of a record with covariances of groups; else empty
    std::vector<std::size_t> unknown_;            ///< series without a value at the last step
    Eigen::MatrixXd part_P_;
    Eigen::VectorXd part_e_;
    std::vector<int> members_;
    CholeskyFactor innovation_factor_;
    double innovation_rounding_ = 0;
    Eigen::VectorXd white_;
};

}  // namespace credence
