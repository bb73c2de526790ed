#include "worlds/values.hpp"

#include "base/wording.hpp"

#include <credence/detail/draws.hpp>

#include <cmath>
#include <set>

namespace credence {

namespace {

std::string range_text(const ValueRange& range) {
    std::string text = range.low_included ? "at least " + to_text(range.low) : "above " + to_text(range.low);
    text += " and at most " + to_text(range.high);
    return "must be " + text + (range.infinity_allowed ? ", or inf" : "");
}

bool inside(double value, const ValueRange& range) {
    if (std::isinf(value)) return value > 0 && range.infinity_allowed;
    return (range.low_included ? value >= range.low : value > range.low) && value <= range.high;
}

std::string characters_not_in(const std::string& value, bool (*allowed)(char)) {
    const auto bad = std::find_if_not(value.begin(), value.end(), allowed);
    return bad == value.end() ? "" : "it holds a character that is not allowed there";
}

int parse_feature_index(const std::string& value, const std::string& text) {
    const std::optional<std::int64_t> index = to_integer(text);
    if (!index || *index < 0 || *index >= largest_feature_count)
        throw invalid_value("edges.graph", value, "'" + text + "' is not a feature",
                            "Features count from 0 to " + std::to_string(largest_feature_count - 1));
    return static_cast<int>(*index);
}

/// The refusal of a text that is no number.
InputError no_number(const std::string& name, const std::string& value, const std::string& kind,
                     const std::string& range) {
    const bool is_key = name.find('.') != std::string::npos;  // and no option
    if (!is_key || value.find(',') == std::string::npos)
        return invalid_value(name, value, "not a " + kind, "It " + range);
    return invalid_value(name, value, "it has a comma, and one number is wanted",
                         "Write decimals with a point, several values as " + as_option("sweep", name + "=" + value));
}

}  // namespace

std::vector<std::string> list_parts(const std::string& name, const std::string& value) {
    std::vector<std::string> parts = split_list(value), words;
    for (const std::string& part : parts)
        for (const std::string& word : split_list(part, ' '))
            if (!word.empty()) words.push_back(word);
    if (words.size() > parts.size())
        throw invalid_value(name, value, "blanks part what commas should", "Write " + joined(words));
    return parts;
}

double parse_real(const std::string& name, const std::string& value, const ValueRange& range) {
    const std::optional<double> number = to_number(value);
    if (!number) throw no_number(name, value, "number", range_text(range));
    if (!inside(*number, range)) throw invalid_value(name, value, range_text(range), "Give a number in that range");
    return *number;
}

std::vector<double> parse_reals(const std::string& name, const std::string& value, const ValueRange& range) {
    std::vector<double> values;
    for (const std::string& part : list_parts(name, value)) values.push_back(parse_real(name, part, range));
    return values;
}

std::string reals_text(const std::vector<double>& values) {
    std::vector<std::string> parts;
    for (const double value : values) parts.push_back(to_text(value));
    return joined(parts);
}

std::int64_t parse_integer(const std::string& name, const std::string& value, std::int64_t low, std::int64_t high) {
    const std::optional<std::int64_t> number = to_integer(value);
    const std::string bounds = low == high
                                   ? "must be " + std::to_string(low)
                                   : "must be at least " + std::to_string(low) + " and at most " + std::to_string(high);
    if (!number) throw no_number(name, value, "whole number", bounds);
    if (*number < low || *number > high) throw invalid_value(name, value, bounds, "Give a number in that range");
    return *number;
}

std::size_t parse_choice(const std::string& name, const std::string& value, const std::vector<std::string>& choices) {
    const auto found = std::find(choices.begin(), choices.end(), value);
    if (found == choices.end())
        throw invalid_value(name, value, "not one of its choices", "Give one of " + joined(choices));
    return static_cast<std::size_t>(found - choices.begin());
}

const std::vector<DrawSource>& slam_sources() {
    const auto at_first = [](Source source) { return source_bit(source, 0); };
    const auto later = [](Source source) { return source_bit(source, 1); };
    const auto always = [=](Source source) { return at_first(source) | later(source); };
    static const std::vector<DrawSource> sources{
        {"start",
         at_first(Source::odometry_heading) | at_first(Source::odometry_position) | at_first(Source::landmark_prior)},
        {"odometry", later(Source::odometry_position)},
        {"heading", later(Source::odometry_heading)},
        {"measurement", always(Source::measurement)},
        {"walk", always(Source::walk)},
        {"deformation", always(Source::deformation)},
        {"edges", always(Source::edge)},
        {"detection", always(Source::detection)},
        {"outliers", always(Source::outlier)},
        {"placement", always(Source::placement)},
        {"bias", always(Source::odometry_bias)},
        {"control", always(Source::control)}};
    return sources;
}

std::uint32_t parse_sources(const std::string& value, const std::vector<DrawSource>& sources) {
    std::uint32_t bits = 0;
    if (value == "none") return bits;
    std::vector<std::string> names;
    for (const DrawSource& source : sources) names.push_back(source.name);
    for (const std::string& part : list_parts("draws.other", value))
        bits |= sources[parse_choice("draws.other", part, names)].bits;
    if (bits == 0) throw invalid_value("draws.other", value, "it is empty", "Give none, or some of " + joined(names));
    return bits;
}

std::string sources_text(std::uint32_t bits, const std::vector<DrawSource>& sources) {
    std::vector<std::string> names;
    for (const DrawSource& source : sources)
        if ((bits & source.bits) == source.bits) names.push_back(source.name);
    return names.empty() ? "none" : joined(names);
}

KeptErrors parse_kept_errors(const std::string& value) {
    return static_cast<KeptErrors>(parse_choice("draws.errors", value, kept_errors_names()));
}

std::vector<Point> parse_points(const std::string& name, const std::string& value, std::size_t most) {
    std::vector<Point> positions;
    for (const std::string& pair : split_list(value)) {
        const std::size_t space = pair.find_first_of(" \t");
        const std::string x = pair.substr(0, space), y = space == std::string::npos ? "" : trimmed(pair.substr(space));
        if (!to_number(x) || !to_number(y))
            throw invalid_value(name, value, "'" + pair + "' is not a point",
                                "Write pairs `x y` separated by commas, such as `4 0, 4 4`");
        const ValueRange anywhere = between(-largest_value, largest_value);
        positions.push_back({parse_real(name, x, anywhere), parse_real(name, y, anywhere)});
    }
    if (positions.empty() || positions.size() > most)
        throw invalid_value(name, value, std::to_string(positions.size()) + " points",
                            "Give 1 to " + std::to_string(most) + " as `x y, x y`");
    return positions;
}

std::string positions_text(const std::vector<Point>& positions) {
    std::vector<std::string> parts;
    for (const Point& p : positions) parts.push_back(to_text(p.x) + " " + to_text(p.y));
    return joined(parts);
}

EdgeSettings parse_graph(const std::string& value) {
    if (value == "all") return {EdgeGraph::all, {}};
    if (value == "chain") return {EdgeGraph::chain, {}};
    if (value == "none") return {EdgeGraph::none, {}};
    EdgeSettings edges{EdgeGraph::list, {}};
    for (const std::string& pair : split_list(value)) {
        const std::size_t dash = pair.find('-');
        if (dash == std::string::npos || pair.find('-', dash + 1) != std::string::npos)
            throw invalid_value("edges.graph", value, "'" + pair + "' is not a pair",
                                "Give all, chain, none or pairs such as `0-1, 1-2`");
        const Edge edge{parse_feature_index(value, trimmed(pair.substr(0, dash))),
                        parse_feature_index(value, trimmed(pair.substr(dash + 1)))};
        if (edge.from >= edge.to)
            throw invalid_value("edges.graph", value, "'" + pair + "' does not go from a lower to a higher feature",
                                "Write pairs as `0-1`");
        if (std::find(edges.list.begin(), edges.list.end(), edge) != edges.list.end())
            throw invalid_value("edges.graph", value, "'" + pair + "' is given twice", "Name each edge once");
        edges.list.push_back(edge);
    }
    if (edges.list.empty()) throw invalid_value("edges.graph", value, "it is empty", "Write none for no edges");
    return edges;
}

std::string graph_text(const EdgeSettings& edges) {
    switch (edges.graph) {
        case EdgeGraph::all: return "all";
        case EdgeGraph::chain: return "chain";
        case EdgeGraph::none: return "none";
        case EdgeGraph::list: break;
    }
    std::vector<std::string> parts;
    for (const Edge& edge : edges.list) parts.push_back(std::to_string(edge.from) + "-" + std::to_string(edge.to));
    return joined(parts);
}

std::optional<double> parse_truncate(const std::string& value) {
    if (value == "none") return std::nullopt;
    return parse_real("noise.truncate", value, between(0.1, 8));
}

std::optional<std::vector<double>> parse_turns(const std::string& value) {
    if (value == "default") return std::nullopt;
    if (value == "none") return std::vector<double>{};
    std::vector<double> turns = parse_reals("planner.turns", value, between(-3.2, 3.2));
    if (turns.empty() || turns.size() > 100)
        throw invalid_value("planner.turns", value, std::to_string(turns.size()) + " turns",
                            "Give 1 to 100, in radians");
    return turns;
}

std::string turns_text(const std::optional<std::vector<double>>& turns) {
    if (!turns) return "default";
    if (turns->empty()) return "none";
    return reals_text(*turns);
}

const std::vector<std::string>& controller_names() {
    static const std::vector<std::string> names{"fixed",  "greedy", "horizon", "random",
                                                "nearest", "follow", "waypoints"};
    return names;
}

const std::vector<std::string>& estimator_names() {
    static const std::vector<std::string> names{
#define CREDENCE_ESTIMATOR(name, process, Type) #name,
        CREDENCE_ESTIMATORS(CREDENCE_ESTIMATOR)
#undef CREDENCE_ESTIMATOR
    };
    return names;
}

Process process_of(Estimator estimator) {
    static constexpr Process processes[] = {
#define CREDENCE_ESTIMATOR(name, process, Type) Process::process,
        CREDENCE_ESTIMATORS(CREDENCE_ESTIMATOR)
#undef CREDENCE_ESTIMATOR
    };
    return processes[static_cast<std::size_t>(estimator)];
}

std::vector<std::string> estimators_for(Process process) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < estimator_names().size(); ++i)
        if (process_of(static_cast<Estimator>(i)) == process) names.push_back(estimator_names()[i]);
    return names;
}

