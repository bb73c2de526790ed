#include "study_hash_repair.hpp"

#include <credence/error.hpp>
#include <credence/ini.hpp>
#include <credence/study.hpp>

#include <algorithm>
#include <string>

namespace credence::fuzz {

namespace {

constexpr std::uint8_t attribute_message = 12;

/// The value of an attribute, if it has that name: what is behind its name, type and extents.
Image attribute_value(Image body, const std::string& name) {
    const std::uint64_t version = number_at(body, 0, 1), name_size = number_at(body, 2, 2);
    const std::size_t name_at = version == 3 ? 9 : 8;
    if ((version != 2 && version != 3) || name_size != name.size() + 1 || !holds(body, name_at, name_size)) return {};
    if (!std::equal(name.begin(), name.end(), body.begin() + static_cast<std::ptrdiff_t>(name_at))) return {};
    const std::size_t value_at = name_at + name_size + number_at(body, 4, 2) + number_at(body, 6, 2);
    return value_at < body.size() ? body.subspan(value_at) : Image{};
}

std::vector<Image> attribute_values(Image image, const Structure& structure, const std::string& name) {
    std::vector<Image> values;
    for (const Region& region : structure.regions) {
        if (region.type != attribute_message) continue;
        const Image value = attribute_value(image.subspan(region.first, region.length), name);
        if (!value.empty()) values.push_back(value);
    }
    return values;
}

std::string text_of(Image value) {
    std::string text(value.begin(), value.end());
    text.resize(text.find_last_not_of('\0') + 1);
    return text;
}

}  // namespace

void repair_study_hash(Image image) {
    const Structure structure = structure_of(image);
    const auto hashes = attribute_values(image, structure, "study_hash");
    const auto seeds = attribute_values(image, structure, "root_seed");
    if (hashes.size() != 1 || seeds.size() != 1) return;
    Study study;
    study.root_seed = number_at(seeds[0], 0, 8);
    const bool aggregates = !attribute_values(image, structure, "keep").empty();
    try {
        for (const Image text : attribute_values(image, structure, "scenario")) {
            ScenarioResults& results = study.scenarios.emplace_back();
            results.scenario = read_scenario_text(text_of(text), "image", "scenario");
            results.keep = aggregates ? Keep::aggregates : Keep::trials;
        }
    } catch (const InputError&) {
        return;
    }
    const std::string hash = study_hash(study);
    if (hashes[0].size() >= hash.size()) std::copy(hash.begin(), hash.end(), hashes[0].begin());
}

}  // namespace credence::fuzz
