#include "worlds/own/lanes/recorder.hpp"

namespace credence {

LaneRecorder::LaneRecorder(int rows, int lanes, Trajectory& trajectory)
    : lanes_(lanes), recording_(rows, trajectory) {}

void LaneRecorder::run(const OwnView& view, LanePack& pack, void (*run_pack)(const OwnView&, LanePack&)) {
    Between between(pack, *this);
    between.normal = [](const LanePack& self, int source, int pose, int index, double* draw) {
        const LanePack& pack = static_cast<const Between&>(self).pack;
        pack.normal(pack, source, pose, index, draw);
    };
    between.uniform = [](const LanePack& self, int source, int pose, int index, double* draw) {
        const LanePack& pack = static_cast<const Between&>(self).pack;
        pack.uniform(pack, source, pose, index, draw);
    };
    between.step = [](LanePack& self, const LaneStep& step) {
        LanePack& pack = static_cast<Between&>(self).pack;
        LaneRecorder& recorder = static_cast<Between&>(self).recorder;
        recorder.record(pack, step);
        const bool goes_on = pack.step(pack, step);
        self.steps = pack.steps;
        if (goes_on) ++recorder.steps_taken_;
        return goes_on;
    };
    run_pack(view, between);
    steps_ = static_cast<std::size_t>(view.poses - 1);
    all_series_.resize(static_cast<std::size_t>(view.series_count) * steps_);
    for (std::size_t cell = 0; cell < all_series_.size(); ++cell)
        all_series_[cell] = pack.all_series[cell * static_cast<std::size_t>(lanes_)];
}

std::vector<double> LaneRecorder::series(std::size_t place) const {
    const auto first = all_series_.begin() + static_cast<std::ptrdiff_t>(place * steps_);
    return {first, first + static_cast<std::ptrdiff_t>(steps_taken_)};
}

void LaneRecorder::record(const LanePack& pack, const LaneStep& step) {
    const Eigen::VectorXd error = lane(step.error, pack.state_size, 1);
    const Eigen::MatrixXd P = lane(step.P, pack.state_size, pack.state_size);
    const Eigen::VectorXd innovation = lane(step.innovation, step.rows, 1);
    if (innovation.array().isNaN().all())
        recording_.step(error, P);
    else
        recording_.step(error, P, innovation, lane(step.S, step.rows, step.rows));
}

Eigen::MatrixXd LaneRecorder::lane(const double* entries, int rows, int columns) const {
    Eigen::MatrixXd matrix(rows, columns);
    for (Eigen::Index i = 0; i < matrix.size(); ++i) matrix(i) = entries[i * lanes_];
    return matrix;
}

}  // namespace credence
