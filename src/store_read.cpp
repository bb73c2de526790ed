#include <credence/store.hpp>

#include <credence/ini.hpp>
#include <credence/text.hpp>

#include "hdf5_read.hpp"
#include "store_evidence.hpp"
#include "store_format.hpp"
#include "store_sums.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

using hdf5::Dataset;
using hdf5::Error;
using hdf5::Extents;
using hdf5::Handle;

/// Throws unless the group holds exactly what it should.
void require_links(const Handle& group, std::vector<std::string> expected) {
    std::vector<std::string> found = hdf5::link_names(group);
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    std::vector<std::string> missing, foreign;
    std::set_difference(expected.begin(), expected.end(), found.begin(), found.end(), std::back_inserter(missing));
    std::set_difference(found.begin(), found.end(), expected.begin(), expected.end(), std::back_inserter(foreign));
    if (!missing.empty()) throw Error(hdf5::place_of(group, missing.front()), "is missing");
    if (!foreign.empty()) throw Error(hdf5::place_of(group, foreign.front()), "does not belong here");
}

/// Reads a coordinate that must count from `first`, and returns its length.
template <class T>
hsize_t read_numbered(const Handle& group, const std::string& name, T first) {
    const Dataset dataset(group, name);
    if (dataset.extents().size() != 1) throw Error(dataset.place(), "is not a list of numbers");
    for (const T value : dataset.read<T>())
        if (value != first++) throw Error(dataset.place(), "does not count on by one");
    return dataset.extents()[0];
}

template <class T>
std::vector<double> read_values(const Handle& group, const std::string& name, const Extents& extents) {
    const std::vector<T> values = read_as<T>(group, name, extents);
    return {values.begin(), values.end()};
}

std::vector<double> read_column(const Handle& group, const Column& column, hsize_t trials) {
    switch (column.type) {
        case ColumnType::real: return read_values<double>(group, column.name, {trials});
        case ColumnType::integer: return read_values<std::int32_t>(group, column.name, {trials});
        case ColumnType::status: break;
    }
    std::vector<double> values = read_values<std::int8_t>(group, column.name, {trials});
    for (const double value : values)
        if (value < 0 || value >= static_cast<double>(status_names().size()))
            throw Error(hdf5::place_of(group, column.name), "holds " + to_text(value) + ", which is no status");
    return values;
}

/// Names of the datasets that an arm's group holds.
std::vector<std::string> arm_links(const ScenarioResults& results) {
    std::vector<std::string> names{"trial", "step", "part"};
    for (const Column& column : results.columns) names.push_back(column.name);
    for (const Figure& figure : results.figures) {
        names.push_back(figure.name + "_total");
        if (!figure.integer) names.push_back(figure.name + "_square_total");
        names.push_back(figure.name + "_run_square_total");
    }
    const std::vector<std::string> evidence = evidence_links(results);
    names.insert(names.end(), evidence.begin(), evidence.end());
    return names;
}

/// Throws where the totals do not hold as many trials as the columns say did not fail.
void check_counted(const Handle& group, const ScenarioResults& results, const ArmResults& arm) {
    for (std::size_t c = 0; c < results.columns.size(); ++c) {
        if (results.columns[c].type != ColumnType::status) continue;
        const auto counted = std::count_if(arm.columns[c].begin(), arm.columns[c].end(), [](double status) {
            return !failed(static_cast<Status>(static_cast<int>(status)));
        });
        if (counted != arm.counted)
            throw Error(hdf5::attribute_place(group, "counted_trials"),
                        "is " + std::to_string(arm.counted) + ", but " + std::to_string(counted) +
                            " trials did not fail");
    }
}

