#pragma once
// Room 12: one step of a record: checked, and turned into figures.
//
//   e  error [n], P  covariance [n, n]; nu  innovation [m], S  its covariance [m, m]; NaN in rows not observed

#include "judgement_file.hpp"

#include <Eigen/Dense>

#include <cstdint>
#include <string>
#include <vector>

namespace credence {

/// A step of a record as it stands in the file.
struct RecordStep {
    std::int64_t trial = 0;
    int step = 0;
    const double* error = nullptr;                  ///< [n]
    const double* covariance = nullptr;             ///< [n, n]
    const double* innovation = nullptr;             ///< [m]; null without innovations, and so is the next
    const double* innovation_covariance = nullptr;  ///< [m, m]
};

/// A step whose values are as they must be.
struct CheckedStep {
    Eigen::VectorXd e;
    Eigen::MatrixXd P;       ///< symmetric
    std::vector<int> rows;   ///< observed rows of the innovation
    Eigen::VectorXd nu;      ///< [rows]
    Eigen::MatrixXd S;       ///< [rows, rows], symmetric
};

/// Whether the step exists; then `checked` holds its values. Throws hdf5::Error, naming dataset, trial and step, where
/// an error or innovation is infinite, an error is NaN and another is not, or a covariance is not finite or symmetric.
bool check_step(const RecordStep& step, const RecordShape& shape, CheckedStep& checked);

/// Positions of a record's figures, by their kind; of a kind there is one per block or component, in order.
struct RecordFigures {
    explicit RecordFigures(const RecordShape& shape);
    std::vector<Figure> list;
    std::size_t nis = 0, rows = 0, squared_error = 0, variance = 0, standardised_error = 0;  ///< nees: 0
};

/// Turns checked steps into figures. Keeps its matrices from step to step.
class StepJudge {
public:
    StepJudge(const RecordShape& shape, const RecordFigures& figures);

    /// Writes the step's figures [figure_count], and L^-1 nu [m], S = LL', NaN in rows not observed; without
    /// innovations that is left alone. Returns what is wrong with a covariance; empty where nothing is.
    std::string judge(const CheckedStep& step, double* figures, double* whitened);

private:
    using Factor = Eigen::LLT<Eigen::MatrixXd>;

    const RecordShape& shape_;
    const RecordFigures& places_;
    std::vector<Factor> factors_;  ///< by block
    std::vector<Eigen::VectorXd> solved_;
    Factor innovation_factor_;
    Eigen::VectorXd white_;
};

}  // namespace credence
