#include "worlds/own/recorder.hpp"

#include <algorithm>

namespace credence {

namespace {

/// Whether matrices of this size are recorded; where not, a note says so.
bool is_recorded(Trajectory& trajectory, const std::string& variable, std::size_t rows) {
    if (rows <= largest_recorded_matrix) return true;
    trajectory.notes.emplace_back(
        variable + "_omitted",
        std::to_string(rows) + " rows, more than the " + std::to_string(largest_recorded_matrix) + " that are kept");
    return false;
}

/// Copies a vector, or a matrix row by row.
template <class Matrix>
void write(const Matrix& values, Eigen::Index row_size, double* out) {
    for (Eigen::Index i = 0; i < values.rows(); ++i)
        for (Eigen::Index j = 0; j < values.cols(); ++j) out[i * row_size + j] = values(i, j);
}

}  // namespace

StepRecorder::StepRecorder(int rows, Trajectory& trajectory)
    : trajectory_(trajectory),
      small_state_(is_recorded(trajectory, "covariance", trajectory.scenario.components.size())),
      rows_(is_recorded(trajectory, "innovation", static_cast<std::size_t>(rows)) ? rows : 0) {
    const std::string units = "see component_units", products = "products of component_units";
    error_ = trajectory.add({"error", "estimate - truth, after the update", units, {"pose", "component"}});
    trace_P_ = trajectory.add(
        {"trace_P", "trace of the covariance, after the update", "sum of squares of component_units", {"pose"}});
    if (small_state_)
        covariance_ = trajectory.add(
            {"covariance", "covariance, after the update", products, {"pose", "component", "component_2"}});
    if (rows_ == 0) return;
    trajectory.dimensions.push_back({"row", "row of the innovation", static_cast<std::size_t>(rows)});
    trajectory.dimensions.push_back({"row_2", "row of the innovation, along columns", static_cast<std::size_t>(rows)});
    innovation_ = trajectory.add({"innovation", "innovation", "units of its rows", {"pose", "row"}});
    innovation_covariance_ = trajectory.add({"innovation_covariance", "covariance of the innovation",
                                             "products of units of its rows", {"pose", "row", "row_2"}});
}

void StepRecorder::step(const Vector& error, const Matrix& P) {
    const auto n = static_cast<Eigen::Index>(trajectory_.scenario.components.size());
    if (++pose_ >= trajectory_.scenario.poses || error.size() != n || P.rows() != n || P.cols() != n) return;
    write(error, 1, trajectory_.at(error_, pose_));
    *trajectory_.at(trace_P_, pose_) = P.trace();
    const Eigen::MatrixXd whole = P.selfadjointView<Eigen::Lower>();
    if (small_state_) write(whole, n, trajectory_.at(covariance_, pose_));
}

void StepRecorder::step(const Vector& error, const Matrix& P, const Vector& innovation, const Matrix& S) {
    step(error, P);
    if (pose_ < trajectory_.scenario.poses && innovation.size() <= rows_ && S.rows() == innovation.size() &&
        S.cols() == S.rows()) {
        const Eigen::MatrixXd whole = S.selfadjointView<Eigen::Lower>();
        write(innovation, 1, trajectory_.at(innovation_, pose_));
        write(whole, rows_, trajectory_.at(innovation_covariance_, pose_));
    }
}

void add_evaluations(Trajectory& trajectory, const StateSeries& all_series, Innovations innovations,
                     const std::function<std::vector<double>(std::size_t)>& series) {
    const auto add = [&](TrajectoryVariable variable, std::size_t place) {
        const std::vector<double> steps = series(place);
        std::copy(steps.begin(), steps.end(), trajectory.at(trajectory.add(std::move(variable)), 1));
    };
    add({"nees", "normalised estimation error squared of the whole state", "1", {"pose"}}, 0);
    if (innovations == Innovations::none) return;
    add({"nis", "normalised innovation squared over all rows", "1", {"pose"}}, all_series.nis);
    add({"rows", "measurement rows of the update", "1", {"pose"}, TrajectoryNumbers::integer}, all_series.rows);
}

}  // namespace credence
