#include "files/hdf5/read.hpp"
#include "files/results/format.hpp"

namespace credence {

namespace {

std::string keys_of(const SweepPoint& point) {
    std::vector<std::string> keys;
    for (const SweepCoordinate& one : point.at) keys.push_back(one.key);
    return joined(keys, " ");
}

std::string attribute_of(const SweepCoordinate& one) { return "sweep." + one.key; }

}  // namespace

void write_sweep(const hdf5::Handle& group, const SweepPoint& point) {
    if (point.at.empty()) return;
    hdf5::write_text(group, "sweep_of", point.of);
    hdf5::write_text(group, "sweep_keys", keys_of(point));
    for (const SweepCoordinate& one : point.at)
        if (const std::optional<double> number = to_number(one.value))
            hdf5::write_number<double>(group, attribute_of(one), *number);
        else
            hdf5::write_text(group, attribute_of(one), one.value);
}

void check_sweep(const hdf5::Handle& group, const SweepPoint& point) {
    const auto require = [&](const std::string& attribute, bool agrees) {
        if (!agrees)
            throw hdf5::Error(hdf5::attribute_place(group, attribute), "does not agree with the scenario's [sweep]");
    };
    std::size_t found = 0;
    for (const std::string& name : hdf5::attribute_names(group)) found += name.starts_with("sweep");
    require("sweep_keys", found == (point.at.empty() ? 0 : 2 + point.at.size()));
    if (point.at.empty()) return;
    require("sweep_of", hdf5::read_text(group, "sweep_of") == point.of);
    require("sweep_keys", hdf5::read_text(group, "sweep_keys") == keys_of(point));
    for (const SweepCoordinate& one : point.at)
        if (const std::optional<double> number = to_number(one.value))
            require(attribute_of(one), hdf5::read_number<double>(group, attribute_of(one)) == *number);
        else
            require(attribute_of(one), hdf5::read_text(group, attribute_of(one)) == one.value);
}

}  // namespace credence
