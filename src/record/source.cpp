// Names of a record's places, lists in its attributes, and a record in arrays in memory, of doubles or singles with any
// strides.

#include "record/source.hpp"

#include <credence/error.hpp>
#include <credence/text.hpp>

#include <algorithm>
#include <set>

namespace credence {

namespace {

/// Copies a part of an array, its strides in elements; returns the end of what was written.
template <class T>
double* copy(const T* from, const std::int64_t* strides, const std::uint64_t* count, std::size_t axes, double* to) {
    if (axes == 0) return *to = static_cast<double>(*from), to + 1;
    if (axes == 1 && *strides == 1) return std::copy_n(from, *count, to);
    for (std::uint64_t i = 0; i < *count; ++i, from += *strides) to = copy(from, strides + 1, count + 1, axes - 1, to);
    return to;
}

/// Axes of which the later one lies within the earlier one without gaps are copied as one.
template <class T>
void read_from(const T* from, std::vector<std::int64_t> strides, RecordExtents count, std::vector<double>& values) {
    for (std::size_t axis = count.size() - 1; axis > 0; --axis) {
        if (strides[axis - 1] != strides[axis] * static_cast<std::int64_t>(count[axis])) continue;
        count[axis - 1] *= count[axis];
        strides[axis - 1] = strides[axis];
        count.erase(count.begin() + static_cast<std::ptrdiff_t>(axis));
        strides.erase(strides.begin() + static_cast<std::ptrdiff_t>(axis));
    }
    copy(from, strides.data(), count.data(), count.size(), values.data());
}

void read_array(const RecordArray& array, const RecordExtents& first, const RecordExtents& count,
                std::vector<double>& values) {
    std::int64_t start = 0;
    for (std::size_t axis = 0; axis < first.size(); ++axis)
        start += static_cast<std::int64_t>(first[axis]) * array.strides[axis];
    if (array.type == RecordArray::Type::real64)
        read_from(static_cast<const double*>(array.data) + start, array.strides, count, values);
    else
        read_from(static_cast<const float*>(array.data) + start, array.strides, count, values);
}

}  // namespace

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

bool ArraySource::has(const std::string& path) const {
    return std::ranges::any_of(record_.arrays, [&](const RecordArray& array) {
        return array.path == path || array.path.starts_with(path + "/");
    });
}

DatasetPointer ArraySource::open(const std::string& path, Numbers) const {
    const auto found = std::ranges::find(record_.arrays, path, &RecordArray::path);
    if (found == record_.arrays.end()) throw RecordError(record_place(path), "is missing");
    if (found->extents.empty()) throw RecordError(record_place(path), "has no extents", "Give an array");
    return std::make_shared<RecordDataset>(record_place(path),
                                           RecordExtents(found->extents.begin(), found->extents.end()), found->epsilon,
                                           1, std::bind_front(read_array, std::cref(*found)));
}

std::vector<std::string> ArraySource::names_in(const std::string& group) const {
    std::set<std::string> names;
    const std::string start = group + "/";
    for (const RecordArray& array : record_.arrays)
        if (array.path.starts_with(start))
            names.insert(array.path.substr(start.size(), array.path.find('/', start.size()) - start.size()));
    return {names.begin(), names.end()};
}

bool ArraySource::has_attribute(const std::string& name, const std::string& path) const {
    return path.empty() ? name == "record_version" || record_.texts.contains(name) || record_.lists.contains(name)
                        : name == "dimension" && record_.dimensions.contains(path);
}

std::string ArraySource::text(const std::string& name, const std::string&) const { return record_.texts.at(name); }

ListEntries ArraySource::list(const std::string& name) const {
    const auto found = record_.lists.find(name);
    return found != record_.lists.end() ? found->second : RecordSource::list(name);
}

std::optional<double> ArraySource::number(const std::string&, const std::string& path) const {
    constexpr double version = 2;
    return path.empty() ? version : record_.dimensions.at(path);
}

}  // namespace credence
