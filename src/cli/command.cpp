#include "cli/command.hpp"

#include "base/wording.hpp"
#include "files/record.hpp"
#include "files/system/durable_file.hpp"
#include "worlds/values.hpp"

#include <credence/error.hpp>
#include <credence/detail/worlds.hpp>
#include <credence/text.hpp>

#include <boost/program_options.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>
#include <limits>
#include <new>
#include <numbers>
#include <set>
#include <sstream>

namespace credence::cli {

namespace {

namespace po = boost::program_options;

po::options_description described(const Command& command) {
    po::options_description description("options", 100, 60);
    description.add_options()("help,h", "print this");
    for (const Option& option : command.options) {
        if (option.value.empty())
            description.add_options()(option.name.c_str(), option.help.c_str());
        else
            description.add_options()(option.name.c_str(),
                                      po::value<std::vector<std::string>>()->value_name(option.value),
                                      option.help.c_str());
    }
    return description;
}

/// The options as --help lists them. Boost writes the names into a stream of its own, which cuts them short where it
/// gets no memory, and says nothing.
std::string help_text(const po::options_description& description) {
    std::ostringstream text;
    text.exceptions(std::ios::badbit);
    text << description;
    for (const auto& option : description.options())
        if (text.str().find(option->format_name() + " " + option->format_parameter()) == std::string::npos)
            throw std::bad_alloc();
    return text.str();
}

[[noreturn]] void refuse_unknown(const Command& command, const std::string& given) {
    std::vector<std::string> names{"help"};
    for (const Option& option : command.options) names.push_back(option.long_name());
    const std::size_t first = given.find_first_not_of('-');
    const std::string meant = first == std::string::npos ? "" : closest(given.substr(first), names);
    throw InputError("unknown option " + printable(given), {},
                     meant.empty() ? as_command({command.name, "--help"}) + " lists them"
                                   : "Did you mean " + as_option(meant) + "?");
}

void check_repeats(const Command& command, const Parsed& parsed) {
    for (const Option& option : command.options) {
        const auto found = parsed.values.find(option.long_name());
        if (found != parsed.values.end() && found->second.size() > 1 && !option.repeatable)
            throw InputError("repeated option " + as_option(found->first), {}, "Give it once");
    }
}

/// The suffix of -o's file chooses the format of what is written there, and must not contradict HDF5.
void take_suffix(const Command& command, Parsed& parsed) {
    const std::string path = parsed.text("output").value_or("");
    for (const std::string format : {"html", "json", "csv", "txt"})
        for (const Option& option : command.options) {
            if (!path.ends_with("." + format)) continue;
            if (option.long_name() == "output" && option.value.ends_with(".h5"))
                throw invalid_value(as_option("output"), path, "what is written there is HDF5", "Give " + option.value +
                    (command.name == "replay" ? "; --format json and csv print its numbers"
                                              : "; " + as_command({"report"}) + " makes pages and tables of it"));
            if (option.long_name() == "format" && std::ranges::count(option.choices, format) > 0)
                parsed.values.try_emplace("format", 1, format);
        }
}

/// `5%` or `0.05`; nothing where it is neither.
std::optional<double> parse_share(const std::string& given) {
    const bool percent = !given.empty() && given.back() == '%';
    const std::optional<double> number = to_number(percent ? given.substr(0, given.size() - 1) : given);
    return number ? std::optional(*number / (percent ? 100 : 1)) : std::nullopt;
}

/// The share that an option gives, between 0 and 1, both excluded.
double parse_open_share(const Parsed& parsed, const std::string& option, const std::string& usual) {
    const std::string given = parsed.text(option).value_or(usual);
    const double share = parse_share(given).value_or(0);
    if (!(share > 0 && share < 1))
        throw invalid_value(as_option(option), given, "must be between 0 and 100 %, both excluded",
                            "Write " + usual + " or 0.05");
    return share;
}

/// One sentence for each key that has one: a standard deviation of an angle above 1 rad may have been meant in degrees.
std::vector<std::string> notes_on(const std::vector<Scenario>& scenarios) {
    constexpr double large = 1;  // rad: beyond it, a normal angle wraps
    std::vector<std::string> notes;
    std::set<std::string> noted;  // keys: a sweep may have many such values of one
    for (const Scenario& scenario : scenarios)
        for (const DescribedKey& key : world_of(scenario).keys()) {
            if (key.sigma_unit != "rad") continue;
            const std::string value = value_of(scenario, key.key);
            const double sigma = to_number(value).value_or(0);
            if (!(sigma > large) || !noted.insert(key.key).second) continue;
            notes.push_back(key.key + "=" + value + " is a standard deviation in rad. If it is in degrees, give " +
                            to_text(sigma * std::numbers::pi / 180) + ".");
        }
    return notes;
}

}  // namespace

std::optional<std::string> Parsed::text(const std::string& option) const {
    const auto found = values.find(option);
    if (found == values.end() || found->second.empty()) return std::nullopt;
    return found->second.back();
}

std::int64_t Parsed::integer(const std::string& option, std::int64_t otherwise, std::int64_t low,
                             std::int64_t high) const {
    const std::optional<std::string> given = text(option);
    return given ? parse_integer(as_option(option), *given, low, high) : otherwise;
}

std::uint64_t Parsed::seed(std::uint64_t otherwise) const {
    const std::optional<std::string> given = text("seed");
    constexpr std::uint64_t largest = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t number = 0;
    if (!given) return otherwise;
    const auto [end, error] = std::from_chars(given->data(), given->data() + given->size(), number);
    if (error == std::errc() && end == given->data() + given->size()) return number;
    const std::int64_t exact = to_integer(*given).value_or(-1);  // such as 1e6
    if (exact >= 0) return static_cast<std::uint64_t>(exact);
    throw invalid_value(as_option("seed"), *given, "must be a whole number from 0 to " + std::to_string(largest),
                        "Give a number in that range");
}

double Parsed::real(const std::string& option, double otherwise, double low, double high) const {
    const std::optional<std::string> given = text(option);
    return given ? parse_real(as_option(option), *given, between(low, high)) : otherwise;
}

std::string Parsed::choice(const std::string& option) const {
    const auto described = std::ranges::find(command->options, option, &Option::long_name);
    const std::vector<std::string>& choices = described->choices;
    const std::optional<std::string> given = text(option);
    if (!given) return choices.front();
    for (const std::string& choice : choices)
        if (*given == choice) return choice;
    throw invalid_value(as_option(option), *given, "not one of its choices",
                        did_you_mean(*given, choices) + "Give one of " + joined(choices));
}

Overrides Parsed::overrides() const {
    Overrides overrides;
    const auto found = values.find("set");
    if (found == values.end()) return overrides;
    for (const std::string& assignment : found->second) {
        const std::size_t equals = assignment.find('=');
        if (equals == std::string::npos)
            throw invalid_value(as_option("set"), assignment, "there is no = in it",
                                "Write " + as_option("set", "section.key=value"));
        overrides.emplace_back(trimmed(assignment.substr(0, equals)), trimmed(assignment.substr(equals + 1)));
    }
    return overrides;
}

std::vector<SweepAxis> Parsed::sweep() const {
    const auto found = values.find("sweep");
    return found == values.end() ? std::vector<SweepAxis>{} : parse_grid(found->second);
}

std::optional<Parsed> parse(const Command& command, const std::vector<std::string>& arguments) {
    const po::options_description description = described(command);
    Parsed parsed{{}, {}, &command, {}};
    try {
        namespace style = po::command_line_style;
        const int strict = style::unix_style & ~style::allow_guessing;
        for (const auto& option : po::command_line_parser(arguments).options(description).style(strict).run().options) {
            if (option.position_key != -1) parsed.arguments.push_back(option.value.front());
            else if (auto& values = parsed.values[option.string_key]; option.value.empty()) values.push_back("");
            else values.insert(values.end(), option.value.begin(), option.value.end());
        }
    } catch (const po::unknown_option& error) {
        refuse_unknown(command, error.get_option_name());
    } catch (const po::error& error) {
        throw InputError(printable(error.what()), {}, as_command({command.name, "--help"}) + " shows how");
    }
    if (parsed.has("help")) {
        std::cout << "usage: " << shown(program_name()) << " " << command.name << " " << command.arguments << "\n\n"
                  << command.summary << "\n\n"
                  << help_text(description) << command.details;
        return std::nullopt;
    }
    check_repeats(command, parsed);
    take_suffix(command, parsed);
    return parsed;
}

Parsed parsed_of(const Command& command, std::vector<std::string> arguments, Values values) {
    Parsed parsed{std::move(arguments), std::move(values), &command, {}};
    take_suffix(command, parsed);
    return parsed;
}

Limits parse_limits(const Parsed& parsed) {
    Limits limits(parse_open_share(parsed, "margin", "5%"), parse_failed(parsed));
    if (parsed.has("margin-direction")) limits.direction = parse_open_share(parsed, "margin-direction", "10%");
    if (limits.direction < limits.margin)
        throw invalid_value(as_option("margin-direction"), *parsed.text("margin-direction"), "less than the margin",
                            "Give at least " + as_option("margin", to_text(limits.margin)));
    const std::string bias = parsed.text("bias").value_or("0.1");
    limits.bias = to_number(bias).value_or(0);
    if (!(limits.bias > 0 && limits.bias <= 10))
        throw invalid_value(as_option("bias"), bias, "must be above 0 and at most 10 sigmas", "Write 0.1");
    return limits;
}

double parse_failed(const Parsed& parsed) {
    const std::string given = parsed.text("failed").value_or("1%");
    const double share = parse_share(given).value_or(-1);
    if (!(share >= 0 && share <= 1))
        throw invalid_value(as_option("failed"), given, "must be from 0 to 100 %", "Write 1% or 0.01");
    return share;
}

int parse_segments(const Parsed& parsed) {
    const std::string given = parsed.text("segments").value_or("auto");
    if (given == "auto") return segments_auto;
    if (given == "off") return segments_off;
    const double steps = to_number(given).value_or(0);
    if (!(steps >= 2 && steps <= 1e9) || steps != std::floor(steps))
        throw invalid_value(as_option("segments"), given, "must be a whole number of steps from 2 on, auto or off",
                            "Write 50");
    return static_cast<int>(steps);
}

std::map<std::string, std::string> parse_truth(const Parsed& parsed) {
    std::map<std::string, std::string> attributes;
    if (const auto sigma = parsed.text("truth-sigma")) attributes["truth_sigma"] = *sigma;
    if (parsed.has("truth-dependent")) attributes["truth_dependent"] = "yes";
    return attributes;
}

std::vector<std::string> inputs_of(const Parsed& parsed) {
    std::vector<std::string> inputs = parsed.arguments;
    for (const std::string& path : parsed.arguments) inputs.push_back(record_file(path));
    if (const std::optional<std::string> noise = parsed.text("noise")) inputs.push_back(*noise);
    return inputs;
}

std::optional<Output> check_output_option(const Parsed& parsed) {
    const std::optional<std::string> path = parsed.text("output");
    if (!path) return std::nullopt;
    Output output = check_output(*path, parsed.has("overwrite"), "Give another name or " + as_option("overwrite"));
    check_not_read(output, inputs_of(parsed));
    return output;
}

void print(const std::string& text) { std::cout << shown(text); }

void say(const std::string& text) { std::cerr << shown(text) << std::flush; }

void say_notes(const std::vector<Scenario>& scenarios, const std::string& command) {
    for (const std::string& note : notes_on(scenarios)) say(program_name() + " " + command + ": note: " + note + "\n");
}

void write_output(const Parsed& parsed, const std::string& text) {
    if (const std::optional<Output> output = check_output_option(parsed)) write_text_file(*output, shown(text));
    else print(text);
}

int give(const Parsed& parsed, Rendering (*make)(const Parsed&)) {
    const std::string format = parsed.choice("format");
    write_output(parsed, make(parsed)(format));
    return 0;
}

Option set_option() {
    return {"set", "section.key=value", "override a key of every scenario; repeatable, the last wins", true};
}

Option sweep_option() {
    return {"sweep", "section.key=VALUES",
            "run every scenario at each of these values: a,b,c, or a range first:last:count, or first:last:count:log; "
            "a|b where values hold commas; repeatable: a grid, the first key slowest; after --set", true};
}

Option failed_option(const std::string& what) {
    return {"failed", "SHARE", "where more than this share of the trials failed, " + what + " (default 1%)"};
}

Option output_option(const std::string& help, const std::string& value) { return {"output,o", value, help}; }

Option overwrite_option() { return {"overwrite", "", "replace the file of -o where it exists"}; }

Option format_option(const std::vector<std::string>& formats) {
    std::string help = formats.front() + " (default)";
    for (std::size_t i = 1; i < formats.size(); ++i) help += (i + 1 < formats.size() ? ", " : " or ") + formats[i];
    if (formats.back() == "html") help += ", a page to send; or the suffix of -o says it";
    return {"format", "FORMAT", help, false, formats};
}

}  // namespace credence::cli
