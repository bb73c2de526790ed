#include "scenario/state_series.hpp"

#include <algorithm>

namespace credence {

namespace {

std::string described(const ComponentGroup& block) { return block.name == "all" ? "the whole state" : block.name; }
std::string suffix(const ComponentGroup& block) { return block.name == "all" ? "" : "_" + block.name; }

}  // namespace

std::string squared_unit(const std::vector<Component>& components, const ComponentGroup& block) {
    std::vector<std::string> units;
    for (int i = block.first; i < block.first + block.count; ++i) {
        const std::string& unit = components[static_cast<std::size_t>(i)].unit;
        if (std::find(units.begin(), units.end(), unit) == units.end()) units.push_back(unit);
    }
    std::string text;
    for (const std::string& unit : units)
        text += (text.empty() ? "" : " + ") + (unit == "1" ? unit : unit.find('/') == std::string::npos ? unit + "^2" : "(" + unit + ")^2");
    return text;
}

StateSeries::StateSeries(const std::vector<Component>& components, const std::vector<ComponentGroup>& blocks,
                           Innovations innovations) {
    const auto add = [&](const std::string& name, const std::string& long_name, const std::string& unit,
                         SeriesRole role, int dimension, const std::string& part) {
        list.push_back({name, long_name, unit, role, dimension, false, part, "", 0});
    };
    for (const ComponentGroup& block : blocks)
        add("nees" + suffix(block), "normalised estimation error squared of " + described(block), "1",
            SeriesRole::nees, block.count, block.name);
    if (innovations == Innovations::given) {
        nis = list.size();
        add("nis", "normalised innovation squared of all rows", "1", SeriesRole::nis, 0, "all");
        list.back().rows = "nis_rows";
        rows = list.size();
        add("nis_rows", "measurement rows", "1", SeriesRole::rows, 0, "all");
        list.back().integer = true;
    }
    squared_error = list.size();
    for (const ComponentGroup& block : blocks)
        add("squared_error" + suffix(block), "squared error of " + described(block), squared_unit(components, block),
            SeriesRole::squared_error, block.count, block.name);
    variance = list.size();
    for (const ComponentGroup& block : blocks)
        add(block.name == "all" ? "trace_P_step" : "variance" + suffix(block),
            "trace of the covariance of " + described(block), squared_unit(components, block), SeriesRole::variance,
            block.count, block.name);
    standardised_error = list.size();
    for (const Component& component : components)
        add("standardised_error_" + component.name,
            "error of " + component.name + " over its predicted standard deviation", "1",
            SeriesRole::standardised_error, 1, component.name);
}

}  // namespace credence
