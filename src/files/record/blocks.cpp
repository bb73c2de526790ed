// The attribute `blocks` of a record: component groups that are evaluated by themselves.

#include <credence/scenario.hpp>
#include <credence/text.hpp>

#include "files/record/file.hpp"

#include <algorithm>

namespace credence {

namespace {

using hdf5::Error;

constexpr std::size_t most_blocks = 1000;
const std::string example = "Write the blocks as NAME FIRST:END, counted from 0 and END not included, such as "
                            "`pose 0:3, feature_1 3:5` for components 0, 1, 2 and 3, 4";

std::string quoted(const std::string& text) { return "`" + printable(text) + "`"; }

/// One `NAME FIRST:END`.
ComponentGroup parse_block(const std::string& entry, int n, const std::string& place) {
    const std::size_t space = entry.find_first_of(" \t\r\n"), colon = entry.find(':');
    if (space == std::string::npos || colon == std::string::npos || colon < space)
        throw Error(place, "broken entry " + quoted(entry), example);
    const std::string name = entry.substr(0, space);
    const auto first = to_integer(trimmed(entry.substr(space, colon - space)));
    const auto end = to_integer(trimmed(entry.substr(colon + 1)));
    if (!first || !end) throw Error(place, "broken entry " + quoted(entry), example);
    if (!names_something(name))
        throw Error(place, quoted(name) + " is no name for a block", "Use letters, digits, _ and -");
    if (name == "all")
        throw Error(place, "`all` cannot name a block, because it stands for the whole state",
                    "Leave that block out: the whole state is judged anyway");
    if (*first < 0 || *end <= *first) throw Error(place, quoted(entry) + " has no components", example);
    if (*end > n)
        throw Error(place, quoted(entry) + " ends beyond the " + std::to_string(n) + " components of the state",
                    example);
    return {name, static_cast<int>(*first), static_cast<int>(*end - *first)};
}

}  // namespace

std::vector<ComponentGroup> parse_blocks(const std::string& text, int n, const std::string& place) {
    std::vector<ComponentGroup> blocks{{"all", 0, n}};
    for (const std::string& entry : split_list(text)) {
        const ComponentGroup block = parse_block(entry, n, place);
        if (std::any_of(blocks.begin(), blocks.end(), [&](const ComponentGroup& b) { return b.name == block.name; }))
            throw Error(place, "names two blocks " + quoted(block.name), "Give each block a name of its own");
        if (blocks.size() > most_blocks)
            throw Error(place, "has more than " + std::to_string(most_blocks) + " blocks", "Leave some out");
        blocks.push_back(block);
    }
    return blocks;
}

}  // namespace credence
