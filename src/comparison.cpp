#include <credence/comparison.hpp>

#include <algorithm>

namespace credence {

Comparison compare_arms(const ComparedArm& a, const ComparedArm& b, std::uint64_t root_seed) {
    Comparison comparison{a.results.scenario.name, a.label, b.label, {}};
    for (std::size_t c = 0; c < a.results.columns.size(); ++c) {
        const Column& column = a.results.columns[c];
        if (!is_figure(column)) continue;
        std::vector<double> of_a = figure_values(a.arm, c), of_b = figure_values(b.arm, c);
        const std::size_t trials = std::min(of_a.size(), of_b.size());
        of_a.resize(trials);
        of_b.resize(trials);
        const std::string figure = comparison.scenario + "/" + comparison.name() + "/" + column.name;
        comparison.figures.push_back({column.name, column.unit, compare_paired(of_a, of_b, root_seed, figure), 0});
    }
    return comparison;
}

void correct_together(std::vector<Comparison>& comparisons) {
    std::vector<double> p;
    for (const Comparison& comparison : comparisons)
        for (const ComparedFigure& figure : comparison.figures) p.push_back(figure.paired.wilcoxon_p);
    const std::vector<double> corrected = holm(p);
    auto next = corrected.begin();
    for (Comparison& comparison : comparisons)
        for (ComparedFigure& figure : comparison.figures) figure.holm_p = *next++;
}

std::vector<Comparison> planned_against_fixed(const Study& study) {
    std::vector<Comparison> comparisons;
    for (const ScenarioResults& results : study.scenarios)
        for (const ArmResults& arm : results.arms)
            if (const ArmResults* partner = fixed_partner(results, arm))
                comparisons.push_back(
                    compare_arms({results, arm, arm.name}, {results, *partner, partner->name}, study.root_seed));
    correct_together(comparisons);
    return comparisons;
}

}  // namespace credence
