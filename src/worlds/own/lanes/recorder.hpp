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
    /// What a RecordingTrial hands its steps on to: the pack has them already.
    struct NoTrial : OwnTrial {
        std::size_t arm() const override { return 0; }
        int poses() const override { return 0; }
        Eigen::Vector2d normal(int, int, int) const override { return {0, 0}; }
        double uniform(int, int, int) const override { return 0; }
        void step(const Vector&, const Matrix&) override {}
        void step(const Vector&, const Matrix&, const Vector&, const Matrix&) override {}
        void set(std::size_t, double) override {}
    };

    void record(const LanePack& pack, const LaneStep& step);
    /// Lane 0 of a matrix.
    Eigen::MatrixXd lane(const double* entries, int rows, int columns) const;

    int lanes_;
    NoTrial none_;
    RecordingTrial recording_;
    std::vector<double> all_series_;  ///< [series, K - 1] of lane 0
    std::size_t steps_ = 0, steps_taken_ = 0;
};

}  // namespace credence
