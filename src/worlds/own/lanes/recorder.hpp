#pragma once
// Records the trajectory of a trial that runs again, alone in lane 0 of a pack, so that it has the bits of its batch.
// The pack ends with that trial.

#include "worlds/own/lanes/view.hpp"
#include "worlds/own/recorder.hpp"

#include <vector>

namespace credence {

class LaneRecorder {
public:
    /// Adds dimensions and variables. `rows` is the most rows of an innovation, `lanes` the number of a pack.
    LaneRecorder(int rows, int lanes, Trajectory& trajectory);

    /// Runs the view's world on a pack whose steps this records.
    void run(const OwnView& view, LanePack& pack, void (*run_pack)(const OwnView& view, LanePack& pack));

    /// A series of the steps that the trial took before it failed.
    std::vector<double> series(std::size_t place) const;

private:
    /// Stands between the world's function and the engine's pack.
    struct Between : LanePack {
        LanePack& pack;
        LaneRecorder& recorder;
        Between(LanePack& whole, LaneRecorder& to) : LanePack(whole), pack(whole), recorder(to) {}
    };
    void record(const LanePack& pack, const LaneStep& step);
    /// Lane 0 of a matrix.
    Eigen::MatrixXd lane(const double* entries, int rows, int columns) const;

    int lanes_;
    StepRecorder recording_;
    std::vector<double> all_series_;  ///< [series, K - 1] of lane 0
    std::size_t steps_ = 0, steps_taken_ = 0;
};

}  // namespace credence
