// Names of a record's places, and lists in its attributes.

#include "record/source.hpp"

#include <credence/error.hpp>
#include <credence/text.hpp>

#include <algorithm>

namespace credence {

std::string record_place(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    if (slash == std::string::npos) return "/" + printable(path);
    return printable("/" + path.substr(0, slash)) + "/" + printable(path.substr(slash + 1));
}

std::string record_attribute_place(const std::string& name, const std::string& path) {
    return printable("/" + path) + "@" + printable(name);
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
