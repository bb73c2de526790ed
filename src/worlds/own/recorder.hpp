#pragma once
// A trial of a user's own world that records its trajectory.

#include <credence/own_trial.hpp>
#include <credence/detail/trajectory.hpp>
#include "scenario/state_series.hpp"

#include <functional>
#include <vector>

namespace credence {

/// Hands everything on to another trial, and writes what comes into a trajectory.
class RecordingTrial : public OwnTrial {
public:
    /// Adds dimensions and variables. `rows` is the most rows of an innovation.
    RecordingTrial(OwnTrial& trial, int rows, Trajectory& trajectory);

    std::size_t arm() const override { return trial_.arm(); }
    int poses() const override { return trial_.poses(); }
    Eigen::Vector2d normal(int source, int pose, int index) const override {
        return trial_.normal(source, pose, index);
    }
    double uniform(int source, int pose, int index) const override { return trial_.uniform(source, pose, index); }
    void set(std::size_t column, double value) override { trial_.set(column, value); }
    void step(const Vector& error, const Matrix& P) override;
    void step(const Vector& error, const Matrix& P, const Vector& innovation, const Matrix& S) override;

private:
    void write_state(const Vector& error, const Matrix& P);

    OwnTrial& trial_;
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
