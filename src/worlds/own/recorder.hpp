#pragma once
// Records the trajectory of a trial of a user's own world.

#include <credence/detail/trajectory.hpp>
#include "scenario/state_series.hpp"

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace credence {

/// Writes step after step into a trajectory. A step that has another size than the state, or that is one too many, is
/// left out: the trial itself refuses it.
class StepRecorder {
public:
    using Vector = Eigen::Ref<const Eigen::VectorXd>;
    using Matrix = Eigen::Ref<const Eigen::MatrixXd>;

    /// Adds dimensions and variables. `rows` is the most rows of an innovation.
    StepRecorder(int rows, Trajectory& trajectory);

    void step(const Vector& error, const Matrix& P);
    void step(const Vector& error, const Matrix& P, const Vector& innovation, const Matrix& S);

private:
    Trajectory& trajectory_;
    int pose_ = 0;  ///< of the last step
    bool small_state_;
    Eigen::Index rows_;  ///< of the innovations that are recorded; 0: none are
    std::size_t error_ = 0, trace_P_ = 0, covariance_ = 0, innovation_ = 0, innovation_covariance_ = 0;
};

/// Adds NEES, and NIS with its rows where trials have innovations. `series` gives the values of the steps that the
/// trial took, by place among all series.
void add_evaluations(Trajectory& trajectory, const StateSeries& all_series, Innovations innovations,
                     const std::function<std::vector<double>(std::size_t)>& series);

}  // namespace credence
