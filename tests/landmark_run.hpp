#pragma once
// One trial on a loop among landmarks by the production code, with everything that its filter held.

#include "slam/estimators/estimators.hpp"
#include "worlds/explore/explore.hpp"
#include "worlds/explore/single_workspace.hpp"

#include "filter_samples.hpp"
#include "landmark_loop.hpp"

namespace credence::test {

using HeadingTruth = Truth<double, ExploreLayout::feature_capacity>;
using HeadingBelief = Belief<double, ExploreLayout::capacity>;

inline const std::vector<Estimator> all_estimators = *landmark_loop(2).arms.estimators;

/// The classical loop, walked `poses` - 1 steps.
inline ExploreSettings classical(int poses) { return resolved(landmark_loop(poses)); }

/// Another loop, with its own numbers.
inline ExploreSettings other() {
    ExploreSettings scenario = landmark_loop(40, {17, 2.5, 9, 2});
    scenario.prior = 3;
    scenario.sensor.range_max = 4.5;
    scenario.sensor.sigma = 0.2;
    scenario.noise.heading = 0.02;
    scenario.noise.odometry = 0.3;
    return resolved(scenario);
}

inline AnyNoise noise_of(std::uint64_t trial) {
    const KeyedDraws<double> draws(11, trial, infinity);
    return {[=](Source source, int pose, int index) { return draws.normal(source, pose, index); },
            [=](Source source, int pose, int index) { return draws.uniform(source, pose, index); }};
}

/// The state of a trial at a pose.
struct Held {
    VectorXd truth, mean;
    MatrixXd covariance;
};

/// An observer of a trial that records beliefs, and where landmarks are first seen.
struct Watcher {
    std::vector<Held> steps;
    std::vector<int> first_pose;
    const HeadingTruth* truth = nullptr;

    void keep(const ExploreLayout& layout, const HeadingBelief& belief) {
        VectorXd x(layout.size());
        x << truth->heading, truth->position.x, truth->position.y, VectorXd::Zero(layout.size() - 3);
        for (int j = 0; j < layout.features(); ++j) x.segment<2>(3 + 2 * j) << truth->feature[j].x, truth->feature[j].y;
        steps.push_back({x, mean_of(belief, layout.size()), dense(belief, layout.size())});
    }
    void started(const ExploreLayout& layout, const HeadingTruth& world, const HeadingBelief& belief) {
        truth = &world;
        keep(layout, belief);
    }
    template <class... Anything>
    void predicted(const Anything&...) {}
    template <class... Anything>
    void priced(const Anything&...) {}
    void updated(int, const ExploreLayout& layout, const HeadingBelief& belief, const double*) {
        keep(layout, belief);
    }
    void explored(int k, const ExploreState<double>& state) {
        for (std::size_t j = 0; j < first_pose.size(); ++j)
            if (state.mapped[j]) first_pose[j] = std::min(first_pose[j], k);
    }
};

struct LandmarkRun {
    std::vector<double> columns;
    MatrixXd figures;             ///< [series_count, K - 1]
    std::vector<Held> steps;
    std::vector<int> first_pose;  ///< [M] K where never

    double figure(const ExploreSettings& scenario, const std::string& name, int k) const {
        const std::vector<Series> declared = explore_series(scenario);
        const auto found =
            std::find_if(declared.begin(), declared.end(), [&](const Series& f) { return f.name == name; });
        return figures(found - declared.begin(), k - 1);
    }
};

template <class Estimating>
LandmarkRun run_with(const ExploreSettings& scenario, const AnyNoise& noise) {
    const ExploreProblem problem(scenario);
    const ExploreView& view = problem.view();
    const auto work = std::make_unique<SingleWorkspace<Estimating>>(view);
    Watcher watcher;
    watcher.first_pose.assign(static_cast<std::size_t>(view.features), view.poses);
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> figures(view.series_count, view.poses - 1);
    LandmarkRun run{std::vector<double>(explore_column_count), {}, {}, {}};
    run_trial(view, Explorer::fixed, noise, watcher, *work, run.columns.data(), figures.data());
    run.figures = figures;
    run.steps = watcher.steps;
    run.first_pose = watcher.first_pose;
    return run;
}

inline LandmarkRun run_landmarks(const ExploreSettings& scenario, Estimator estimator, const AnyNoise& noise) {
    return with_estimator<Process::heading>(estimator, [&](auto tag) {
        return run_with<typename decltype(tag)::template type<ExploreLayout, double>>(scenario, noise);
    });
}

}  // namespace credence::test