/// `trials` is unknown (-1) until the first arm has told it.
ArmResults read_arm(const Handle& scenario_group, const std::string& name, ScenarioResults& results) {
    const Handle group = hdf5::open_group(scenario_group, name);
    require_links(group, arm_links(results));
    const hsize_t trials = read_numbered<std::int64_t>(group, "trial", 0);
    const hsize_t steps = read_numbered<std::int32_t>(group, "step", 1);
    const hsize_t parts = read_numbered<std::int32_t>(group, "part", 0);
    if (results.trials < 0) results.trials = static_cast<std::int64_t>(trials);
    Dataset(group, "trial").require_extents({static_cast<hsize_t>(results.trials)});
    Dataset(group, "step").require_extents({static_cast<hsize_t>(results.steps())});
    if (parts == 0) throw Error(hdf5::place_of(group, "part"), "is empty");

    ArmResults arm;
    arm.name = name;
    arm.counted = hdf5::read_number<std::int64_t>(group, "counted_trials");
    for (const Column& column : results.columns) arm.columns.push_back(read_column(group, column, trials));
    for (const Figure& figure : results.figures) {
        const std::string total = figure.name + "_total", square = figure.name + "_square_total";
        FigureTotals totals;
        totals.sum = figure.integer ? read_whole_sums(group, total, steps) : read_sums(group, total, {steps, parts});
        if (!figure.integer) totals.square_sum = read_sums(group, square, {steps, parts});
        totals.run_square_sum = read_sums(group, figure.name + "_run_square_total", {parts}).front();
        arm.totals.push_back(std::move(totals));
    }
    check_counted(group, results, arm);
    read_evidence(group, results, parts, arm);
    return arm;
}

ScenarioResults read_scenario_results(const Handle& root, const std::string& name, const std::string& path) {
    const Handle group = hdf5::open_group(root, name);
    const std::string origin = path + ": " + hdf5::attribute_place(group, "scenario");
    const Scenario scenario = read_scenario_text(hdf5::read_text(group, "scenario"), origin, "scenario");
    const auto agree = [&](const std::string& attribute, const std::string& found, const std::string& expected) {
        if (found != expected)
            throw Error(hdf5::attribute_place(group, attribute), "does not agree with the group's name and attributes");
    };
    agree("scenario", scenario.name, name);
    agree("title", hdf5::read_text(group, "title"), scenario.title);
    agree("length_unit", hdf5::read_text(group, "length_unit"), scenario.length_unit);
    ScenarioResults results{scenario, trial_columns(scenario), step_figures(scenario), {}, -1};
    std::vector<std::string> arms;
    for (const Arm& arm : arms_of(scenario)) arms.push_back(arm_name(arm));
    require_links(group, arms);
    for (const std::string& arm : arms) results.arms.push_back(read_arm(group, arm, results));
    return results;
}

void check_header(const Handle& root) {
    if (!hdf5::has_attribute(root, "format") || hdf5::read_text(root, "format") != results_format)
        throw Error("the file", "is not a results file", "Give a file that credence run wrote");
    const int version = hdf5::read_number<std::int32_t>(root, "schema_version");
    if (version != schema_version)
        throw Error("/@schema_version",
                    "is " + std::to_string(version) + ", this program's is " + std::to_string(schema_version),
                    "Use the release that wrote the file, or run the study again");
}

StoredStudy read_study(const Handle& root, const std::string& path) {
    check_header(root);
    StoredStudy stored;
    Study& study = stored.study;
    study.root_seed = hdf5::read_number<std::uint64_t>(root, "root_seed");
    if (hdf5::read_text(root, "root_seed_text") != std::to_string(study.root_seed))
        throw Error("/@root_seed_text", "is not root_seed=" + std::to_string(study.root_seed));
    const int complete = hdf5::read_number<std::int8_t>(root, "complete");
    if (complete != 0 && complete != 1) throw Error("/@complete", "is neither 0 nor 1");
    study.complete = complete == 1;
    for (const std::string& name : hdf5::link_names(root))
        if (name != run_group) study.scenarios.push_back(read_scenario_results(root, name, path));
    if (hdf5::read_text(root, "study_hash") != study_hash(study))
        throw Error("/@study_hash", "does not belong to these scenarios and this root seed");
    const Handle run = hdf5::open_group(root, run_group);
    for (const std::string& name : hdf5::attribute_names(run))
        stored.run.emplace_back(name, hdf5::read_text(run, name));
    return stored;
}

}  // namespace

StoredStudy read_results(const std::string& path) {
    return hdf5::read_file(path, "Run the study again, or give an undamaged copy",
                           [&](const Handle& root) { return read_study(root, path); });
}

}  // namespace credence
