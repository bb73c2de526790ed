// The empty results of a record: the same declarations as a run has.

#include "record/results.hpp"

#include <credence/record.hpp>
#include <credence/error.hpp>
#include <credence/text.hpp>

#include "base/nan.hpp"
#include "record/alike.hpp"

#include <algorithm>
#include <filesystem>

namespace credence {

namespace {

/// The file's stem as a name: that of `mine.kf.h5`, whose arm is `kf`, is `mine`.
std::string scenario_name(const std::string& path, const std::string& arm) {
    std::string name = std::filesystem::path(path).stem().string();
    if (name.size() > arm.size() + 1 && name.ends_with("." + arm)) name.resize(name.size() - arm.size() - 1);
    for (char& c : name)
        if (!is_name_character(c)) c = '_';
    return name.empty() ? "record" : name;
}

void add_empty_arm(const std::string& name, ScenarioResults& results) {
    const auto steps = static_cast<std::size_t>(results.steps()), trials = static_cast<std::size_t>(results.trials),
               detailed = static_cast<std::size_t>(results.detailed()) * steps;
    ArmResults& arm = results.arms.emplace_back();
    arm.name = name;
    clear_totals(results);
    arm.totals.cells.clear();
    for (SeriesTotals& series : arm.totals.series) series.run_sum.emplace();
    for (const Column& column : results.columns) arm.columns.in_memory().emplace_back(trials, column.fill);
    arm.errors.assign(detailed * static_cast<std::size_t>(results.state_size()), nan);
    arm.nees.assign(detailed, nan);
    arm.moments.assign(static_cast<std::size_t>(results.detailed() * results.moment_count()), nan);
    arm.totals.present.resize(steps);
}

/// The groups of a source, such as `pose, feature_1`.
std::string groups_of(const RecordShape& shape, GroupSource source) {
    std::vector<std::string> names;
    for (std::size_t b = 1; b < shape.groups.size(); ++b)
        if (shape.source(b) == source && (source != GroupSource::variances || shape.groups[b].count > 1))
            names.push_back(shape.groups[b].name);
    return joined(names);
}

/// What a record cannot show, in sentences.
std::vector<std::string> not_judged(const RecordShape& shape) {
    std::vector<std::string> sentences;
    if (shape.of_innovations)
        sentences.push_back("There is no ground truth: the verdict is on the innovations and their S, which stand for "
                            "errors and P, and says nothing of the P of the state.");
    if (!shape.known.empty())
        sentences.push_back(
            "Not in the state, because their errors and variances are 0 at every step: " + joined(shape.known) + ".");
    if (!shape.known_groups.empty())
        sentences.push_back("Groups of nothing else are left out: " + joined(shape.known_groups) + ".");
    const ComponentGroup whole = alike(shape, shape.groups[0]), pose = alike(shape, shape.groups[pose_group(shape)]);
    const auto unit_of = [&](const ComponentGroup& group) {
        return shape.components[static_cast<std::size_t>(group.component(0))].unit;
    };
    if (shape.has_errors && whole.count < shape.n)
        sentences.push_back("Squares of different units are not added: trace(P) is of the components in " +
                            unit_of(whole) + " alone, and the pose error of those in " + unit_of(pose) + ".");
    if (shape.has_variances)
        sentences.push_back("The record has variances only: each component is judged by itself, and no correlation "
                            "between components is; the log score is the sum of theirs.");
    else if (!shape.has_joint())
        sentences.push_back(
            "The record has no covariance of the whole state: correlations between its groups are not judged.");
    if (const std::string names = groups_of(shape, GroupSource::variances); !names.empty())
        sentences.push_back("Without a covariance there is no NEES of " + names + ".");
    if (shape.source(0) == GroupSource::nees && shape.has_errors)
        sentences.push_back("Of the whole state there is the NEES and nothing else.");
    if (!shape.has_errors)
        sentences.push_back(
            "The record has NEES and no errors: bias, directions and the size of the errors are not judged.");
    else if (const std::string names = groups_of(shape, GroupSource::nees); !names.empty())
        sentences.push_back("Of " + names +
                            " there is the NEES and nothing else: bias and directions are not judged by it.");
    return sentences;
}

}  // namespace

std::vector<Column> record_columns(const RecordShape& shape) {
    const std::string unit = unit_of_squares(shape, 0),
                      of = pose_group(shape) != 0 ? "the group pose" : "the whole state";
    std::vector<Column> columns{
        {"trace_P", "trace of the covariance at the last step of the trial", unit, ColumnType::real, nan},
        {unseen_column, "not known of a record", "1", ColumnType::integer, nan},
        {"pose_error", "squared error of " + of + ", summed over the steps", unit_of_squares(shape, pose_group(shape)),
         ColumnType::real, nan},
        {"nees_ratio", "mean over the steps of NEES / state dimension", "1", ColumnType::real, nan},
        {"nis_ratio", "sum of NIS over the steps / sum of measurement rows", "1", ColumnType::real, nan},
        {"mean_trace_P", "mean over the steps of the trace of the covariance", unit, ColumnType::real, nan},
        log_score_column()};
    for (const Column& own : shape.columns)
        if (own.name == unseen_column) columns[RecordColumn::unseen] = own;
        else columns.push_back(own);
    for (Column& column : status_columns()) columns.push_back(std::move(column));
    return columns;
}

ScenarioResults empty_record_results(const RecordShape& shape, const std::vector<Series>& all_series,
                                     const std::string& path, int kept_steps) {
    ScenarioResults results;
    results.scenario.name = scenario_name(path, shape.arm);
    results.scenario.title = "record " + printable(path);
    results.scenario.poses = kept_steps + 1;
    results.columns = record_columns(shape);
    results.all_series = all_series;
    results.trials = shape.trials;
    results.scenario.components = shape.components;
    results.scenario.groups = shape.groups;
    results.has_joint_covariance = shape.has_joint();
    results.not_judged = not_judged(shape);
    results.epsilon = std::max(results.epsilon, shape.covariance_epsilon);
    add_empty_arm(shape.arm, results);
    return results;
}

}  // namespace credence
