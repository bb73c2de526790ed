#pragma once
// One trial among landmarks by the production code, with everything that its filter held.

#include "slam/estimators/estimators.hpp"
#include "worlds/landmarks/trial.hpp"

#include "filter_samples.hpp"

namespace credence::test {

using Heading = Layout<Process::heading, any_count>;
using HeadingTruth = Truth<double, Heading::feature_capacity>;
using HeadingBelief = Belief<double, Heading::capacity>;

inline const std::vector<Estimator> all_estimators = LandmarkSettings().estimators;

/// The classical loop, walked `poses` - 1 steps.
inline LandmarkSettings classical(int poses) {
    LandmarkSettings scenario;
    scenario.poses = poses;
    return scenario;
}

/// Another loop, with its own numbers.
inline LandmarkSettings other() {
    LandmarkSettings scenario;
    scenario.poses = 40;
    scenario.loop = {17, 2.5};
    scenario.landmarks = {9, 2, 3};
    scenario.sensor = {4.5, 0.2};
    scenario.noise = {0.02, 0.3};
    return scenario;
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

/// An observer of a trial that records only beliefs.
struct Watcher {
    std::vector<Held> steps;
    const HeadingTruth* truth = nullptr;

    void keep(const Heading& layout, const HeadingBelief& belief) {
        VectorXd x(layout.size());
        x << truth->heading, truth->position.x, truth->position.y, VectorXd::Zero(layout.size() - 3);
        for (int j = 0; j < layout.features(); ++j) x.segment<2>(3 + 2 * j) << truth->feature[j].x, truth->feature[j].y;
        steps.push_back({x, mean_of(belief, layout.size()), dense(belief, layout.size())});
    }
    void started(const Heading& layout, const HeadingTruth& world, const HeadingBelief& belief) {
        truth = &world;
        keep(layout, belief);
    }
    template <class... Anything>
    void predicted(const Anything&...) {}
    void updated(int, const Heading& layout, const HeadingBelief& belief, const double*) { keep(layout, belief); }
};

struct LandmarkRun {
    std::vector<double> columns;
    MatrixXd figures;          ///< [series_count, K - 1]
    std::vector<Held> steps;
    std::vector<int> first_pose;

    double figure(const LandmarkSettings& scenario, const std::string& name, int k) const {
        const std::vector<Series> declared = landmark_series(scenario);
        const auto found =
            std::find_if(declared.begin(), declared.end(), [&](const Series& f) { return f.name == name; });
        return figures(found - declared.begin(), k - 1);
    }
};

template <class Estimating>
LandmarkRun run_with(const LandmarkView& view, const AnyNoise& noise) {
    const auto work = std::make_unique<CommonWorkspace<Heading, double, Estimating>>();
    Watcher watcher;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> figures(view.series_count, view.poses - 1);
    LandmarkRun run{std::vector<double>(column_count), {}, {}, {}};
    run_trial(view, noise, watcher, *work, run.columns.data(), figures.data());
    run.figures = figures;
    run.steps = watcher.steps;
    run.first_pose.assign(view.world.first_pose, view.world.first_pose + view.features);
    return run;
}

inline LandmarkRun run_landmarks(const LandmarkView& view, Estimator estimator, const AnyNoise& noise) {
    return with_estimator<Process::heading>(estimator, [&](auto tag) {
        return run_with<typename decltype(tag)::template type<Heading, double>>(view, noise);
    });
}

inline LandmarkRun run_landmarks(const LandmarkSettings& scenario, Estimator estimator, const AnyNoise& noise) {
    return run_landmarks(LandmarkProblem(scenario).view(), estimator, noise);
}

}  // namespace credence::test
