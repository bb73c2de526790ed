#include <credence/slam_record.hpp>

#include "base/nan.hpp"

#include <algorithm>

namespace credence {

namespace {

const std::string& described(const ComponentGroup& block) {
    static const std::string whole = "the whole state";
    return block.name == "all" ? whole : block.name;
}

/// `name`, or `name_GROUP` for a component group.
std::string of_block(const std::string& name, const ComponentGroup& block) {
    return block.name == "all" ? name : name + "_" + block.name;
}

/// rad^2 for the heading, length^2, or the sum of both.
std::string squared_error_unit(const DeformableSettings& scenario, const ComponentGroup& block) {
    if (block.name == "heading") return "rad^2";
    const bool angles = scenario.process == Process::heading && block.first == 0;
    return angles ? trace_unit(scenario) : scenario.length_unit + "^2";
}

}  // namespace

std::vector<ComponentGroup> state_blocks(const DeformableSettings& scenario) {
    const int pose = pose_size(scenario), n = state_size(scenario);
    std::vector<ComponentGroup> blocks{{"all", 0, n}, {"pose", 0, pose}};
    if (scenario.process == Process::heading) {
        blocks.push_back({"heading", 0, 1});
        blocks.push_back({"position", 1, 2});
    }
    blocks.push_back({"features", pose, n - pose});
    for (int j = 0; pose + 2 * j < n; ++j) blocks.push_back({"feature_" + std::to_string(j), pose + 2 * j, 2});
    return blocks;
}

std::vector<Component> state_components(const DeformableSettings& scenario) {
    const std::string& length = scenario.length_unit;
    std::vector<Component> components;
    if (scenario.process == Process::heading) components.push_back({"theta", "rad"});
    components.insert(components.end(), {{"r_x", length}, {"r_y", length}});
    for (std::size_t j = 0; j < scenario.features.positions.size(); ++j)
        for (const char* axis : {"_x", "_y"})
            components.push_back({std::string("f").append(std::to_string(j)).append(axis), length});
    return components;
}

std::string trace_unit(const DeformableSettings& scenario) {
    const std::string area = scenario.length_unit + "^2";
    return scenario.process == Process::heading ? area + " + rad^2" : area;
}

Charts charts_of(const DeformableSettings& scenario) {
    const std::vector<Estimator> estimators = *resolved(scenario).arms.estimators;
    const bool others = std::any_of(estimators.begin(), estimators.end(), [](Estimator estimator) {
        return estimator != Estimator::ekf && estimator != Estimator::kf;
    });
    return others ? Charts::euclidean_and_invariant : Charts::euclidean;
}

std::vector<Column> trial_columns(const DeformableSettings& scenario) {
    std::vector<Column> columns{
            {"trace_P", "trace of the covariance after the last update", trace_unit(scenario), ColumnType::real, nan},
            {"unseen", "features not seen, summed over the poses after the first", "1", ColumnType::integer, -1},
            {"pose_error", "squared error of the estimated pose, summed over all poses", trace_unit(scenario),
             ColumnType::real, nan},
            {"nees_ratio", "mean over the steps of NEES / state dimension", "1", ColumnType::real, nan},
            {"nis_ratio", "sum of NIS over the steps / sum of measurement rows", "1", ColumnType::real, nan},
            {"mean_trace_P", "mean over the steps of the trace of the covariance", trace_unit(scenario),
             ColumnType::real, nan}};
    for (Column& column : status_columns()) columns.push_back(std::move(column));
    return columns;
}

std::vector<Series> step_series(const DeformableSettings& scenario) {
    const std::vector<ComponentGroup> blocks = state_blocks(scenario);
    const int edge_rows = 2 * static_cast<int>(edge_list(scenario).size());
    std::vector<Series> all_series;
    for (const ComponentGroup& block : blocks)
        all_series.push_back({of_block("nees", block), "normalised estimation error squared of " + described(block), "1",
                           SeriesRole::nees, block.count, false, block.name, "", 0});
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
    for (const ComponentGroup& block : blocks)
        all_series.push_back({of_block("squared_error", block), "squared error of " + described(block),
                           squared_error_unit(scenario, block), SeriesRole::squared_error, block.count, false,
                           block.name, "", 0});
    for (const ComponentGroup& block : blocks)
        all_series.push_back({block.name == "all" ? "trace_P_step" : of_block("variance", block),
                           "trace of the covariance of " + described(block) + " after the update",
                           squared_error_unit(scenario, block), SeriesRole::variance, block.count, false, block.name,
                           "", 0});
    for (const auto& [name, unit] : state_components(scenario))
        all_series.push_back({"standardised_error_" + name, "error of " + name + " over its predicted standard deviation",
                           "1", SeriesRole::standardised_error, 1, false, name, "", 0});
    if (charts_of(scenario) == Charts::euclidean_and_invariant)
        for (const ComponentGroup& block : {blocks[0], blocks[1]})  // the whole state, the pose
            all_series.push_back({of_block("nees_invariant", block),
                               "NEES of " + described(block) + " with the error in the invariant chart", "1",
                               SeriesRole::nees_in_chart, block.count, false, block.name, "", 0});
    return all_series;
}

}  // namespace credence
