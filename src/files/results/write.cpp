#include <credence/detail/store.hpp>

#include <credence/text.hpp>

#include "files/results/format.hpp"
#include "files/results/parts.hpp"

#include <algorithm>
#include <optional>

namespace credence {

namespace {

using hdf5::Dimension;
using hdf5::Handle;

void write_column(const Handle& group, const Dimension& trial, const ScenarioResults& results, const ArmResults& arm,
                  std::size_t c) {
    const Column& column = results.columns[c];
    as_stored(column.type, [&]<class T>(T) {
        const auto stored = [](double value) { return static_cast<T>(one_nan(value)); };
        const auto values = [&](std::int64_t first, std::int64_t count) {
            const std::vector<double> read = arm.columns.values(c, first, count);
            std::vector<T> converted(read.size());
            std::transform(read.begin(), read.end(), converted.begin(), stored);
            return converted;
        };
        const Handle variable = hdf5::new_long_dataset<T>(group, column.name, results.trials,
                                                          {column.long_name, column.unit}, values);
        hdf5::attach(variable, {&trial});
        if (column.type == ColumnType::status) write_status_flags(variable);
        else hdf5::write_numbers<T>(variable, "_FillValue", {stored(column.fill)});
    });
}

std::string role_name(SeriesRole role) {
    switch (role) {
        case SeriesRole::nees: return "nees";
        case SeriesRole::standardised_error: return "standardised_error";
        case SeriesRole::nis: return "nis";
        case SeriesRole::rows: return "rows";
        case SeriesRole::squared_error: return "squared_error";
        case SeriesRole::variance: return "variance";
        case SeriesRole::nees_in_chart: return "nees_in_chart";
        case SeriesRole::other: break;
    }
    return "other";
}

std::string squared_unit(const std::string& unit) { return unit == "1" ? unit : "(" + unit + ")^2"; }

/// The attributes of a series beside its total.
void write_role(const Handle& variable, const Series& series) {
    hdf5::write_text(variable, "series", series.name);
    hdf5::write_text(variable, "role", role_name(series.role));
    if (!series.part.empty()) hdf5::write_text(variable, "part_of", series.part);
    if (series.dimension > 0) hdf5::write_number<std::int32_t>(variable, "dimension", series.dimension);
    if (series.role != SeriesRole::nis) return;
    hdf5::write_text(variable, "rows", series.rows);
    hdf5::write_number<std::int32_t>(variable, "more_rows", series.more_rows);
}

std::size_t largest_part_count(const ArmResults& arm, const std::vector<SeriesTotals>& finite) {
    std::size_t largest = largest_part_count(arm.totals.trials);
    const auto note = [&](const ExactSum& sum) { largest = std::max(largest, sum.parts().size()); };
    for (const std::vector<SeriesTotals>* all : {&finite, &arm.totals.series})
        for (const SeriesTotals& totals : *all) {
            std::for_each(totals.sum.begin(), totals.sum.end(), note);
            std::for_each(totals.square_sum.begin(), totals.square_sum.end(), note);
            note(totals.run_square_sum);
        }
    std::for_each(arm.totals.products.sum.begin(), arm.totals.products.sum.end(), note);
    std::for_each(arm.totals.products.square_sum.begin(), arm.totals.products.square_sum.end(), note);
    return largest;
}

void write_series(const Handle& group, const EvidenceDimensions& of, const Series& series, const SeriesTotals& totals) {
    const hdf5::Dimension &step = of.step, &part = of.part, &level = of.level;
    const std::string total = series.long_name + ": total over the counted trials", square = squared_unit(series.unit);
    const auto write_parts = [&](const std::string& suffix, const std::vector<ExactSum>& sums,
                                 const hdf5::Dimensions& dimensions, const hdf5::Description& description) {
        write_role(hdf5::new_variable(group, series.name + suffix, parts_of(sums, part.size), dimensions, description),
                   series);
    };
    if (series.integer) {
        std::vector<std::int64_t> sums;
        for (const ExactSum& sum : totals.sum) sums.push_back(whole_number(sum, series.name));
        write_role(hdf5::new_variable(group, series.name + "_total", sums, {&step}, {total, series.unit}), series);
    } else {
        write_parts("_total", totals.sum, {&step, &part}, {total, series.unit});
        write_parts("_square_total", totals.square_sum, {&step, &part}, {total + " of its square", square});
    }
    if (!totals.present.empty())  // of a record
        hdf5::new_variable(group, series.name + "_count", totals.present, {&step},
                           {series.long_name + ": trials with a value", "1"});
    write_parts("_run_square_total", {totals.run_square_sum}, {&part},
                {total + " of the square of its sum over a trial's steps", square});
    if (!totals.covered.empty())
        hdf5::new_variable(group, coverage_name(series), totals.covered, {&step, &level},
                           {series.long_name + ": counted trials below that quantile of chi-square", "1"});
}

Dimension new_trial_dimension(const Handle& group, const ScenarioResults& results) {
    return hdf5::as_dimension(
        hdf5::new_long_dataset<std::int64_t>(
            group, "trial", results.trials, {"trial, counted over the whole study", "1"},
            [&](std::int64_t first, std::int64_t count) { return trial_numbers(results, first, count); }),
        "trial", static_cast<hsize_t>(results.trials));
}

void write_arm(const Handle& scenario_group, const ScenarioResults& results, const ArmResults& arm) {
    const Handle group = hdf5::new_group(scenario_group, arm.name);
    const bool some_diverged = !arm.totals.diverged.empty();
    const std::vector<SeriesTotals> finite = some_diverged ? arm.totals.of_finite() : std::vector<SeriesTotals>(),
                                    &all = some_diverged ? finite : arm.totals.series;
    hdf5::write_number<std::int64_t>(group, "counted_trials", arm.totals.trials.finite());
    std::optional<Dimension> trial;  // the first link, if trials are kept
    if (results.keep == Keep::trials)
        trial.emplace(new_trial_dimension(group, results));
    else
        write_block_ranges(group, results.blocks);
    Dimension step = numbered<std::int32_t>(group, "step", 1, static_cast<std::size_t>(results.steps()),
                                            "pose that the step leads to");
    Dimension part = numbered<std::int32_t>(group, "part", 0, largest_part_count(arm, all),
                                            "part of an exact total: 0 the total, the others what rounding left");
    Dimension level = hdf5::new_dimension(group, "level", levels_of_coverage,
                                          {"share of chi-square below the coverage bound", "1"});
    const EvidenceDimensions of{step, part, level};
    if (trial)
        for (std::size_t c = 0; c < results.columns.size(); ++c) write_column(group, *trial, results, arm, c);
    write_trial_totals(group, part, results, arm);
    for (std::size_t f = 0; f < results.all_series.size(); ++f) write_series(group, of, results.all_series[f], all[f]);
    write_evidence(group, of, results, arm);
    if (some_diverged) {
        const Handle others = hdf5::new_group(group, without_diverged);
        hdf5::write_number<std::int64_t>(others, "counted_trials", arm.totals.trials.counted());
        for (std::size_t f = 0; f < results.all_series.size(); ++f)
            write_series(others, of, results.all_series[f], arm.totals.series[f]);
    }
    if (trial) trial->close();
    for (Dimension* dimension : {&step, &part, &level}) dimension->close();
}

void write_study(const Handle& root, const Study& study, const RunFacts& run) {
    write_header(root, results_format, "Monte Carlo trials of EKF-SLAM and totals over them");
    hdf5::write_text(root, "study_hash", study_hash(study));
    hdf5::write_number<std::uint64_t>(root, "root_seed", study.root_seed);
    hdf5::write_text(root, "root_seed_text", std::to_string(study.root_seed));
    hdf5::write_number<std::int64_t>(root, "trials", study.trials);
    hdf5::write_number<std::int8_t>(root, "complete", study.complete ? 1 : 0);
    if (keep_of(study) != Keep::trials) hdf5::write_text(root, "keep", keep_name(keep_of(study)));
    for (const ScenarioResults& results : study.scenarios) {
        const std::string& name = results.scenario.name;  // each arm of records has results of its own
        const Handle group = hdf5::has_link(root, name) ? hdf5::open_group(root, name)
                                                        : new_scenario_group(root, results.scenario);
        const WithTotals with_totals(results);
        for (const ArmResults& arm : (*with_totals).arms) write_arm(group, *with_totals, arm);
    }
    RunFacts facts = run;
    if (!study.computed_by.empty()) facts.emplace_back(computed_by_fact, joined(study.computed_by, "\n"));
    write_run_facts(root, facts);
}

}  // namespace

void write_results(const Output& output, const Study& study, const RunFacts& run, const std::function<void()>& check) {
    for (const ScenarioResults& results : study.scenarios) refuse_reserved_name(results.scenario);
    write_file(output, [&](const Handle& root) {
        write_study(root, study, run);
        if (check) check();
    });
}

}  // namespace credence
