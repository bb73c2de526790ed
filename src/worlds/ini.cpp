#include <credence/ini.hpp>

#include "worlds/deformable/deformable.hpp"
#include <credence/error.hpp>
#include <credence/detail/worlds.hpp>
#include <credence/text.hpp>

#include "base/readable_file.hpp"
#include "base/text_stream.hpp"
#include "base/wording.hpp"

#include <boost/program_options.hpp>

#include <filesystem>
#include <map>
#include <optional>

namespace credence {

namespace {

namespace po = boost::program_options;

constexpr std::size_t largest_file = 1 << 20;

/// Keys of a scenario text with their values and lines.
struct Assignment {
    std::string key, value;
    int line = 0;
};

std::string place(const std::string& origin, int line) { return origin + ":" + std::to_string(line); }

/// Reads one line through Boost's INI parser; `section` is carried from line to line.
std::vector<Assignment> read_line(const std::string& text, const std::string& origin, int line, std::string& section) {
    const std::string bare = trimmed(text.substr(0, text.find('#')));
    if (bare.empty()) return {};
    if (bare.front() == '[') {
        if (bare.back() != ']' || bare.size() < 3)
            throw InputError("broken section `" + printable(bare) + "`", {}, "Write [section]").at(place(origin, line));
        section = trimmed(std::string_view(bare).substr(1, bare.size() - 2));
        return {};
    }
    const po::options_description nothing_declared;
    std::istringstream stream = stream_of((section.empty() ? "" : "[" + section + "]\n") + bare + "\n");
    std::vector<Assignment> read;
    try {
        for (const auto& option : po::parse_config_file(stream, nothing_declared, true).options)
            read.push_back({option.string_key, trimmed(joined(option.value)), line});
    } catch (const po::error&) {
        throw InputError("broken line `" + printable(bare) + "`", {}, "Write key = value").at(place(origin, line));
    }
    return read;
}

std::vector<Assignment> read_lines(const std::string& text, const std::string& origin) {
    std::vector<Assignment> all;
    std::map<std::string, int> lines;
    std::istringstream stream = stream_of(without_mark(text));
    std::string line, section;
    for (int number = 1; std::getline(stream, line); ++number)
        for (Assignment& one : read_line(line, origin, number, section)) {
            const auto [first, is_new] = lines.emplace(one.key, number);
            if (!is_new)
                throw InputError("repeated key " + printable(one.key),
                                 "it is in line " + std::to_string(first->second) + " already", "Keep one of them")
                    .at(place(origin, number));
            all.push_back(std::move(one));
        }
    return all;
}

/// A value that the text or an override gives to a key, and how messages call its place.
struct Given {
    std::string value, where;
};

/// The last one; nothing where the key is not given.
std::optional<Given> given(const std::string& key, const std::vector<Assignment>& assignments,
                           const std::string& origin, const Overrides& overrides) {
    std::optional<Given> last;
    for (const Assignment& one : assignments)
        if (one.key == key) last = Given{one.value, place(origin, one.line)};
    for (const auto& [name, value] : overrides)
        if (name == key) last = Given{trimmed(value), as_option("set", key)};
    return last;
}

/// An empty scenario of the world that the text or an override names.
std::unique_ptr<Draft> draft_of(const std::vector<Assignment>& assignments, const std::string& origin,
                                const Overrides& overrides) {
    const Given world = given(world_key, assignments, origin, overrides).value_or(Given{first_world, origin});
    Scenario named;
    named.world = world.value;
    return at_place(world.where, [&] { return world_of(named).draft(); });
}

/// Sets a key of the world, or of the place in a grid, which scenarios of every world have.
void set(Draft& draft, SweepPoint& sweep, const std::string& key, const std::string& value) {
    if (key == "sweep.at") sweep.at = parse_coordinates(value);
    else if (key == "sweep.of") sweep.of = value;
    else draft.set(key, value);
}

/// Sets what the text and the overrides say. Refusals name the line, or --set. Returns the lines of the keys, for
/// refusals of what comes after.
std::map<std::string, int> fill(Draft& draft, SweepPoint& sweep, const std::vector<Assignment>& assignments,
                                const std::string& origin, const Overrides& overrides) {
    std::map<std::string, int> lines;
    for (const Assignment& one : assignments) {
        if (one.key == world_key) continue;
        at_place(place(origin, one.line), [&] { set(draft, sweep, one.key, one.value); });
        lines[one.key] = one.line;
    }
    for (const auto& given : overrides) {
        if (given.first == world_key) continue;
        at_place(as_option("set", printable(given.first)),
                 [&] { set(draft, sweep, given.first, trimmed(given.second)); });
        lines.erase(given.first);
    }
    return lines;
}

std::string text_of_file(const std::string& path) {
    const auto refuse = [&](const std::string& why, const std::string& remedy) {
        return InputError("cannot read scenario " + path, why, remedy);
    };
    try {
        std::string text = start_of_file(path, largest_file + 1);
        if (text.size() > largest_file) throw refuse("it is larger than 1 MiB", "Give an INI file");
        if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff") || text.find('\0') != std::string::npos)
            throw refuse("it is no text in UTF-8 but perhaps in UTF-16", "Save it as UTF-8");
        return text;
    } catch (const Unreadable& why) {
        if (why.is_missing()) throw refuse("there is no such file", "Check the path");
        if (why.is_irregular()) throw refuse("it is not a file", "Give an INI file");
        throw refuse(why.what(), remedy_for_reading(why.error()));
    }
}

std::string stem(const std::string& path) { return std::filesystem::path(path).stem().string(); }

/// Throws where a scenario is not at the place of a grid that it says.
void check_place(const Scenario& scenario) {
    const SweepPoint& sweep = scenario.sweep;
    if (sweep.at.empty() && sweep.of.empty()) return;
    if (sweep.at.empty() || sweep.of.empty() || !names_something(sweep.of))
        throw invalid_value("sweep.of", sweep.of, "a point of a grid says of which scenario, and where in sweep.at",
                            "Give both, or neither");
    for (const SweepCoordinate& one : sweep.at) {
        const std::string value = value_of(scenario, one.key);
        if (value == one.value) continue;
        const std::unique_ptr<Draft> said = world_of(scenario).draft();  // `default` may be the same
        for (const Setting& setting : scenario.settings)
            if (setting.key != world_key) said->set(setting.key, setting.value);
        said->set(one.key, one.value);
        if (value_of(said->declare(), one.key) != value)
            throw invalid_value("sweep.at", coordinates_text(sweep.at), "the scenario has " + one.key + "=" + value,
                                "Give the value that it has");
    }
}

/// A scenario at a point of its grid, where it goes by another name.
Scenario declared_at(Draft& draft, const std::string& origin, const SweepPoint& point, const std::string& name) {
    for (const SweepCoordinate& one : point.at)
        at_place(as_option("sweep", printable(one.key)), [&] { draft.set(one.key, one.value); });
    return at_place(origin + " at " + printable(coordinates_text(point.at)), [&] {
        draft.set("scenario.name", name);
        Scenario scenario = draft.declare();
        scenario.sweep = point;
        return scenario;
    });
}

}  // namespace

std::vector<Setting> read_settings(const std::string& text, const std::string& origin) {
    std::vector<Setting> settings;
    for (Assignment& one : read_lines(text, origin)) settings.push_back({std::move(one.key), std::move(one.value)});
    return settings;
}

Scenario read_scenario_text(const std::string& text, const std::string& origin, const std::string& default_name,
                                  const Overrides& overrides) {
    const std::vector<Assignment> assignments = read_lines(text, origin);
    const std::unique_ptr<Draft> draft = draft_of(assignments, origin, overrides);
    SweepPoint sweep;
    const std::map<std::string, int> lines = fill(*draft, sweep, assignments, origin, overrides);
    try {
        // It is refused only where it is used.
        if (!given("scenario.name", assignments, origin, overrides)) draft->set("scenario.name", default_name);
        Scenario scenario = draft->declare();
        scenario.sweep = std::move(sweep);
        check_place(scenario);
        return scenario;
    } catch (const InputError& error) {
        const auto line = lines.find(error.complaint().subject);
        throw error.at(line == lines.end() ? origin : place(origin, line->second));
    }
}

Scenario read_scenario(const std::string& path, const Overrides& overrides) {
    return read_scenario_text(text_of_file(path), path, stem(path), overrides);
}

std::vector<Scenario> read_grid(const std::string& path, const Overrides& overrides,
                                   const std::vector<SweepAxis>& axes) {
    if (axes.empty()) return {read_scenario(path, overrides)};
    const std::vector<Assignment> assignments = read_lines(text_of_file(path), path);
    const std::string name = given("scenario.name", assignments, path, overrides).value_or(Given{stem(path), ""}).value;
    std::vector<Scenario> scenarios;
    for (const std::vector<SweepCoordinate>& at : grid_points(axes)) {
        const std::unique_ptr<Draft> draft = draft_of(assignments, path, overrides);
        SweepPoint before;
        fill(*draft, before, assignments, path, overrides);
        if (!before.of.empty())
            throw InputError("cannot sweep " + path,
                             "it is a point of a grid already: sweep.of=" + printable(before.of),
                             "Remove its section [sweep], or sweep the scenario it is of");
        scenarios.push_back(declared_at(*draft, path, {name, at}, point_name(name, axes, at)));
    }
    return scenarios;
}

DeformableSettings read_deformable_text(const std::string& text, const std::string& origin,
                                        const std::string& default_name, const Overrides& overrides) {
    return settings_of(read_scenario_text(text, origin, default_name, overrides));
}

DeformableSettings read_deformable(const std::string& path, const Overrides& overrides) {
    return settings_of(read_scenario(path, overrides));
}

}  // namespace credence
