#include "worlds/own/lanes/recorder.hpp"

namespace credence {

void LaneRecorder::take(const LanePack& pack, const LaneStep& step, bool goes_on) {
    const Eigen::VectorXd error = lane(step.error, pack.state_size, 1);
    const Eigen::MatrixXd P = lane(step.P, pack.state_size, pack.state_size);
    const Eigen::VectorXd innovation = lane(step.innovation, step.rows, 1);
    if (innovation.array().isNaN().all())
        recording_.step(error, P);
    else
        recording_.step(error, P, innovation, lane(step.S, step.rows, step.rows));
    const auto steps = static_cast<std::size_t>(pack.poses - 1), k = static_cast<std::size_t>(pack.steps - 1);
    for (std::size_t f = 0; goes_on && f < all_series_.size(); ++f)
        all_series_[f].push_back(pack.all_series[(f * steps + k) * static_cast<std::size_t>(lanes_)]);
}

Eigen::MatrixXd LaneRecorder::lane(const double* entries, int rows, int columns) const {
    Eigen::MatrixXd matrix(rows, columns);
    for (Eigen::Index i = 0; i < matrix.size(); ++i) matrix(i) = entries[i * lanes_];
    return matrix;
}

}  // namespace credence