std::vector<Controller> parse_controllers(const std::string& value) {
    return parse_names<Controller>("arms.controllers", value, controller_names());
}

std::vector<OwnPlanner> parse_own_planners(const std::string& value) {
    std::vector<OwnPlanner> planners;
    if (value == "none") return planners;
    const auto refuse = [&](const std::string& what) {
        throw invalid_value("arms.planners", value, what, "Give names of letters, digits, _ and -, such as `mine`");
    };
    if (split_list(value).empty()) refuse("it is empty");
    std::vector<std::string> taken = controller_names();
    for (const char* name : {"frontier", "informed"}) taken.push_back(name);
    for (const std::string& given : split_list(value)) {
        const std::size_t colon = std::min(given.find(':'), given.size());
        const OwnPlanner planner{given.substr(0, colon), colon < given.size() ? given.substr(colon + 1) : ""};
        if (const std::string why = is_name(planner.name); !why.empty()) refuse("'" + planner.name + "': " + why);
        if (colon < given.size() && !is_name(planner.version).empty())
            refuse("'" + planner.version + "' is no version");
        if (std::ranges::find(taken, planner.name) != taken.end())
            refuse("there is a controller " + planner.name + " already");
        taken.push_back(planner.name);
        planners.push_back(planner);
    }
    return planners;
}

