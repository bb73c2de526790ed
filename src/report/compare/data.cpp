// Machine-readable output of a comparison: JSON and CSV.

#include <cmath>
#include "report/compare/compare.hpp"
#include <credence/text.hpp>

#include "report/compare/choice.hpp"
#include "report/data/json.hpp"
#include "report/table.hpp"

namespace credence {

namespace {

Json side_json(const ComparedSide& side) {
    Json json{{"file", side.file},     {"source", side.source},     {"trials", side.trials},
              {"failed", side.failed}, {"diverged", side.diverged}, {"failed_trials", side.failed_trials()}};
    if (side.verdict) json["verdict"] = verdict_name(*side.verdict);
    if (side.steps > 0) json["steps"] = side.steps;
    return json;
}

/// What is said of a column; CSV has the same.
Json column_json(const ComparedPair& pair, const ComparedColumn& column) {
    const auto c = static_cast<std::size_t>(&column - pair.comparison.columns.data());
    Json json = compared_json(column);
    json["mean_a"] = pair.a.mean[c];
    json["mean_b"] = pair.b.mean[c];
    json["sign_p"] = column.paired.sign_p;
    json["carried_by"] = column.paired.carrying.count;
    json["carriers"] = column.paired.carrying.first;
    return json;
}

/// More failures come before a better mean of what did not fail.
std::string overall(const ComparedPair& pair) {
    return pair.failures == Conclusion::higher  ? "fails more often"
           : pair.failures == Conclusion::lower ? "fails less often"
                                                : conclusion_name(pair.conclusion);
}

Json pair_json(const ComparedPair& pair, std::uint64_t root_seed) {
    Json json{{"scenario", pair.comparison.scenario},
              {"a", pair.comparison.a},
              {"b", pair.comparison.b},
              {"trials", pair.trials},
              {"pairs", pair.pairs()},
              {"conclusion", overall(pair)},
              {"conclusion_of_mean", conclusion_name(pair.conclusion)},
              {"failure_p", pair.failure_p},
              {"pair", pair.comparison.name()}};
    Json behind{{"same_world", !of_different_worlds(pair)}, {"differences", Json::object()}};
    for (const KeyDifference& key : pair.differences) behind["differences"][key.key] = Json::array({key.a, key.b});
    behind["of_a"] = side_json(pair.a);
    behind["of_b"] = side_json(pair.b);
    if (pair.with_truth)
        behind["with_truth"] = {{"mean", pair.with_truth->mean}, {"ci95", interval_json(pair.with_truth->ci95)}};
    if (pair.steps_of_any > 0) behind["steps"] = {{"any", pair.steps_of_any}, {"compared", pair.steps_of_all}};
    behind["root_seed"] = root_seed;
    behind["complete"] = pair.complete;
    for (const auto& [column, conclusion] : pair.further)
        behind["conclusions"][pair.comparison.columns[column].name] = conclusion_name(conclusion);
    for (const bool lower : {true, false}) {
        Json& names = behind[lower ? "lower" : "higher"] = Json::array();
        for (const ComparedColumn& column : pair.comparison.columns)
            if (differs(column) && (column.paired.difference.mean < 0) == lower) names.push_back(column.name);
    }
    add_columns(
        json, pair.comparison.columns, [&](const ComparedColumn& column) { return column_json(pair, column); }, behind);
    return json;
}

/// The numbers of a row, by their names in JSON; of an interval there are both ends.
constexpr const char* csv_numbers[] = {"mean_a", "mean_b", "mean", "se", "ci95", "bootstrap95", "median", "sd",
                                       "below", "above", "ties", "sign_p", "carried_by", "wilcoxon_z", "wilcoxon_p",
                                       "holm_p", "effect_size", "variance_reduction"};

std::string csv_of(const ComparedPair& pair, const ComparedColumn& column) {
    const Json json = column_json(pair, column);
    std::vector<Cell> cells{pair.comparison.scenario, pair.comparison.a, pair.comparison.b, column.name, column.unit,
                            std::to_string(column.paired.pairs)};
    for (const char* name : csv_numbers)
        for (const Json& number : json[name].is_array() ? json[name] : Json::array({json[name]}))
            cells.push_back(exact_cell(number.get<double>()));
    return csv_row(cells);
}

}  // namespace

std::string compare_json(const CompareReport& report) {
    Json array = Json::array();
    for (const ComparedPair& pair : report.pairs) array.push_back(pair_json(pair, report.root_seed));
    // The name of a file may not be UTF-8.
    return array.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string compare_csv(const CompareReport& report) {
    std::string text =
        "scenario,a,b,name,unit,pairs,mean_a,mean_b,mean,se,ci95_low,ci95_high,bootstrap95_low,bootstrap95_high,"
        "median,sd,below,above,ties,sign_p,carried_by,wilcoxon_z,wilcoxon_p,holm_p,effect_size,variance_reduction\n";
    for (const ComparedPair& pair : report.pairs)
        for (const ComparedColumn& column : pair.comparison.columns) text += csv_of(pair, column);
    return text;
}

}  // namespace credence
