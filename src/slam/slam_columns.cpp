#include <credence/slam_columns.hpp>

#include "base/nan.hpp"

#include <algorithm>

namespace credence {

namespace {

const std::string& described(const ComponentGroup& group) {
    static const std::string whole = "the whole state";
    return group.name == "all" ? whole : group.name;
}

/// `name`, or `name_GROUP` for a part of the state.
std::string of_group(const std::string& name, const ComponentGroup& group) {
    return group.name == "all" ? name : name + "_" + group.name;
}

/// rad^2 for the heading, length^2, or the sum of both.
std::string squared_error_unit(const SlamState& state, const ComponentGroup& group) {
    if (group.name == "heading") return "rad^2";
    const bool angles = state.process == Process::heading && group.first == 0;
    return angles ? trace_unit(state) : state.length_unit + "^2";
}

}  // namespace

SlamState::SlamState(const DeformableSettings& settings)
    : process(settings.process),
      features(static_cast<int>(settings.features.positions.size())),
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
            {"unseen", "features not seen, summed over the poses after the first", "1", ColumnType::integer, -1},
            {"pose_error", "squared error of the estimated pose, summed over all poses", trace_unit(state),
             ColumnType::real, nan},
            {"nees_ratio", "mean over the steps of NEES / state dimension", "1", ColumnType::real, nan},
            {"nis_ratio", "sum of NIS over the steps / sum of measurement rows", "1", ColumnType::real, nan},
            {"mean_trace_P", "mean over the steps of the trace of the covariance", trace_unit(state),
             ColumnType::real, nan}};
    for (Column& column : status_columns()) columns.push_back(std::move(column));
    return columns;
}

std::vector<Series> step_series(const SlamState& state) {
    const std::vector<ComponentGroup> groups = state_groups(state);
    const int edge_rows = 2 * state.edges;
    std::vector<Series> all_series;
    for (const ComponentGroup& group : groups)
        all_series.push_back({of_group("nees", group), "normalised estimation error squared of " + described(group), "1",
                           SeriesRole::nees, group.count, false, group.name, "", 0});
    const auto nis = [&](const std::string& name, const std::string& of, const std::string& part,
                         const std::string& rows, int more_rows) {
        all_series.push_back({name, "normalised innovation squared of " + of, "1", SeriesRole::nis, 0, false, part, rows,
                           more_rows});
    };
    nis("nis", "all rows", "all", "nis_rows", 0);
    all_series.push_back({"nis_rows", "measurement rows", "1", SeriesRole::rows, 0, true, "all", "", 0});
    nis("nis_features", "the features' rows", "features", "nis_rows", -edge_rows);
    nis("nis_edges", "the edges' rows", "edges", "", edge_rows);
    all_series.push_back({"unseen_features", "features not seen", "1", SeriesRole::other, 0, true, "", "", 0});
    for (const ComponentGroup& group : groups)
        all_series.push_back({of_group("squared_error", group), "squared error of " + described(group),
                           squared_error_unit(state, group), SeriesRole::squared_error, group.count, false,
                           group.name, "", 0});
    for (const ComponentGroup& group : groups)
        all_series.push_back({group.name == "all" ? "trace_P_step" : of_group("variance", group),
                           "trace of the covariance of " + described(group) + " after the update",
                           squared_error_unit(state, group), SeriesRole::variance, group.count, false, group.name,
                           "", 0});
    for (const auto& [name, unit] : state_components(state))
        all_series.push_back({"standardised_error_" + name, "error of " + name + " over its predicted standard deviation",
                           "1", SeriesRole::standardised_error, 1, false, name, "", 0});
    if (charts_of(state) == Charts::euclidean_and_invariant)
        for (const ComponentGroup& group : {groups[0], groups[1]})  // the whole state, the pose
            all_series.push_back({of_group("nees_invariant", group),
                               "NEES of " + described(group) + " with the error in the invariant chart", "1",
                               SeriesRole::nees_in_chart, group.count, false, group.name, "", 0});
    return all_series;
}

}  // namespace credence