std::string own_planners_text(const std::vector<OwnPlanner>& planners) {
    std::vector<std::string> parts;
    for (const auto& [name, version] : planners) parts.push_back(version.empty() ? name : name + ":" + version);
    return parts.empty() ? "none" : joined(parts);
}

std::optional<std::vector<Estimator>> parse_estimators(const std::string& value) {
    if (value == "default") return std::nullopt;
    return parse_names<Estimator>("arms.estimators", value, estimator_names());
}

std::string is_name(const std::string& value) {
    if (value == "run") return "the results file has a group of that name";
    if (value.empty() || value.size() > 100) return "must have 1 to 100 characters";
    return characters_not_in(value, is_name_character).empty() ? "" : "only letters, digits, _ and - are allowed";
}

std::string is_title(const std::string& value) {
    if (value.size() > 300) return "must have at most 300 characters";
    if (!is_utf8(value)) return "it is not UTF-8";
    return characters_not_in(value,
                             [](char c) { return static_cast<unsigned char>(c) >= 0x20 && c != 0x7f && c != '#'; });
}

std::string is_unit(const std::string& value) {
    if (value.empty() || value.size() > 16) return "must have 1 to 16 characters";
    if (!is_utf8(value)) return "it is not UTF-8";
    return characters_not_in(value,
                             [](char c) { return is_name_character(c) || static_cast<unsigned char>(c) >= 0x80; });
}

