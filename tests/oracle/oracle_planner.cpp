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
    Eigen::VectorXd sigma(number_of_features(scenario));
    for (int j = 0; j < number_of_features(scenario); ++j) {
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

/// What planner.criterion makes of P; headings count planner.heading_weight in traces and eigenvalues [docs/model.md,
/// Criteria].
double cost_of(const DeformableSettings& scenario, const Eigen::MatrixXd& P) {
    const int pose = pose_dimension(scenario);
    Eigen::VectorXd root = Eigen::VectorXd::Ones(P.rows());
    if (pose == 3) root[0] = std::sqrt(scenario.planner.heading_weight);
    const Eigen::MatrixXd weighted = root.asDiagonal() * P * root.asDiagonal();
    switch (scenario.planner.criterion) {
        case Criterion::trace: break;
        case Criterion::log_det: return std::log(P.determinant());
        case Criterion::max_eigenvalue:
            return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(weighted).eigenvalues().maxCoeff();
        case Criterion::pose_trace: return weighted.topLeftCorner(pose, pose).trace();
        case Criterion::pose_log_det: return std::log(P.topLeftCorner(pose, pose).determinant());
        case Criterion::features_trace: return P.trace() - P.topLeftCorner(pose, pose).trace();
    }
    return weighted.trace();
}

/// Cost of a control from the belief at pose k-1 to pose k [docs/model.md, Controllers, greedy].
double candidate_cost(const DeformableSettings& scenario, const Belief& belief, const Control& control, int k) {
    return cost_of(scenario, expected(scenario, belief, control, k).P);
}

/// Cost of a control that `steps` - 1 others follow: the least sum of costs, after each of the steps, that any
/// sequence of them has.
double cost_ahead(const DeformableSettings& scenario, const Belief& belief, const Control& control, int k, int steps) {
    const Belief next = expected(scenario, belief, control, k);
    if (steps == 1) return cost_of(scenario, next.P);
    double least = std::numeric_limits<double>::infinity();
    for (const Control& following : candidates(scenario))
        least = std::min(least, cost_ahead(scenario, next, following, k + 1, steps - 1));
    return cost_of(scenario, next.P) + least;
}

/// Index of the choice among the costs: going through them in order, one replaces the choice when its cost is
/// <= best (1 + 1e-12), or best + 1e-11 where costs are logarithms, best being the running minimum [docs/model.md,
/// Controllers, greedy].
int greedy_choice(const DeformableSettings& scenario, const Eigen::VectorXd& cost) {
    const Criterion criterion = scenario.planner.criterion;
    const bool logarithm = criterion == Criterion::log_det || criterion == Criterion::pose_log_det;
    int choice = 0;
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < cost.size(); ++i) {
        if (cost[i] <= (logarithm ? best + 1e-11 : best * (1 + 1e-12))) choice = i;
        best = std::min(best, cost[i]);
    }
    return choice;
}


namespace {

/// Where the robot would be without noise at a length along the way from (0, 0) through the waypoints; at the last of
/// them beyond the end.
Eigen::Vector2d along_waypoints(const DeformableSettings& scenario, double length) {
    Eigen::Vector2d at(0, 0);
    for (const Point& point : scenario.waypoints) {
        const Eigen::Vector2d to(point.x, point.y);
        const double leg = (to - at).norm();
        if (length < leg) return at + length * (to - at).normalized();
        length -= leg;
        at = to;
    }
    return at;
}

/// Control for a move (2, world) of a robot with a heading: it turns into the direction of the move. A move of at most
/// 10^-9 of the longest is none.
Control control_for(const DeformableSettings& scenario, const Eigen::Vector2d& move, double heading, double longest) {
    if (move.norm() <= 1e-9 * longest) return {0, {0, 0}};
    if (scenario.process == Process::translation) return {0, {move[0], move[1]}};
    const Eigen::Vector2d v = rotation(heading).transpose() * move;
    return {std::atan2(v[1], v[0]), {v[0], v[1]}};
}

/// Moves towards a place, no farther than the longest candidate.
Control towards(const DeformableSettings& scenario, const Belief& belief, const Eigen::Vector2d& place) {
    double reach = 0;
    for (const Control& one : candidates(scenario)) reach = std::max(reach, std::hypot(one.move.x, one.move.y));
    const double heading = scenario.process == Process::heading ? belief.x[0] : 0;
    Eigen::Vector2d move = place - belief.x.segment<2>(row_of_position(scenario));
    if (move.norm() > reach) move *= reach / move.norm();
    return control_for(scenario, move, heading, reach);
}

/// Control from pose k-1 to k on the way along the waypoints. The heading without noise is that of the last move.
Control waypoint_control(const DeformableSettings& scenario, int k) {
    const double d = scenario.features.step;
    double heading = 0;
    for (int before = 1; before < k; ++before) {
        const Eigen::Vector2d move =
            along_waypoints(scenario, before * d) - along_waypoints(scenario, (before - 1) * d);
        if (move.norm() > 1e-9 * d) heading = std::atan2(move[1], move[0]);
    }
    return control_for(scenario, along_waypoints(scenario, k * d) - along_waypoints(scenario, (k - 1) * d), heading, d);
}

}  // namespace

/// Control from pose k-1 to k of a controller that does not plan [docs/model.md, Controllers].
Control baseline_control(const DeformableSettings& scenario, Controller controller, const Belief& belief, int k,
                         const Noise& noise) {
    const Eigen::VectorXd x = predicted_mean(scenario, belief.x, {}, k);
    const int M = number_of_features(scenario);
    Eigen::Vector2d centre(0, 0);
    const auto variance = [&](int j) {
        return belief.P.diagonal().segment<2>(row_of_feature(scenario, j)).sum();
    };
    double largest = 0;
    for (int j = 0; j < M; ++j) {
        centre += x.segment<2>(row_of_feature(scenario, j)) / M;
        largest = std::max(largest, variance(j));
    }
    int least_known = 0;
    while (variance(least_known) < (1 - 1e-12) * largest) ++least_known;
    switch (controller) {
        case Controller::random: {
            const std::vector<Control> list = candidates(scenario);
            return list[static_cast<std::size_t>(noise.uniform(Source::control, k, 0) *
                                                 static_cast<double>(list.size()))];
        }
        case Controller::nearest:
            return towards(scenario, belief, x.segment<2>(row_of_feature(scenario, least_known)));
        case Controller::follow: return towards(scenario, belief, centre);
        case Controller::waypoints: return waypoint_control(scenario, k);
        default: return fixed_control(scenario, k - 1);
    }
}

}  // namespace credence::oracle
