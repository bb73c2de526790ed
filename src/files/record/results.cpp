// The empty results of a record: the same declarations as a run has.

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

/// In the order of RecordColumn.
std::vector<Column> record_columns(const RecordShape& shape) {
    const std::string unit = "unit of error squared", of = pose_block(shape) != 0 ? "the group pose" : "the whole state";
    std::vector<Column> columns{
        {"trace_P", "trace of the covariance at the last step of the trial", unit, ColumnType::real, nan},
        {"unseen", "not known of a record", "1", ColumnType::integer, nan},
        {"pose_error", "squared error of " + of + ", summed over the steps", unit, ColumnType::real, nan},
        {"nees_ratio", "mean over the steps of NEES / state dimension", "1", ColumnType::real, nan},
        {"nis_ratio", "sum of NIS over the steps / sum of measurement rows", "1", ColumnType::real, nan},
        {"mean_trace_P", "mean over the steps of the trace of the covariance", unit, ColumnType::real, nan}};
    for (Column& column : status_columns()) columns.push_back(std::move(column));
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
