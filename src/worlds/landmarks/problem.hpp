#pragma once
// A scenario of the world of landmarks made ready: the tables that its equations read, computed once.

#include "worlds/landmarks/settings.hpp"
#include "worlds/landmarks/world.hpp"
#include "slam/trial/problem.hpp"

namespace credence {

/// What a trial among landmarks reads: plain numbers and pointers into a LandmarkProblem.
struct LandmarkView : CommonView {
    LandmarkParameters world;
};

/// The state that these trials estimate: with a heading and without edges.
SlamState state_of(const LandmarkSettings& scenario);

/// The per-step series, in the order in which landmarks/trial.hpp writes them: those of any SLAM trial, and whether an
/// iterated update had come to rest.
std::vector<Series> landmark_series(const LandmarkSettings& scenario);

/// Owns the tables of one validated scenario. The truth is the same bits everywhere: its geometry uses the project's
/// own sincos, and what is in sight is found as a trial finds it.
class LandmarkProblem {
public:
    explicit LandmarkProblem(const LandmarkSettings& scenario);
    LandmarkProblem(const LandmarkProblem&) = delete;
    LandmarkProblem& operator=(const LandmarkProblem&) = delete;

    const LandmarkView& view() const { return view_; }

private:
    void fill_loop(const LandmarkSettings& scenario);
    void fill_world(const LandmarkSettings& scenario);
    void fill_filter(const LandmarkSettings& scenario);

    std::vector<LoopPose> pose_;
    std::vector<Control> motion_;
    std::vector<Point> landmark_;
    std::vector<int> first_pose_;
    std::vector<Point> still_;            ///< [K, M] zeros: landmarks neither drift nor sway
    std::vector<double> coverage_bounds_;
    LandmarkView view_;
};

}  // namespace credence
