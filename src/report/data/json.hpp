#pragma once
// Parts of a report as JSON. NaN becomes null.

#include <credence/detail/comparison.hpp>
#include <credence/evidence.hpp>
#include <credence/detail/sweep.hpp>

#include <nlohmann/json.hpp>

namespace credence {

using Json = nlohmann::ordered_json;

inline Json interval_json(const Interval& interval) { return Json::array({interval.low, interval.high}); }

/// What `get` makes of each of a list, as a list.
template <class T, class Get>
Json each_json(const std::vector<T>& list, const Get& get) {
    Json json = Json::array();
    for (const T& item : list) json.push_back(get(item));
    return json;
}

/// All of an arm's evidence, by step where it has steps.
Json evidence_json(const Evidence& evidence);

/// The place of a scenario in its sweep: numbers as numbers.
Json sweep_json(const SweepPoint& sweep);

/// What is said of the pairs' values of a column.
Json compared_json(const ComparedColumn& column);

/// Puts the members that follow the columns' behind them. A column whose name means something else in the object has
/// the member `column NAME`.
template <class Columns, class Value>
void add_columns(Json& json, const Columns& columns, const Value& value_of, const Json& behind) {
    for (const auto& column : columns) {
        const bool taken = json.contains(column.name) || behind.contains(column.name);
        json[(taken ? "column " : "") + column.name] = value_of(column);
    }
    json.update(behind);
}

}  // namespace credence
