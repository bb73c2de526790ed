#include "worlds/landmarks/problem.hpp"

#include "scenario/state_series.hpp"

#include <algorithm>

namespace credence {

SlamState state_of(const LandmarkSettings& scenario) {
    SlamState state;
    state.features = scenario.landmarks.count;
    state.length_unit = scenario.length_unit;
    state.estimators = scenario.estimators;
    return state;
}

std::vector<Series> landmark_series(const LandmarkSettings& scenario) {
    std::vector<Series> all_series = step_series(state_of(scenario));
    all_series.push_back({"unsettled_updates", "iterated updates whose last pass still moved the mean", "1",
                       SeriesRole::other, 0, true, "", "", 0});
    return all_series;
}

LandmarkProblem::LandmarkProblem(const LandmarkSettings& scenario) {
    const SlamState state = state_of(scenario);
    view_.poses = scenario.poses;
    view_.features = scenario.landmarks.count;
    view_.state_size = state.size();
    const std::vector<ComponentGroup> groups = state_groups(state);
    coverage_bounds_ = coverage_bounds(groups);
    view_.group_count = static_cast<int>(groups.size());
    view_.coverage_bounds = coverage_bounds_.data();
    view_.charts = charts_of(state);
    set_budget(view_, scenario.budget);
    view_.series_count = static_cast<int>(landmark_series(scenario).size());
    fill_loop(scenario);
    fill_world(scenario);
    fill_filter(scenario);
}

/// theta_k = theta_{k-1} + omega, r_k = r_{k-1} + R(theta_{k-1}) v.
void LandmarkProblem::fill_loop(const LandmarkSettings& scenario) {
    const double turn = 2 * pi / scenario.loop.sides;
    const std::size_t steps = static_cast<std::size_t>(scenario.poses - 1);
    motion_.assign(steps, {turn, {scenario.loop.step, 0}});
    pose_.resize(steps + 1);
    for (std::size_t k = 1; k <= steps; ++k) {
        const LoopPose& before = pose_[k - 1];
        const Point move = polar(scenario.loop.step, before.heading);
        pose_[k] = {before.heading + turn, {before.position.x + move.x, before.position.y + move.y}};
    }
}

void LandmarkProblem::fill_world(const LandmarkSettings& scenario) {
    const Rotation<double> half_turn = rotation(pi / scenario.loop.sides);
    const double radius = scenario.loop.step / (2 * half_turn.sine);
    const Point centre{scenario.loop.step / 2, radius * half_turn.cosine};
    for (int j = 0; j < scenario.landmarks.count; ++j) {
        const double offset = j % 2 == 0 ? scenario.landmarks.offset : -scenario.landmarks.offset;
        const Point arm = polar(radius + offset, 2 * pi * j / scenario.landmarks.count);
        landmark_.push_back({centre.x + arm.x, centre.y + arm.y});
    }
    set_range(view_.sensor, 0, scenario.sensor.range_max);
    view_.sensor.sigma = scenario.sensor.sigma;
    for (const Point& landmark : landmark_) {
        const auto sees = [&](const LoopPose& pose) {
            return in_range(view_.sensor, squared_range(broadcast<double>(pose.position), broadcast<double>(landmark)));
        };
        first_pose_.push_back(static_cast<int>(std::find_if(pose_.begin(), pose_.end(), sees) - pose_.begin()));
    }
    view_.world = {pose_.data(), motion_.data(), landmark_.data(), first_pose_.data(), scenario.noise.heading,
                   scenario.noise.odometry, scenario.landmarks.prior};
}

void LandmarkProblem::fill_filter(const LandmarkSettings& scenario) {
    still_.resize(pose_.size() * landmark_.size());
    FilterParameters& filter = view_.filter;
    filter.features = view_.features;
    filter.translation = still_.data();
    filter.sway_increment = still_.data();
    filter.variance_heading = scenario.noise.heading * scenario.noise.heading;
    filter.variance_odometry = scenario.noise.odometry * scenario.noise.odometry;
}

}  // namespace credence