void refuse_again(const InputError& refusal, const std::string& value, const std::vector<std::string>& choices) {
    const auto told = [&](const std::string& word) -> std::string {
        static const std::set<std::string> other_filters{"ukf", "ckf", "enkf", "eskf", "msckf", "imm", "pf"};
        const bool estimator = refusal.complaint().subject == "arms.estimators";
        if (std::ranges::count(choices, word) > 0 || word.find(' ') != std::string::npos) return {};
        return (estimator && other_filters.contains(word) ? "" : did_you_mean(word, choices)) +
               (estimator ? "docs/own-filter.md says how to run a filter of your own. " : "");
    };
    Complaint complaint = refusal.complaint();
    for (const std::string& word : split_list(value))
        if (const std::string remedy = told(word); !remedy.empty()) {
            complaint.remedy = remedy + complaint.remedy;
            break;
        }
    throw InputError(complaint);
}

namespace {

/// The known keys of the noise that a key names in other words of the field: `noise.measurement`, `R`, `sensor.std`.
std::vector<std::string> synonyms(std::string key, const std::vector<std::string>& known) {
    using Words = std::set<std::string>;
    static const Words of_noise{"noise", "sigma", "std", "stddev", "sd", "variance", "cov", "covariance", "r", "q"};
    static const std::pair<Words, std::vector<std::string>> all[] = {
        {{"measurement", "measurements", "observation", "sensor", "range", "r"}, {"sensor.sigma"}},
        {{"process", "motion", "model", "system", "dynamics", "q"}, {"noise.heading", "noise.odometry", "noise.walk"}},
        {{"initial", "prior", "start"}, {"noise.initial_heading", "noise.initial_position"}}};
    for (char& c : key) c = c == '.' || c == '_' || c == '-' ? ' ' : static_cast<char>(c | 0x20);  // in small letters
    const std::vector<std::string> words = split_list(key, ' ');
    for (auto [named, meant] : all) {
        const auto count_in = [&](const Words& some) {
            return std::ranges::count_if(words, [&](const std::string& word) { return some.contains(word); });
        };
        const auto of_it = count_in(named), noise = count_in(of_noise);
        named.insert(of_noise.begin(), of_noise.end());
        std::erase_if(meant, [&](const std::string& one) { return std::ranges::count(known, one) == 0; });
        if (of_it > 0 && noise > 0 && count_in(named) == std::ssize(words)) return meant;
    }
    return {};
}

/// The known keys that an unknown one may mean. One of the truth never means what the filter believes of it.
std::vector<std::string> keys_meant(const std::string& key, std::vector<std::string> known) {
    if (closest(key.substr(0, key.find('.')), {"filter"}).empty()) {
        if (std::vector<std::string> there = synonyms(key, known); !there.empty()) return there;
        std::erase_if(known, [](const std::string& one) { return one.starts_with("filter."); });
    }
    return split_list(closest(key, known));
}

}  // namespace

void refuse_unknown_key(const std::string& key, const std::vector<std::string>& known) {
    constexpr std::size_t a_line = 12;
    const std::string whole = key.substr(key.find('.') + 1);  // of a key that stands in a section with its section
    const bool sectioned_twice = std::ranges::find(known, whole) != known.end();
    const std::vector<std::string> meant = keys_meant(key, known);
    const std::size_t dot = whole.find('.');
    throw InputError("unknown key " + printable(key), {},
                     sectioned_twice ? "Under [" + whole.substr(0, dot) + "] write " + whole.substr(dot + 1)
                     : !meant.empty()        ? "Did you mean " + joined(meant, " or ") + "?"
                     : known.size() > a_line ? as_command({"show"}) + " prints every key"
                                             : "The keys are " + joined(known));
}

}  // namespace credence
