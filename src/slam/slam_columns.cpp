#include <credence/slam_columns.hpp>

#include "base/nan.hpp"
#include "scenario/state_series.hpp"

#include <algorithm>

namespace credence {

namespace {

/// rad^2 for the heading, length^2, or the sum of both.
std::string squared_error_unit(const SlamState& state, const ComponentGroup& group) {
    if (group.name == "heading") return "rad^2";
    const bool angles = state.process == Process::heading && group.first == 0;
    return angles ? trace_unit(state) : state.length_unit + "^2";
}

}  // namespace

SlamState::SlamState(const DeformableSettings& settings)
    : process(settings.process),
      features(feature_count(settings)),
      edges(static_cast<int>(edge_list(settings).size())),
      length_unit(settings.length_unit),
      estimators(*resolved(settings).arms.estimators) {}

std::vector<ComponentGroup> state_groups(const SlamState& state) {
    const int pose = state.pose_size(), n = state.size();
    std::vector<ComponentGroup> groups{{"all", 0, n}, {"pose", 0, pose}};
    if (state.process == Process::heading) {
        groups.push_back({"heading", 0, 1});
        groups.push_back({"position", 1, 2});
    }
    groups.push_back({"features", pose, n - pose});
    for (int j = 0; pose + 2 * j < n; ++j) groups.push_back({"feature_" + std::to_string(j), pose + 2 * j, 2});
    return groups;
}

std::vector<Component> state_components(const SlamState& state) {
    const std::string& length = state.length_unit;
    std::vector<Component> components;
    if (state.process == Process::heading) components.push_back({"theta", "rad"});
    components.insert(components.end(), {{"r_x", length}, {"r_y", length}});
    for (int j = 0; j < state.features; ++j)
        for (const char* axis : {"_x", "_y"})
            components.push_back({std::string("f").append(std::to_string(j)).append(axis), length});
    return components;
}

std::string trace_unit(const SlamState& state) {
    const std::string area = state.length_unit + "^2";
    return state.process == Process::heading ? area + " + rad^2" : area;
}

Charts charts_of(const SlamState& state) {
    const bool others = std::any_of(state.estimators.begin(), state.estimators.end(), [](Estimator estimator) {
        return estimator != Estimator::ekf && estimator != Estimator::kf;
    });
    return others ? Charts::euclidean_and_invariant : Charts::euclidean;
}

std::vector<Column> trial_columns(const SlamState& state) {
    std::vector<Column> columns{
            {"trace_P", "trace of the covariance after the last update", trace_unit(state), ColumnType::real, nan},
            {"unseen", "features not seen, summed over the poses after the first", "1", ColumnType::integer, -1,
             {.sweep = false}},
            {"pose_error", "squared error of the estimated pose, summed over all poses", trace_unit(state),
             ColumnType::real, nan, {.sweep = false}},
            {"nees_ratio", "mean over the steps of NEES / state dimension", "1", ColumnType::real, nan,
             {.sweep_pairs = false}},
            {"nis_ratio", "sum of NIS over the steps / sum of measurement rows", "1", ColumnType::real, nan,
             {.sweep_pairs = false}},
            {"mean_trace_P", "mean over the steps of the trace of the covariance", trace_unit(state),
             ColumnType::real, nan, {false, false, false}},
            log_score_column(),
            {"path_length", "length of the robot's true path", state.length_unit, ColumnType::real, nan,
             {false, false, false}}};
    for (Column& column : status_columns()) columns.push_back(std::move(column));
    return columns;
}

std::vector<Series> step_series(const SlamState& state) {
    const std::vector<ComponentGroup> groups = state_groups(state);
    const UnitOf unit_of = [&](const ComponentGroup& group) { return squared_error_unit(state, group); };
    const int edge_rows = 2 * state.edges;
    std::vector<Series> all;
    add_nees(all, groups);
    add_nis(all);
    all.push_back({"nis_features", "normalised innovation squared of the features' rows", "1", SeriesRole::nis, 0,
                   false, "features", "nis_rows", -edge_rows});
    all.push_back({"nis_edges", "normalised innovation squared of the edges' rows", "1", SeriesRole::nis, 0, false,
                   "edges", "", edge_rows});
    all.push_back({"unseen_features", "features not seen", "1", SeriesRole::other, 0, true, "", "", 0});
    add_squared_errors(all, groups, unit_of);
    add_variances(all, groups, unit_of, " after the update");
    add_standardised_errors(all, state_components(state));
    if (charts_of(state) == Charts::euclidean_and_invariant)
        for (const ComponentGroup& group : {groups[0], groups[1]})  // the whole state, the pose
            all.push_back({of_group("nees_invariant", group),
                           "NEES of " + described(group) + " with the error in the invariant chart", "1",
                           SeriesRole::nees_in_chart, group.count, false, group.name, "", 0});
    return all;
}

}  // namespace credence
