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
    return {{"file", side.file},
            {"source", side.source},
            {"trials", side.trials},
            {"failed", side.failed},
            {"lost", side.lost},
            {"failed_trials", side.failed_trials()}};
}

Json pair_json(const ComparedPair& pair, std::uint64_t root_seed) {
    Json json{{"scenario", pair.comparison.scenario},
              {"a", pair.comparison.a},
              {"b", pair.comparison.b},
              {"trials", pair.trials},
              {"pairs", pair.pairs()},
              {"conclusion", conclusion_name(pair.conclusion)},
              {"pair", pair.comparison.name()}};
    Json behind{{"same_world", !of_different_worlds(pair)}, {"differences", Json::object()}};
    for (const KeyDifference& key : pair.differences) behind["differences"][key.key] = Json::array({key.a, key.b});
    behind["of_a"] = side_json(pair.a);
    behind["of_b"] = side_json(pair.b);
    behind["root_seed"] = root_seed;
    behind["complete"] = pair.complete;
    for (const bool lower : {true, false}) {
        Json& names = behind[lower ? "lower" : "higher"] = Json::array();
        for (const ComparedColumn& column : pair.comparison.columns)
            if (differs(column) && (column.paired.difference.mean < 0) == lower) names.push_back(column.name);
    }
    const auto column_json = [&](const ComparedColumn& column) {
        const auto f = static_cast<std::size_t>(&column - pair.comparison.columns.data());
        Json one = compared_json(column);
        one["mean_a"] = pair.a.mean[f];
        one["mean_b"] = pair.b.mean[f];
        return one;
    };
    add_columns(json, pair.comparison.columns, column_json, behind);
    return json;
}

std::string csv_of(const ComparedPair& pair, std::size_t column) {
    const ComparedColumn& compared = pair.comparison.columns[column];
    const PairedComparison& paired = compared.paired;
    const Summary& difference = paired.difference;
    std::vector<Cell> cells{pair.comparison.scenario,
                            pair.comparison.a,
                            pair.comparison.b,
                            compared.name,
                            compared.unit,
                            exact_cell(static_cast<double>(paired.pairs))};
    for (const double value :
         {pair.a.mean[column], pair.b.mean[column], difference.mean, difference.standard_error, difference.ci95.low,
          difference.ci95.high, paired.bootstrap95.low, paired.bootstrap95.high, difference.median,
          difference.standard_deviation, paired.wins_a, paired.wins_b, paired.ties, paired.wilcoxon_z,
          paired.wilcoxon_p, compared.holm_p, paired.effect_size, paired.variance_reduction})
        cells.push_back(exact_cell(value));
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
        "median,sd,below,above,ties,wilcoxon_z,wilcoxon_p,holm_p,effect_size,variance_reduction\n";
    for (const ComparedPair& pair : report.pairs)
        for (std::size_t f = 0; f < pair.comparison.columns.size(); ++f) text += csv_of(pair, f);
    return text;
}

}  // namespace credence
