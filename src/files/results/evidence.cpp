#include "files/results/format.hpp"
#include "files/results/parts.hpp"

#include <algorithm>
#include <limits>

namespace credence {

namespace {

using hdf5::Error;
using hdf5::Handle;

std::size_t lags(const ScenarioResults& results) { return static_cast<std::size_t>(lag_count(results.scenario.poses)); }

const std::string& first_nees(const ScenarioResults& results) { return results.all_series.front().name; }

const std::string moments_name = "detailed_moments";

std::string cells_name(const ScenarioResults& results) { return first_nees(results) + "_cells"; }

/// The values were rounded to single precision when they were stored. The bits of NaN depend on the processor.
std::vector<float> single(const std::vector<double>& values) {
    std::vector<float> singles(values.size());
    std::transform(values.begin(), values.end(), singles.begin(),
                   [](double value) { return static_cast<float>(one_nan(value)); });
    return singles;
}

std::vector<double> read_single(const Handle& group, const std::string& name, const hdf5::Extents& extents) {
    const std::vector<float> values = read_as<float>(group, name, extents);
    return {values.begin(), values.end()};
}

void write_products(const Handle& group, const hdf5::Dimension& part, const ScenarioResults& results,
                    const ArmResults& arm) {
    if (lags(results) == 0) return;
    auto lag = numbered<std::int32_t>(group, "lag", 1, lags(results), "steps between two whitened innovations");
    const std::string what = "products of whitened innovations, over the detailed trials, their steps and rows";
    hdf5::new_variable(group, "whiteness_total", parts_of(arm.totals.products.sum, part.size), {&lag, &part},
                       {"total of " + what, "1"});
    hdf5::new_variable(group, "whiteness_square_total", parts_of(arm.totals.products.square_sum, part.size),
                       {&lag, &part}, {"total over the trials of the square of each one's sum of " + what, "1"});
    hdf5::new_variable(group, "whiteness_count", arm.totals.products.count, {&lag}, {"number of " + what, "1"});
    lag.close();
}

void write_detailed_moments(const Handle& group, const hdf5::Dimension& detailed, const ScenarioResults& results,
                            const ArmResults& arm) {
    auto moment = numbered<std::int32_t>(group, "moment", 0, static_cast<std::size_t>(results.moment_count()),
                                         "moment: NEES by group, standardised error, its products, correlations of P");
    std::vector<double> values(arm.moments.size());
    std::transform(arm.moments.begin(), arm.moments.end(), values.begin(), one_nan);
    const Handle moments =
        hdf5::new_variable(group, moments_name, values, {&detailed, &moment},
                           {"means and sums over the steps of standardised errors and covariances", "1"});
    hdf5::write_numbers<double>(moments, "_FillValue", {one_nan(nan)});
    moment.close();
}

void write_errors(const Handle& group, const hdf5::Dimension& step, const ScenarioResults& results,
                  const ArmResults& arm) {
    auto detailed =
        hdf5::new_dimension(group, "detailed_trial", trial_numbers(results, 0, results.detailed()),
                            {"trials whose errors are kept: of the first ones of the study those in the file", "1"});
    auto component = new_component_dimension(group, results.scenario.components, "component", "component of the state");
    const float fill = std::numeric_limits<float>::quiet_NaN();
    const Handle nees = hdf5::new_variable(group, "detailed_nees", single(arm.nees), {&detailed, &step},
                                           {"normalised estimation error squared of the whole state", "1"});
    hdf5::write_numbers<float>(nees, "_FillValue", {fill});
    const Handle errors = hdf5::new_variable(
        group, "detailed_error", single(arm.errors), {&detailed, &step, &component},
        {"error of the state after the update, estimate - truth", state_units(results.scenario.components)});
    hdf5::write_numbers<float>(errors, "_FillValue", {fill});
    component.close();
    if (results.moment_count() > 0) write_detailed_moments(group, detailed, results, arm);
    detailed.close();
}

void read_cells(const Handle& group, const ScenarioResults& results, ArmResults& arm) {
    const std::string name = cells_name(results);
    arm.totals.cells = read_as<std::int64_t>(group, name, {static_cast<hsize_t>(results.steps()), distribution_cells});
    for (auto row = arm.totals.cells.begin(); row != arm.totals.cells.end(); row += distribution_cells) {
        std::int64_t left = arm.totals.trials.counted();
        for (auto count = row; count != row + distribution_cells; ++count) {
            if (*count < 0 || *count > left) throw Error(hdf5::place_of(group, name), "its counts do not add up");
            left -= *count;
        }
        const bool in_part = left > 0 && !results.all_series.front().rows.empty();  // some of a state that grows
        if (left != 0 && !in_part)
            throw Error(hdf5::place_of(group, name), "its counts do not add up to the counted trials");
    }
}

void read_products(const Handle& group, const ScenarioResults& results, hsize_t parts, ArmResults& arm) {
    const hsize_t count = lags(results);
    if (count == 0) return;
    arm.totals.products = {read_sums(group, "whiteness_total", {count, parts}),
                    read_sums(group, "whiteness_square_total", {count, parts}),
                    read_as<std::int64_t>(group, "whiteness_count", {count})};
    for (const std::int64_t products : arm.totals.products.count)
        if (products < 0) throw Error(hdf5::place_of(group, "whiteness_count"), "is negative");
}

}  // namespace

std::vector<std::string> evidence_links(const ScenarioResults& results) {
    std::vector<std::string> names{"detailed_trial", "component", "detailed_nees", "detailed_error"};
    if (results.moment_count() > 0) names.insert(names.end(), {"moment", moments_name});
    if (distribution_counted(results.steps())) names.insert(names.end(), {"cell", cells_name(results)});
    if (lags(results) > 0)
        names.insert(names.end(), {"lag", "whiteness_total", "whiteness_square_total", "whiteness_count"});
    return names;
}

void write_evidence(const Handle& group, const EvidenceDimensions& dimensions, const ScenarioResults& results,
                    const ArmResults& arm) {
    if (distribution_counted(results.steps()) && !arm.totals.cells.empty()) {  // records have exact distances
        auto cell = numbered<std::int32_t>(group, "cell", 0, distribution_cells,
                                           "cell of chi-square; every one is as probable as any other");
        hdf5::new_variable(group, cells_name(results), arm.totals.cells, {&dimensions.step, &cell},
                           {results.all_series.front().long_name + ": counted trials by cell", "1"});
        cell.close();
    }
    write_products(group, dimensions.part, results, arm);
    write_errors(group, dimensions.step, results, arm);
}

void read_evidence(const Handle& group, const ScenarioResults& results, hsize_t parts, ArmResults& arm) {
    const auto steps = static_cast<hsize_t>(results.steps()), size = static_cast<hsize_t>(results.state_size()),
               detailed = static_cast<hsize_t>(results.detailed());
    if (distribution_counted(results.steps())) {
        check_numbered<std::int32_t>(group, "cell", 0, distribution_cells);
        read_cells(group, results, arm);
    }
    if (lags(results) > 0) check_numbered<std::int32_t>(group, "lag", 1, lags(results));
    read_products(group, results, parts, arm);
    if (read_as<std::int64_t>(group, "detailed_trial", {detailed}) != trial_numbers(results, 0, results.detailed()))
        throw Error(hdf5::place_of(group, "detailed_trial"), "does not name the first of the trials that are there");
    check_numbered<std::int32_t>(group, "component", 0, size);
    arm.nees = read_single(group, "detailed_nees", {detailed, steps});
    arm.errors = read_single(group, "detailed_error", {detailed, steps, size});
    const auto moments = static_cast<hsize_t>(results.moment_count());
    if (moments == 0) return;
    check_numbered<std::int32_t>(group, "moment", 0, moments);
    arm.moments = read_as<double>(group, moments_name, {detailed, moments});
}

}  // namespace credence
