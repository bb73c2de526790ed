#include <credence/detail/deformable_settings.hpp>

#include <credence/error.hpp>
#include <credence/text.hpp>

#include "base/wording.hpp"
#include "worlds/values.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

void check_placement(const FeatureSettings& features) {
    const std::size_t positions = features.positions.size();
    if (features.placement == Placement::given && features.count && *features.count != static_cast<int>(positions))
        throw invalid_value("features.count", std::to_string(*features.count),
                            "features.positions gives " + std::to_string(positions),
                            "Leave it out, or set features.placement=box or ring");
    if (features.placement == Placement::ring && features.radius_min > features.radius_max)
        throw invalid_value("features.radius_max", to_text(features.radius_max),
                            "below features.radius_min=" + to_text(features.radius_min), "Give at least that");
}

void check_sensor(const SensorSettings& sensor) {
    if (!(sensor.range_min < sensor.range_max))
        throw invalid_value("sensor.range_max", to_text(sensor.range_max),
                            "must be above sensor.range_min=" + to_text(sensor.range_min),
                            "Give a range that is not empty");
    if (sensor.noise == RangeNoise::constant) {
        if (!has_variance(sensor.sigma))
            throw invalid_value("sensor.sigma", to_text(sensor.sigma), "it makes S singular",
                                "Give a standard deviation " + above_least);
        return;
    }
    if (std::isinf(sensor.range_max))
        throw invalid_value("sensor.range_max", "inf", "ranged noise grows up to range_max",
                            "Give a finite range or sensor.noise=constant");
    if (!has_variance(sensor.sigma_near))
        throw invalid_value("sensor.sigma_near", to_text(sensor.sigma_near), "it makes S singular",
                            "Give a standard deviation " + above_least);
    if (sensor.sigma_far < sensor.sigma_near)
        throw invalid_value(
            "sensor.sigma_far", to_text(sensor.sigma_far),
            "below sensor.sigma_near=" + to_text(sensor.sigma_near) + " it would turn negative far away",
            "Give at least sigma_near");
}

/// A believed sigma of 0 is refused where it makes P or S singular [docs/model.md, What is refused]; `otherwise` is
/// what else would make it harmless.
void check_believed(const char* key, double sigma, double factor, bool harmful, const std::string& why,
                    const std::string& otherwise) {
    if (!harmful || has_variance(sigma * factor)) return;
    if (!has_variance(sigma))
        throw invalid_value(std::string("noise.") + key, to_text(sigma), why,
                            "Give a standard deviation " + above_least + ", or " + otherwise);
    const std::string name = std::string("filter.") + (std::string(key) == "deformation" ? "edges" : key);
    throw invalid_value(name, to_text(factor), why, "Give a larger factor, or " + otherwise);
}

void check_noise(const DeformableSettings& s) {
    const bool heading = s.process == Process::heading;
    check_believed("heading", s.noise.heading, s.filter.heading, heading && !has_variance(s.noise.initial_heading),
                   "the heading's variance would stay 0 and P singular", "set noise.initial_heading " + above_least);
    check_believed("odometry", s.noise.odometry, s.filter.odometry, !has_variance(s.noise.initial_position),
                   "the position's variance would stay 0 and P singular", "set noise.initial_position " + above_least);
    check_believed("deformation", s.noise.deformation, s.filter.edges, !edge_list(s).empty(),
                   "edges believed exact make S or P singular", "set edges.graph=none");
    for (const auto& [name, factor] : {std::pair{"filter.measurement", s.filter.measurement},
                                       std::pair{"filter.covariance", s.filter.covariance}})
        if (!has_variance(factor))
            throw invalid_value(name, to_text(factor), "it makes S or P singular", "Give a factor " + above_least);
    if (!heading && s.noise.initial_heading > 0)
        throw invalid_value("noise.initial_heading", to_text(s.noise.initial_heading),
                            "the translation model has no heading", "Set it to 0 or use model.process=heading");
}

void check_edges(const DeformableSettings& s) {
    const int features = feature_count(s);
    for (const Edge& edge : s.edges.list)
        if (edge.to >= features)
            throw invalid_value(
                "edges.graph", graph_text(s.edges), "the features are " + std::to_string(features) + ", counted from 0",
                features == 1 ? "Set it to none" : "Name features 0 to " + std::to_string(features - 1));
}

