#include "files/results/parts.hpp"

#include <credence/error.hpp>

#include <algorithm>

namespace credence {

std::vector<std::string> series_links(const ScenarioResults& results) {
    std::vector<std::string> names;
    for (const Series& series : results.all_series) {
        names.push_back(series.name + "_total");
        if (!series.integer) names.push_back(series.name + "_square_total");
        names.push_back(series.name + "_run_square_total");
        if (series.role == SeriesRole::nees) names.push_back(coverage_name(series));
    }
    return names;
}

std::vector<std::string> arm_links(const ScenarioResults& results) {
    std::vector<std::string> names = series_links(results);
    names.insert(names.end(), {"step", "part", "level"});
    if (results.keep == Keep::trials) {
        names.push_back("trial");
        for (const Column& column : results.columns) names.push_back(column.name);
    } else {
        names.insert(names.end(), {"first_block", "last_block"});
    }
    const std::vector<std::string> totals = trial_totals_links(results.arms.size());
    names.insert(names.end(), totals.begin(), totals.end());
    const std::vector<std::string> evidence = evidence_links(results);
    names.insert(names.end(), evidence.begin(), evidence.end());
    return names;
}

void refuse_clashing_links(const Study& study) {
    for (const ScenarioResults& results : study.scenarios) {
        std::vector<std::string> names = arm_links(results);
        names.push_back(without_diverged);
        std::ranges::sort(names);
        if (const auto twice = std::ranges::adjacent_find(names); twice != names.end())
            throw InputError("cannot store scenario " + results.scenario.name,
                             "its world " + results.scenario.world +
                                 " names columns, groups or components so that two datasets would be " + *twice,
                             "Rename one of them in the world");
    }
}

}  // namespace credence
