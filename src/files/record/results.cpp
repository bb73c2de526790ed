// The empty results of a record: the same declarations as a run has.

#include <credence/slam_columns.hpp>
#include <credence/text.hpp>

#include "files/record/results.hpp"

#include "base/nan.hpp"

#include <algorithm>
#include <filesystem>

namespace credence {

namespace {

/// The file's stem as a name.
std::string scenario_name(const std::string& path) {
    std::string name = std::filesystem::path(path).stem().string();
    for (char& c : name)
        if (!is_name_character(c)) c = '_';
    return name.empty() ? "record" : name;
}

std::vector<Column> record_columns(const RecordShape& shape) {
    std::vector<Column> columns = trial_columns(DeformableSettings());
    const auto describe = [&](ColumnIndex column, const std::string& long_name, const std::string& unit) {
        columns[column].long_name = long_name;
        columns[column].unit = unit;
    };
    const std::string unit = "unit of error squared";
    const bool has_pose = pose_block(shape) != 0;
    describe(column_trace_P, "trace of the covariance at the last step of the trial", unit);
    describe(column_unseen, "not known of a record", "1");
    describe(column_pose_error, std::string("squared error of ") + (has_pose ? "the block pose" : "the whole state") +
                                    ", summed over the steps", unit);
    describe(column_mean_trace_P, "mean over the steps of the trace of the covariance", unit);
    return columns;
}

ArmResults empty_arm(const ScenarioResults& results) {
    const auto steps = static_cast<std::size_t>(results.steps());
    const auto trials = static_cast<std::size_t>(results.trials);
    const auto lags = static_cast<std::size_t>(lag_count(results.scenario.poses));
    ArmResults arm;
    arm.name = "record";
    for (const Column& column : results.columns) arm.columns.emplace_back(trials, column.fill);
    for (const Series& series : results.all_series) {
        const std::size_t counts = series.role == SeriesRole::nees ? steps * coverage_level_count : 0;
        arm.totals.push_back({std::vector<ExactSum>(steps), std::vector<ExactSum>(series.integer ? 0 : steps), {},
                              ExactSum(), std::vector<std::int64_t>(counts)});
    }
    arm.products = {std::vector<ExactSum>(lags), std::vector<ExactSum>(lags), std::vector<std::int64_t>(lags)};
    const std::size_t detailed = static_cast<std::size_t>(results.detailed()) * steps;
    arm.errors.assign(detailed * static_cast<std::size_t>(results.state_size()), nan);
    arm.nees.assign(detailed, nan);
    arm.present.resize(steps);
    return arm;
}

}  // namespace

std::size_t pose_block(const RecordShape& shape) {
    const auto found = std::find_if(shape.groups.begin(), shape.groups.end(),
                                    [](const ComponentGroup& block) { return block.name == "pose"; });
    return found == shape.groups.end() ? 0 : static_cast<std::size_t>(found - shape.groups.begin());
}

ScenarioResults empty_record_results(const RecordShape& shape, const std::vector<Series>& all_series,
                                     const std::string& path) {
    ScenarioResults results;
    results.scenario.name = scenario_name(path);
    results.scenario.title = "record " + printable(path);
    results.scenario.poses = shape.steps + 1;
    results.columns = record_columns(shape);
    results.all_series = all_series;
    results.trials = shape.trials;
    results.arms.push_back(empty_arm(results));
    return results;
}

}  // namespace credence
