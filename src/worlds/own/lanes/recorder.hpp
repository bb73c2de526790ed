#pragma once
// Records the trajectory of a trial that runs again, alone in lane 0 of a pack, so that it has the bits of its batch.
// The pack ends with that trial.

#include "worlds/own/lanes/view.hpp"
#include "worlds/own/recorder.hpp"

#include <vector>

namespace credence {

class LaneRecorder {
public:
    /// Adds dimensions and variables. `lanes` is the number of a pack.
    LaneRecorder(const OwnView& view, int lanes, Trajectory& trajectory)
        : lanes_(lanes), recording_(view.largest_innovation, trajectory),
          all_series_(static_cast<std::size_t>(view.series_count)) {}

    /// Takes a step in that the pack has evaluated; the trial fails there unless it `goes_on`.
    void take(const LanePack& pack, const LaneStep& step, bool goes_on);

    /// A series of the steps that the trial took before it failed.
    const std::vector<double>& series(std::size_t place) const { return all_series_[place]; }

private:
    /// Lane 0 of a matrix.
    Eigen::MatrixXd lane(const double* entries, int rows, int columns) const;

    int lanes_;
    StepRecorder recording_;
    std::vector<std::vector<double>> all_series_;  ///< of lane 0
};

}  // namespace credence
