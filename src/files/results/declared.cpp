#include <credence/ini.hpp>
#include <credence/detail/own_simulation.hpp>
#include <credence/detail/worlds.hpp>
#include <credence/text.hpp>

#include "base/nan.hpp"
#include "base/text_stream.hpp"
#include "files/results/parts.hpp"
#include "record/layout/parts.hpp"
#include "scenario/state_series.hpp"

#include <algorithm>
#include <optional>

namespace credence {

namespace {

using hdf5::Error;
using hdf5::Handle;

constexpr int largest_state = 1000;
constexpr std::size_t most_columns = 1000;

std::vector<std::string> words(const std::string& text) {
    std::istringstream stream = stream_of(text);
    std::vector<std::string> all;
    for (std::string word; stream >> word;) all.push_back(word);
    return all;
}

std::vector<Component> read_components(const Handle& arm) {
    const hdf5::Dataset scale(arm, "component");
    const std::vector<std::string> names = words(hdf5::read_text(scale.object(), "component_names")),
                                   units = words(hdf5::read_text(scale.object(), "component_units"));
    if (names.empty() || names.size() != units.size() || names.size() > largest_state ||
        !std::all_of(names.begin(), names.end(), names_something))
        throw Error(scale.place(), "does not name the components of a state and their units");
    std::vector<Component> components;
    for (std::size_t i = 0; i < names.size(); ++i) components.push_back({names[i], printable(units[i])});
    return components;
}

/// A dataset along the trials, as a column; nothing where it is another dataset.
std::optional<Column> column_of(const Handle& arm, const std::string& name) {
    const hdf5::Dataset dataset(arm, name);
    const Handle& object = dataset.object();
    const bool status = hdf5::has_attribute(object, "flag_meanings");
    if (!names_something(name) || (!status && !hdf5::has_attribute(object, "_FillValue"))) return std::nullopt;
    if (hdf5::has_attribute(object, "CLASS")) return std::nullopt;  // a coordinate
    if (dataset.extents() != hdf5::Dataset(arm, "trial").extents()) return std::nullopt;
    const std::string long_name = printable(hdf5::read_text(object, "long_name")),
                      unit = printable(hdf5::read_text(object, "units"));
    if (status) return Column{name, long_name, unit, ColumnType::status, 0};
    if (dataset.holds<std::int32_t>()) return Column{name, long_name, unit, ColumnType::integer, -1};
    return Column{name, long_name, unit, ColumnType::real, nan};
}

/// The columns of an arm, in the order in which they were written.
std::vector<Column> read_columns(const Handle& arm) {
    std::vector<Column> columns;
    for (const std::string& name : hdf5::link_names(arm)) {
        if (columns.size() == most_columns) throw Error(hdf5::place_of(arm), "has too many columns");
        if (name == without_diverged) continue;
        if (std::optional<Column> column = column_of(arm, name)) columns.push_back(std::move(*column));
    }
    const std::size_t status = status_column(columns);
    const std::vector<Column> last = status_columns();
    if (status + 2 != columns.size() || columns[status].name != last[0].name ||
        columns[status + 1].name != last[1].name || columns[status + 1].type != ColumnType::integer)
        throw Error(hdf5::place_of(arm), "has no columns that end with status and status_pose");
    return columns;
}

/// The series of an arm that has totals only, as columns; only their names and units are known.
std::vector<Column> read_aggregated_columns(const Handle& arm) {
    const hdf5::Dataset scale(arm, "column");
    const std::vector<std::string> names = words(hdf5::read_text(scale.object(), "column_names")),
                                   units = split_list(hdf5::read_text(scale.object(), "column_units"));
    if (names.empty() || names.size() != units.size() || names.size() > most_columns ||
        !std::all_of(names.begin(), names.end(), names_something))
        throw Error(scale.place(), "does not name the columns of the trials and their units");
    std::vector<Column> columns;
    for (std::size_t c = 0; c < names.size(); ++c)
        columns.push_back({names[c], names[c], printable(units[c]), ColumnType::real, nan});
    for (Column& column : status_columns()) columns.push_back(std::move(column));
    return columns;
}

/// The declaration of a scenario, read from the file of a program that has another world.
ScenarioResults declared_by_file(const Handle& group, const std::vector<Setting>& settings, Keep keep) {
    ScenarioResults results;
    results.keep = keep;
    Scenario& scenario = results.scenario;
    for (const Setting& setting : settings)
        if (setting.key == "sweep.of") scenario.sweep.of = printable(setting.value);
        else if (setting.key == "sweep.at")
            scenario.sweep.at = parse_coordinates(printable(setting.value, setting.value.size()));
        else scenario.settings.push_back(setting);
    scenario.world = value_of(scenario, world_key);
    scenario.name = value_of(scenario, "scenario.name");
    scenario.title = hdf5::read_text(group, "title");
    scenario.length_unit = hdf5::read_text(group, "length_unit");
    scenario.arms = hdf5::link_names(group);
    if (scenario.arms.empty() || !names_something(scenario.name) ||
        !std::all_of(scenario.arms.begin(), scenario.arms.end(), names_arm))
        throw Error(hdf5::place_of(group), "is no scenario with arms");
    scenario.baselines = baselines_among(scenario.arms);
    const Handle arm = hdf5::open_group(group, scenario.arms.front());
    const hdf5::Dataset steps(arm, "step");
    if (steps.extents().size() != 1 || steps.extents()[0] < 1 || steps.extents()[0] >= hsize_t{1} << 24)
        throw Error(steps.place(), "is no list of steps");
    scenario.poses = static_cast<int>(steps.extents()[0]) + 1;
    scenario.components = read_components(arm);
    scenario.groups =
        parse_groups(list_entries(hdf5::read_text(group, "groups")), static_cast<int>(scenario.components.size()),
                     hdf5::attribute_place(group, "groups"));
    results.columns = keep == Keep::trials ? read_columns(arm) : read_aggregated_columns(arm);
    for (const Column& usual : own_columns(scenario, {}))
        for (Column& column : results.columns)
            if (column.name == usual.name) column.places = usual.places;
    results.all_series = StateSeries(scenario.components, scenario.groups,
                                   hdf5::has_link(arm, "nis_total") ? Innovations::given : Innovations::none)
                          .list;
    return results;
}

}  // namespace

ScenarioResults read_declared(const Handle& group, const std::string& file, Keep keep) {
    const std::string text = hdf5::read_text(group, "scenario");
    const std::string origin = file + ": " + hdf5::attribute_place(group, "scenario");
    const std::vector<Setting> settings = read_settings(text, origin);
    const Setting* named = find_setting(settings, world_key);
    if (named != nullptr && find_world(named->value) == nullptr) return declared_by_file(group, settings, keep);
    const Scenario scenario = read_scenario_text(text, origin, "scenario");
    const World& world = world_of(scenario);
    return {scenario, world.columns(scenario), world.all_series(scenario), {}, 0, {}, keep};
}

}  // namespace credence
