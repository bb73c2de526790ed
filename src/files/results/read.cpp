#include <credence/detail/store.hpp>

#include <credence/text.hpp>

#include "files/results/format.hpp"
#include "files/results/parts.hpp"
#include "study/releases.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

namespace credence {

namespace {

using hdf5::Dataset;
using hdf5::Error;
using hdf5::Handle;

/// Throws unless the group holds exactly the expected members.
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

/// Throws unless as many trials are counted as the totals are of.
void check_counted(const std::string& place, std::int64_t counted, std::int64_t expected) {
    if (counted != expected)
        throw Error(place, "counts " + std::to_string(counted) + " trials, but the totals are of " +
                               std::to_string(expected));
}

void check_counted_trials(const Handle& group, std::int64_t expected) {
    check_counted(hdf5::attribute_place(group, "counted_trials"),
                  hdf5::read_number<std::int64_t>(group, "counted_trials"), expected);
}

/// A study that is being read, and its file.
struct Opened {
    std::shared_ptr<const Handle> file;
    std::string path;
    std::int64_t asked = 0;  ///< trials of each scenario that were asked for
    Keep keep = Keep::trials;
    std::optional<std::int64_t> most_totals;  ///< most bytes of totals to load; nothing: they are not read
};

/// The arm's columns. Throws where they are not those of its scenario, or hold another number of trials than the
/// totals.
std::shared_ptr<const KeptColumns> read_columns(const Handle& group, const ScenarioResults& results,
                                                const ArmResults& arm, const Opened& source) {
    std::vector<std::vector<std::uint32_t>> sums;
    for (const Column& column : results.columns) {
        CheckedColumn checked = check_column(group, column, results.trials);
        if (checked.counted)
            check_counted(hdf5::place_of(group, column.name), *checked.counted, arm.totals.trials.finite());
        sums.push_back(std::move(checked.sums));
    }
    return columns_of_file(source.file, source.path, results.scenario.name + "/" + arm.name, results.columns,
                           std::move(sums));
}

/// The totals of a series over so many trials.
SeriesTotals read_series(const Handle& group, const Series& series, hsize_t steps, hsize_t parts, std::int64_t trials) {
    const std::string total = series.name + "_total", square = series.name + "_square_total";
    SeriesTotals totals;
    totals.sum = series.integer ? read_whole_sums(group, total, steps) : read_sums(group, total, {steps, parts});
    if (!series.integer) totals.square_sum = read_sums(group, square, {steps, parts});
    totals.run_square_sum = read_sums(group, series.name + "_run_square_total", {parts}).front();
    if (series.role != SeriesRole::nees) return totals;
    const std::size_t levels = levels_of_coverage.size();
    totals.covered = read_as<std::int64_t>(group, coverage_name(series), {steps, levels});
    for (std::size_t i = 0; i < totals.covered.size(); ++i)
        if (totals.covered[i] < (i % levels == 0 ? 0 : totals.covered[i - 1]) || totals.covered[i] > trials)
            throw Error(hdf5::place_of(group, coverage_name(series)),
                        "its counts do not rise from 0 to the counted trials");
    return totals;
}

/// Number of parts of an exact total.
hsize_t read_parts(const Handle& group) {
    const hsize_t parts = read_numbered<std::int32_t>(group, "part", 0);
    if (parts == 0) throw Error(hdf5::place_of(group, "part"), "is empty");
    return parts;
}

/// Reads totals, except those of the columns, and details.
void read_totals(const Handle& group, const ScenarioResults& results, ArmResults& arm) {
    Totals& totals = arm.totals;
    const hsize_t parts = read_parts(group);
    if (read_as<double>(group, "level", {levels_of_coverage.size()}) != levels_of_coverage)
        throw Error(hdf5::place_of(group, "level"), "does not hold the levels of this version");
    const auto read_all = [&](const Handle& from, std::int64_t trials) {
        std::vector<SeriesTotals> all;
        for (const Series& series : results.all_series)
            all.push_back(read_series(from, series, static_cast<hsize_t>(results.steps()), parts, trials));
        return all;
    };
    totals.series = read_all(group, totals.trials.finite());
    totals.diverged.clear();
    if (totals.trials.diverged() > 0) {
        const Handle others = hdf5::open_group(group, without_diverged);
        require_links(others, series_links(results));
        check_counted_trials(others, totals.trials.counted());
        totals.diverged = std::exchange(totals.series, read_all(others, totals.trials.counted()));
        for (std::size_t f = 0; f < totals.series.size(); ++f) totals.diverged[f].add(totals.series[f], -1);
    }
    read_evidence(group, results, parts, arm);
}

/// The totals and details of a scenario, in a file that stays open for them.
KeptTotals totals_of_file(const Opened& source, const ScenarioResults& results) {
    std::vector<TrialTotals> of_trials;  // by arm
    for (const ArmResults& arm : results.arms) of_trials.push_back(arm.totals.trials);
    return [source, of_trials, blocks = results.blocks](ScenarioResults& loaded) {
        set_blocks(loaded, blocks, source.asked);
        hdf5::translated(source.path, another_copy, [&] {
            const Handle scenario = hdf5::open_group(*source.file, loaded.scenario.name);
            for (std::size_t a = 0; a < loaded.arms.size(); ++a) {
                ArmResults& arm = loaded.arms[a];
                arm.totals.trials = of_trials[a];
                read_totals(hdf5::open_group(scenario, arm.name), loaded, arm);
            }
        });
    };
}

/// Reads from the first arm which trials are present; the others must agree.
ArmResults read_arm(const Handle& scenario_group, const std::string& name, ScenarioResults& results,
                    const Opened& source) {
    const Handle group = hdf5::open_group(scenario_group, name);
    std::vector<std::string> links = arm_links(results);
    if (hdf5::has_link(group, without_diverged)) links.push_back(without_diverged);
    require_links(group, links);
    const bool trials = results.keep == Keep::trials;
    const BlockRanges blocks = trials ? read_blocks(group, source.asked) : read_block_ranges(group, source.asked);
    if (results.arms.empty()) set_blocks(results, blocks, source.asked);
    if (blocks != results.blocks)
        throw Error(hdf5::place_of(group, trials ? "trial" : "first_block"), "is not the same in every arm");
    read_numbered<std::int32_t>(group, "step", 1);
    Dataset(group, "step").require_extents({static_cast<hsize_t>(results.steps())});

    ArmResults arm;
    arm.name = name;
    arm.totals.trials = read_trial_totals(group, results, read_parts(group));
    check_counted_trials(group, arm.totals.trials.finite());
    const bool some = arm.totals.trials.diverged() > 0;
    if (hdf5::has_link(group, without_diverged) != some)
        throw Error(hdf5::place_of(group, without_diverged), some ? "is missing" : "does not belong here");
    if (trials) arm.columns.keep(read_columns(group, results, arm, source));
    if (source.most_totals) read_totals(group, results, arm);
    return arm;
}

ScenarioResults read_scenario_results(const std::string& name, const Opened& source) {
    const Handle group = hdf5::open_group(*source.file, name);
    ScenarioResults results = read_declared(group, source.path, source.keep);
    const Scenario& scenario = results.scenario;
    const auto agree = [&](const std::string& attribute, const std::string& found, const std::string& expected) {
        if (found != expected)
            throw Error(hdf5::attribute_place(group, attribute), "does not agree with the group's name and attributes");
    };
    agree("scenario", scenario.name, name);
    agree("title", hdf5::read_text(group, "title"), scenario.title);
    agree("length_unit", hdf5::read_text(group, "length_unit"), scenario.length_unit);
    check_sweep(group, scenario.sweep);
    require_links(group, scenario.arms);
    for (const std::string& arm : scenario.arms) results.arms.push_back(read_arm(group, arm, results, source));
    results.kept_totals = std::make_shared<KeptTotals>(totals_of_file(source, results));
    return results;
}

/// The release that a results file names as its maker; empty if it names none.
std::string release_that_wrote(const Handle& root) {
    if (!hdf5::has_link(root, run_group)) return {};
    const Handle run = hdf5::open_group(root, run_group);
    return hdf5::has_attribute(run, version_fact) ? hdf5::read_text(run, version_fact) : std::string();
}

/// Throws if this program cannot read the file.
void check_header(const Handle& root) {
    if (!hdf5::has_attribute(root, "format") || hdf5::read_text(root, "format") != results_format)
        throw Error("the file", "is not a results file", "Give a file that credence run wrote");
    const int version = hdf5::read_number<std::int32_t>(root, "schema_version");
    if (version == schema_version) return;
    const std::string release = release_that_wrote(root);
    throw Error("/@schema_version",
                "is " + std::to_string(version) + ", this program's is " + std::to_string(schema_version) +
                    (release.empty() ? "" : "; the file was made by release " + printable(release)),
                std::string("Report it with ") + (release.empty() ? "the release that made it" : "that release") +
                    ", or run the study again");
}

/// Whether every trial that was asked for is present. Throws where the file says so but some are missing.
bool read_complete(const Handle& root, const Study& study) {
    const int complete = hdf5::read_number<std::int8_t>(root, "complete");
    if (complete != 0 && complete != 1) throw Error("/@complete", "is neither 0 nor 1");
    for (const ScenarioResults& results : study.scenarios)
        if (complete == 1 && results.blocks.size() != static_cast<std::size_t>(block_count(study.trials)))
            throw Error("/@complete", "is 1, but trials are missing");
    return complete == 1;
}

/// If the file does not name the releases that computed its trials, it was the one that wrote the file; empty if it
/// does not say which that was.
std::vector<std::string> computed_by(const RunFacts& run) {
    const auto fact = [&](const std::string& name) {
        const auto found = std::find_if(run.begin(), run.end(), [&](const auto& one) { return one.first == name; });
        return found == run.end() ? "" : found->second;
    };
    if (const std::string releases = fact(computed_by_fact); !releases.empty()) return split_list(releases, '\n');
    if (fact(version_fact).empty()) return {};
    return {release_name(fact(version_fact), fact(revision_fact))};
}

StoredStudy read_study(const Opened& source) {
    const Handle& root = *source.file;
    StoredStudy stored;
    Study& study = stored.study;
    study.root_seed = hdf5::read_number<std::uint64_t>(root, "root_seed");
    if (hdf5::read_text(root, "root_seed_text") != std::to_string(study.root_seed))
        throw Error("/@root_seed_text", "is not root_seed=" + std::to_string(study.root_seed));
    study.trials = source.asked;
    TotalsInMemory in_memory(source.most_totals.value_or(0));
    for (const std::string& name : hdf5::link_names(root))
        if (name != run_group) {
            study.scenarios.push_back(read_scenario_results(name, source));
            in_memory.limit(study.scenarios.back());
        }
    if (hdf5::read_text(root, "study_hash") != study_hash(study))
        throw Error("/@study_hash", "does not belong to these scenarios and this root seed");
    study.complete = read_complete(root, study);
    const Handle run = hdf5::open_group(root, run_group);
    for (const std::string& name : hdf5::attribute_names(run))
        stored.run.emplace_back(name, hdf5::read_text(run, name));
    study.computed_by = computed_by(stored.run);
    return stored;
}

Opened open_results(const std::string& path, std::optional<std::int64_t> most_totals) {
    Opened source{std::make_shared<const Handle>(hdf5::open_file(path)), path, 0, Keep::trials, most_totals};
    check_header(*source.file);
    source.asked = hdf5::read_number<std::int64_t>(*source.file, "trials");
    if (source.asked < 0 || source.asked > most_trials) throw Error("/@trials", "is no number of trials");
    // Only a file that keeps no trials has this attribute.
    if (!hdf5::has_attribute(*source.file, "keep")) return source;
    if (hdf5::read_text(*source.file, "keep") != keep_name(Keep::aggregates))
        throw Error("/@keep", "is not aggregates");
    source.keep = Keep::aggregates;
    return source;
}

}  // namespace

StoredStudy read_results(const std::string& path, std::int64_t most_totals) {
    return hdf5::translated(path, another_copy, [&] { return read_study(open_results(path, most_totals)); });
}

StoredStudy read_results_without_totals(const std::string& path) {
    return hdf5::translated(path, another_copy, [&] { return read_study(open_results(path, std::nullopt)); });
}

}  // namespace credence
