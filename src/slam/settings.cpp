#include <credence/detail/deformable_settings.hpp>

#include <algorithm>

namespace credence {

namespace {

constexpr double pi = 3.14159265358979323846;

std::vector<double> default_turns(const DeformableSettings& scenario) {
    if (scenario.process == Process::translation) return {};
    if (robot_path(scenario) == Path::straight) return {0.0};
    std::vector<double> turns;  // -pi/4 + m pi/10, m = 0 ... 5 [model.md, Controllers]
    for (int m = 0; m <= 5; ++m) turns.push_back(-pi / 4 + m * pi / 10);
    return turns;
}

}  // namespace

bool has_arm(const DeformableSettings& scenario, Controller controller) {
    return std::ranges::find(scenario.arms.controllers, controller) != scenario.arms.controllers.end();
}

DeformableSettings resolved(DeformableSettings scenario) {
    const bool heading = scenario.process == Process::heading;
    if (scenario.features.placement != Placement::given) scenario.features.count = feature_count(scenario);
    if (!scenario.planner.speeds) scenario.planner.speeds = heading ? 10 : 5;
    if (!scenario.planner.turns) scenario.planner.turns = default_turns(scenario);
    if (!scenario.planner.horizon) scenario.planner.horizon = has_arm(scenario, Controller::horizon) ? 2 : 1;
    if (!scenario.arms.estimators) scenario.arms.estimators = std::vector{heading ? Estimator::ekf : Estimator::kf};
    return scenario;
}

std::vector<Edge> edge_list(const DeformableSettings& scenario) {
    const int features = feature_count(scenario);
    std::vector<Edge> edges;
    switch (scenario.edges.graph) {
        case EdgeGraph::none: break;
        case EdgeGraph::list: edges = scenario.edges.list; break;
        case EdgeGraph::chain:
            for (int a = 0; a + 1 < features; ++a) edges.push_back({a, a + 1});
            break;
        case EdgeGraph::all:
            for (int a = 0; a < features; ++a)
                for (int b = a + 1; b < features; ++b) edges.push_back({a, b});
            break;
    }
    return edges;
}

int candidate_count(const DeformableSettings& scenario) {
    const int speeds = 2 * *scenario.planner.speeds + 1;
    if (scenario.process == Process::heading) return static_cast<int>(scenario.planner.turns->size()) * speeds;
    return robot_path(scenario) == Path::straight ? speeds : speeds * speeds;
}

Path robot_path(const DeformableSettings& scenario) {
    switch (scenario.fixed_path) {
        case FixedPath::straight: return Path::straight;
        case FixedPath::circle: return Path::circle;
        case FixedPath::as_features: break;
    }
    return scenario.features.path;
}

int feature_count(const DeformableSettings& scenario) {
    return scenario.features.count.value_or(static_cast<int>(scenario.features.positions.size()));
}

int pose_size(const DeformableSettings& scenario) { return scenario.process == Process::heading ? 3 : 2; }

int state_size(const DeformableSettings& scenario) { return pose_size(scenario) + 2 * feature_count(scenario); }

}  // namespace credence
