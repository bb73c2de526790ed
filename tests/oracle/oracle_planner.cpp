// Controllers of the oracle: the fixed path, and the planners by brute force. Nomenclature: oracle.hpp.

#include "oracle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace credence::oracle {

/// The path that the robot follows: control.path, or the features' own [docs/model.md, Controllers].
Path path_of_robot(const DeformableSettings& scenario) {
    switch (scenario.fixed_path) {
        case FixedPath::straight: return Path::straight;
        case FixedPath::circle: return Path::circle;
        case FixedPath::as_features: break;
    }
    return scenario.features.path;
}

/// Control of the fixed path from pose k to k+1. Straight: v = (d, 0). Circle, heading: omega = delta,
/// v = d (cos delta, sin delta) in the body frame. Circle, translation: v = d (cos(phi_k + delta), sin(phi_k + delta))
/// in the world frame. Still: nothing [docs/model.md, Controllers].
Control fixed_control(const DeformableSettings& scenario, int k) {
    const double d = scenario.features.step, delta = scenario.features.turn;
    const double phi = delta / 2 + k * delta;
    switch (path_of_robot(scenario)) {
        case Path::straight: return {0, {d, 0}};
        case Path::circle:
            if (scenario.process == Process::heading)
                return {delta, {d * std::cos(delta), d * std::sin(delta)}};
            return {0, {d * std::cos(phi + delta), d * std::sin(phi + delta)}};
        case Path::still: break;
    }
    return {0, {0, 0}};
}

namespace {

/// Translation model: v = (s, 0) on the straight path, v = (a, b), a outer, on the circle and still.
std::vector<Control> candidates_of_translation(const DeformableSettings& scenario) {
    const int speeds = scenario.planner.speeds.value_or(5);
    const double d = scenario.features.step;
    std::vector<Control> list;
    for (int i = -speeds; i <= speeds; ++i) {
        const double a = i / 5.0 * d;
        if (path_of_robot(scenario) == Path::straight) {
            list.push_back({0, {a, 0}});
            continue;
        }
        for (int l = -speeds; l <= speeds; ++l) {
            const double b = l / 5.0 * d;
            list.push_back({0, {a, b}});
        }
    }
    return list;
}

/// Heading model: v = s (cos omega, sin omega) in the body frame, turns omega outer, speeds s inner.
std::vector<Control> candidates_of_heading(const DeformableSettings& scenario) {
    const int speeds = scenario.planner.speeds.value_or(10);
    const double d = scenario.features.step, pi = std::numbers::pi;
    std::vector<double> turns;
    if (scenario.planner.turns) {
        turns = *scenario.planner.turns;
    } else if (path_of_robot(scenario) == Path::straight) {
        turns = {0};
    } else {
        for (int m = 0; m <= 5; ++m) turns.push_back(-pi / 4 + m * pi / 10);
    }
    std::vector<Control> list;
    for (const double omega : turns) {
        for (int i = -speeds; i <= speeds; ++i) {
            const double s = i / 5.0 * d;
            list.push_back({omega, {s * std::cos(omega), s * std::sin(omega)}});
        }
    }
    return list;
}

}  // namespace

/// Candidates of the greedy planner, in the order of the table of [docs/model.md, Controllers], for the robot's path.
std::vector<Control> candidates(const DeformableSettings& scenario) {
    return scenario.process == Process::heading ? candidates_of_heading(scenario) : candidates_of_translation(scenario);
}

/// The belief that a control is expected to lead to from pose k-1 to pose k: predict, gate and take sigma at the
/// predicted mean, update the covariance; the mean stays the predicted one. What is in range is assumed to be detected;
/// filter.covariance has no part in it [docs/model.md, Controllers, greedy].
Belief expected(const DeformableSettings& scenario, const Belief& belief, const Control& control, int k) {
    const Belief prior = predict(scenario, belief, control, k);
    std::vector<bool> seen;
    Eigen::VectorXd sigma(feature_count(scenario));
    for (int j = 0; j < feature_count(scenario); ++j) {
        const Eigen::Vector2d r = prior.x.segment<2>(row_of_position(scenario));
        const Eigen::Vector2d f = prior.x.segment<2>(row_of_feature(scenario, j));
        const double q = (f - r).norm();
        seen.push_back(in_range(scenario, q));
        sigma[j] = scenario.filter.measurement * measurement_sigma(scenario, q);
    }
    const Prediction prediction = predicted_measurements(scenario, prior.x, seen, sigma);
    if (prediction.N.size() == 0) return prior;
    return {prior.x, correct(prior.P, prediction).P};
}

/// Cost of a control from the belief at pose k-1 to pose k: trace(P) there [docs/model.md, Controllers, greedy].
double candidate_cost(const DeformableSettings& scenario, const Belief& belief, const Control& control, int k) {
    return expected(scenario, belief, control, k).P.trace();
}

/// Cost of a control that `steps` - 1 others follow: the least sum of trace(P), after each of the steps, that any
/// sequence of them has.
double cost_ahead(const DeformableSettings& scenario, const Belief& belief, const Control& control, int k, int steps) {
    const Belief next = expected(scenario, belief, control, k);
    if (steps == 1) return next.P.trace();
    double least = std::numeric_limits<double>::infinity();
    for (const Control& following : candidates(scenario))
        least = std::min(least, cost_ahead(scenario, next, following, k + 1, steps - 1));
    return next.P.trace() + least;
}

/// Index of the choice among the costs: going through them in order, one replaces the choice when its cost is
/// <= best (1 + 1e-12), best being the running minimum [docs/model.md, Controllers, greedy].
int greedy_choice(const Eigen::VectorXd& cost) {
    int choice = 0;
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < cost.size(); ++i) {
        if (cost[i] <= best * (1 + 1e-12)) choice = i;
        best = std::min(best, cost[i]);
    }
    return choice;
}

}  // namespace credence::oracle
