// Names of a record's places, and lists in its attributes.

#include "record/source.hpp"

#include <credence/error.hpp>
#include <credence/text.hpp>

#include <algorithm>

namespace credence {

std::string record_place(const std::string& path) {
    const std::size_t name = path.rfind('/') + 1;  // 0 where there is none
    return (PlacesAreArrays::now ? "" : "/") + printable(path.substr(0, name)) + printable(path.substr(name));
}

std::string record_attribute_place(const std::string& name, const std::string& path) {
    const std::string object = PlacesAreArrays::now ? path : "/" + path;
    return printable(object) + (object.empty() ? "" : "@") + printable(name);
}

ListEntries list_entries(const std::string& text) {
    ListEntries entries;
    for (std::string& entry : split_list(text)) {
        std::ranges::replace_if(entry, [](char c) { return c == '\t' || c == '\r' || c == '\n'; }, ' ');
        std::vector<std::string>& words = entries.emplace_back();
        for (std::string& word : split_list(entry, ' '))
            if (!word.empty()) words.push_back(std::move(word));
    }
    return entries;
}

}  // namespace credence