void check_horizon(const DeformableSettings& s) {
    const DeformableSettings filled = resolved(s);
    const int steps = *filled.planner.horizon, candidates = candidate_count(filled);
    if (steps > 1 && !has_arm(s, Controller::horizon))
        throw invalid_value("planner.horizon", std::to_string(steps),
                            "no arm plans ahead: arms.controllers=" +
                                names_text(s.arms.controllers, controller_names()),
                            "Add horizon to arms.controllers, or leave planner.horizon out");
    const double sequences = std::pow(candidates, steps);
    if (sequences > largest_sequence_count)
        throw invalid_value("planner.horizon", std::to_string(steps),
                            std::to_string(candidates) + " candidates make " + to_text(sequences) +
                                " sequences, above " + to_text(largest_sequence_count),
                            "Give fewer steps, planner.speeds or planner.turns");
}

void check_planner(const DeformableSettings& s) {
    const bool heading = s.process == Process::heading;
    if (s.planner.turns && s.planner.turns->empty() && heading)
        throw invalid_value("planner.turns", "none", "the heading model needs at least one", "Give turns in radians");
    if (s.planner.turns && !s.planner.turns->empty() && !heading)
        throw invalid_value("planner.turns", turns_text(s.planner.turns), "the translation model does not turn",
                            "Set it to none");
    check_horizon(s);
}

void check_waypoints(const DeformableSettings& s) {
    const std::string controllers = names_text(s.arms.controllers, controller_names());
    const bool followed = has_arm(s, Controller::waypoints);
    if (followed && s.waypoints.empty())
        throw invalid_value("arms.controllers", controllers, "there are no waypoints", "Give control.waypoints");
    if (!followed && !s.waypoints.empty())
        throw invalid_value("control.waypoints", positions_text(s.waypoints),
                            "no arm moves along them: arms.controllers=" + controllers,
                            "Add waypoints to arms.controllers, or leave control.waypoints out");
}

void check_arms(const DeformableSettings& s) {
    const std::string process = s.process == Process::heading ? "heading" : "translation";
    const std::vector<Estimator> asked = *resolved(s).arms.estimators;
    const bool all_fit_the_other =
        std::ranges::none_of(asked, [&](Estimator one) { return process_of(one) == s.process; });
    const std::string other = s.process == Process::heading ? "translation" : "heading";
    const std::string otherwise = all_fit_the_other ? ", or set model.process=" + other : "";
    for (const Estimator estimator : asked)
        if (process_of(estimator) != s.process)
            throw invalid_value(
                "arms.estimators", names_text(asked, estimator_names()),
                estimator_names()[static_cast<std::size_t>(estimator)] + " is not for model.process=" + process,
                "Give some of " + joined(estimators_for(s.process)) + otherwise);
    std::vector<std::string> names;  // of every arm there is, whichever are run
    for (const std::string& controller : controller_names())
        for (const std::string& estimator : estimator_names()) names.push_back(controller + "." + estimator);
    for (const auto& [key, numbers] :
         {std::pair{"published.trace_P", &s.published.trace_P}, std::pair{"published.unseen", &s.published.unseen},
          std::pair{"published.pose_error", &s.published.pose_error}})
        for (const PublishedNumber& number : *numbers)
            if (std::find(names.begin(), names.end(), number.arm) == names.end())
                throw invalid_value(key, published_text(*numbers), "'" + number.arm + "' is not an arm",
                                    did_you_mean(number.arm, names) + "Name arms such as " + joined(names));
}

}  // namespace

void validate(const DeformableSettings& scenario) {
    check_placement(scenario.features);
    check_sensor(scenario.sensor);
    check_edges(scenario);
    check_noise(scenario);
    check_planner(scenario);
    check_waypoints(scenario);
    check_arms(scenario);
}

std::vector<Arm> arms_of(const DeformableSettings& scenario) {
    std::vector<Arm> arms;
    for (const Controller controller : scenario.arms.controllers)
        for (const Estimator estimator : *scenario.arms.estimators) arms.push_back({controller, estimator});
    for (int planner = 0; planner < static_cast<int>(scenario.arms.planners.size()); ++planner)
        for (const Estimator estimator : *scenario.arms.estimators)
            arms.push_back({Controller::fixed, estimator, planner});
    return arms;
}

std::string arm_name(const DeformableSettings& scenario, const Arm& arm) {
    const std::string controller = arm.planner < 0 ? controller_names()[static_cast<std::size_t>(arm.controller)]
                                                   : scenario.arms.planners[static_cast<std::size_t>(arm.planner)].name;
    return controller + "." + estimator_names()[static_cast<std::size_t>(arm.estimator)];
}

}  // namespace credence
