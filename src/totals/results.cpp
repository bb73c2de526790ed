#include <credence/detail/results.hpp>

#include "totals/visit_totals.hpp"

namespace credence {

std::string keep_name(Keep keep) { return keep == Keep::trials ? "trials" : "aggregates"; }

std::vector<const ArmResults*> arms_meant(const ScenarioResults& results, const std::string& name) {
    std::vector<const ArmResults*> meant;
    for (const ArmResults& arm : results.arms) {
        if (arm.name == name) return {&arm};
        if (controller_of(arm.name) == name) meant.push_back(&arm);
    }
    return meant;
}

const ArmResults* baseline_of(const ScenarioResults& results, const ArmResults& arm) {
    const std::vector<std::string>& baselines = results.scenario.baselines;
    const auto place = static_cast<std::size_t>(&arm - results.arms.data());
    for (const ArmResults& candidate : results.arms)
        if (place < baselines.size() && candidate.name == baselines[place]) return &candidate;
    return nullptr;
}

Moments column_moments(const ArmResults& arm, std::size_t column) {
    return moments_of(arm.totals.trials.columns[column]);
}

DifferenceTotals column_differences(const ScenarioResults& results, const ArmResults& a, const ArmResults& b,
                                    std::size_t column) {
    const auto place = [&](const ArmResults& arm) { return static_cast<std::size_t>(&arm - results.arms.data()); };
    return place(a) > place(b) ? a.totals.trials.differences[place(b)][column]
                               : b.totals.trials.differences[place(a)][column].reversed();
}

void add_totals(ArmResults& to, const ArmResults& from) {
    if (!from.totals.diverged.empty()) to.totals.of_diverged();
    to.totals.trials.add(from.totals.trials);
    visit_totals([](auto& sum, const auto& other) { add(sum, other); }, to.totals, from.totals);
}

}  // namespace credence
