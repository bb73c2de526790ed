#include "record/layout/parts.hpp"

#include <credence/detail/scenario.hpp>
#include <credence/error.hpp>
#include <credence/text.hpp>

#include <algorithm>
#include <string_view>

namespace credence {

namespace {

constexpr std::size_t most_groups = 1000;
std::string quoted(const std::string& text) { return "`" + printable(text) + "`"; }

/// What a list is of, for messages.
struct Listed {
    std::string one, whole;  ///< `component`, `the state`
    int size;                ///< how many there are
    std::string example, arrays;  ///< remedies, for a file and for arrays
};

struct NamedList {
    std::string name;
    std::vector<int> members;
};

const std::string group_example = "Write the groups as NAME and its components, counted from 0, such as "
                                  "`position 0 2, velocity 1 3, heading 4`, or as a range with its end not included, "
                                  "such as `pose 0:3`";
const std::string dictionary = "Give a dict of their names, each with indices counted from 0, such as "
                               "{\"pose\": [0, 1, 2]}, or a text such as `pose 0:3`, the end of a range not included";
const std::string row_example = "Write the groups as NAME and its rows, counted from 0, such as `gps 0:3, baro 3`, the "
                                "end of a range not included";

/// Adds `4`, or `0:3`.
void add_members(const std::string& word, const std::string& entry, const Listed& of, const std::string& place,
                 std::vector<int>& members) {
    const std::size_t colon = word.find(':');
    const auto first = to_integer(word.substr(0, colon));
    const auto end = colon == std::string::npos ? first : to_integer(word.substr(colon + 1));
    if (!first || !end) throw RecordError(place, "broken entry " + quoted(entry), of.example, of.arrays);
    const std::int64_t last = colon == std::string::npos ? *first : *end - 1;
    if (*first < 0 || last < *first)
        throw RecordError(place, quoted(entry) + " has no " + of.one + " " + quoted(word), of.example, of.arrays);
    if (last >= of.size)
        throw RecordError(
            place, quoted(entry) + " goes beyond the " + std::to_string(of.size) + " " + of.one + "s of " + of.whole,
            of.example, of.arrays);
    for (std::int64_t member = *first; member <= last; ++member) {
        if (std::ranges::find(members, static_cast<int>(member)) != members.end())
            throw RecordError(place, quoted(entry) + " names " + of.one + " " + std::to_string(member) + " twice",
                              "Name each one once in a group");
        members.push_back(static_cast<int>(member));
    }
}

std::vector<NamedList> parse_lists(const ListEntries& entries, const Listed& of, const std::string& place) {
    std::vector<NamedList> lists;
    for (const std::vector<std::string>& words : entries) {
        const std::string entry = joined(words, " ");
        if (words.size() < 2) throw RecordError(place, "broken entry " + quoted(entry), of.example, of.arrays);
        require_group_name(words.front(), place);
        NamedList list{words.front(), {}};
        for (std::size_t i = 1; i < words.size(); ++i) add_members(words[i], entry, of, place, list.members);
        if (std::ranges::any_of(lists, [&](const NamedList& other) { return other.name == list.name; }))
            throw RecordError(place, "names two groups " + quoted(list.name), "Give each group a name of its own");
        if (lists.size() == most_groups)
            throw RecordError(place, "has more than " + std::to_string(most_groups) + " groups", "Leave some out");
        lists.push_back(std::move(list));
    }
    return lists;
}

/// The texts of a list, of which there must be one for each component.
std::vector<std::string> read_list(const RecordSource& source, const std::string& name, int n) {
    if (!source.has_attribute(name)) return {};
    std::vector<std::string> texts;
    for (const std::vector<std::string>& words : source.list(name)) texts.push_back(joined(words, " "));
    if (texts.size() != static_cast<std::size_t>(n))
        throw RecordError(
            record_attribute_place(name),
            "has " + std::to_string(texts.size()) + " entries, and the state has " + std::to_string(n) + " components",
            "Write one for each component, with commas between them", "Give a list with one for each component");
    return texts;
}

/// Text of one line that a list, a path and an option can hold.
bool is_line(const std::string& name) {
    const auto is_unfit = [](unsigned char c) {
        return c < 0x20 || c == 0x7f || std::string_view(",/=\"'`\\").find(static_cast<char>(c)) != std::string::npos;
    };
    return !name.empty() && is_utf8(name) && std::ranges::none_of(name, is_unfit);
}

void require_name(bool fits, const std::string& name, const std::string& what, const std::string& place) {
    if (!fits) throw RecordError(place, quoted(name) + " is no name for a " + what, "Use letters, digits, _ and -");
    if (name == "all")
        throw RecordError(place, "`all` cannot name a " + what + ", because it stands for the whole",
                          "Leave that " + what + " out: the whole is judged anyway");
}

}  // namespace

ComponentGroup group_of(const std::string& name, std::vector<int> members) {
    ComponentGroup group{name, members.front(), static_cast<int>(members.size())};
    if (std::ranges::adjacent_find(members, [](int i, int next) { return next != i + 1; }) != members.end())
        group.components = std::move(members);
    return group;
}

void require_group_name(const std::string& name, const std::string& place) {
    require_name(names_something(name), name, "group", place);
}

/// It is what its owner calls it.
void require_component_name(const std::string& name, const std::string& place) {
    require_name(is_line(name), name, "component", place);
}

std::vector<ComponentGroup> parse_groups(const ListEntries& entries, int n, const std::string& place) {
    std::vector<ComponentGroup> groups{{"all", 0, n}};
    for (NamedList& list : parse_lists(entries, {"component", "the state", n, group_example, dictionary}, place))
        groups.push_back(group_of(list.name, std::move(list.members)));
    return groups;
}

std::vector<RowGroup> parse_row_groups(const ListEntries& entries, int m, const std::string& place) {
    std::vector<RowGroup> groups;
    for (NamedList& list : parse_lists(entries, {"row", "the innovation", m, row_example, dictionary}, place)) {
        if (list.name == "rows" || list.name.starts_with("rows_"))
            throw RecordError(place, quoted(list.name) + " cannot name a group of rows, because series begin so",
                              "Use another name");
        groups.push_back({list.name, std::move(list.members)});
    }
    return groups;
}

std::vector<ComponentGroup> read_groups(const RecordSource& source, int n) {
    const std::string name = "groups", place = record_attribute_place(name);
    if (source.has_attribute(name)) return parse_groups(source.list(name), n, place);
    if (source.has(name))
        throw RecordError(place, "is missing, but there is a `groups` elsewhere",
                          "Make it an attribute of the root, `/`");
    if (source.has_attribute("blocks"))
        throw RecordError(record_attribute_place("blocks"), "is of a record of release 0.2 or earlier",
                          "Write it as the attribute `groups`");
    return parse_groups({}, n, place);
}

std::vector<Component> read_components(const RecordSource& source, int n, const std::vector<Component>& defaults) {
    const std::vector<std::string> names = read_list(source, "component_names", n),
                                   units = read_list(source, "component_units", n);
    if (names.empty() && units.empty()) return defaults;
    std::vector<Component> components = names.empty() ? defaults : std::vector<Component>();
    components.resize(static_cast<std::size_t>(n));
    for (std::size_t j = 0; j < components.size(); ++j) {
        Component& component = components[j];
        if (!names.empty()) component.name = names[j];
        else if (defaults.empty()) component.name = "x" + std::to_string(j);
        if (!units.empty()) component.unit = units[j];
        if (!names.empty()) require_component_name(component.name, record_attribute_place("component_names"));
        if (!units.empty() && (component.unit.empty() || component.unit.find_first_of(" \t\r\n") != std::string::npos))
            throw RecordError(record_attribute_place("component_units"), quoted(component.unit) + " is no unit",
                              "Write one word for each component, such as m/s, and 1 where it has no unit");
        for (std::size_t i = 0; i < j; ++i)
            if (components[i].name == component.name)
                throw RecordError(record_attribute_place("component_names"),
                                  "names two components " + quoted(component.name),
                                  "Give each component a name of its own");
    }
    return components;
}

}  // namespace credence
