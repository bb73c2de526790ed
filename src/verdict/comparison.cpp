#include <credence/detail/comparison.hpp>

#include <algorithm>
#include <stdexcept>

namespace credence {

CommonTrials::CommonTrials(const ScenarioResults& a, const ScenarioResults& b) {
    for (std::size_t place = 0; place < a.blocks.size(); ++place) {
        const std::optional<std::int64_t> row_b = first_row(b, a.blocks[place]);
        if (!row_b) continue;
        const std::int64_t row_a = block_size * static_cast<std::int64_t>(place);
        const std::int64_t rows =
            std::min(block_rows(a, place), block_rows(b, static_cast<std::size_t>(*row_b / block_size)));
        count_ += rows;
        if (!spans_.empty() && spans_.back().a + spans_.back().rows == row_a &&
            spans_.back().b + spans_.back().rows == *row_b)
            spans_.back().rows += rows;
        else
            spans_.push_back({row_a, *row_b, rows});
    }
}

std::vector<double> CommonTrials::selected(const std::vector<double>& values, std::int64_t Span::* first) const {
    std::vector<double> chosen;
    chosen.reserve(static_cast<std::size_t>(count_));
    for (const Span& span : spans_)
        chosen.insert(chosen.end(), values.begin() + span.*first, values.begin() + span.*first + span.rows);
    return chosen;
}

namespace {

Comparison compare_aggregates(const ComparedArm& a, const ComparedArm& b) {
    if (&a.results != &b.results) throw std::logic_error("totals of different files have no pairs");
    Comparison comparison{a.results.scenario.name, a.label, b.label, {}};
    for (std::size_t c = 0; c < a.results.columns.size(); ++c)
        if (const Column& column = a.results.columns[c]; is_reported(column))
            comparison.columns.push_back({column.name, column.unit,
                                          compare_totals(aggregate_differences(a.results, a.arm, b.arm, c),
                                                         a.arm.aggregates.columns[c], b.arm.aggregates.columns[c]),
                                          0});
    return comparison;
}

}  // namespace

Comparison compare_arms(const ComparedArm& a, const ComparedArm& b, std::uint64_t root_seed) {
    if (a.results.keep == Keep::aggregates || b.results.keep == Keep::aggregates) return compare_aggregates(a, b);
    Comparison comparison{a.results.scenario.name, a.label, b.label, {}};
    const CommonTrials common(a.results, b.results);
    for (std::size_t c = 0; c < a.results.columns.size(); ++c) {
        const Column& column = a.results.columns[c];
        if (!is_reported(column)) continue;
        const std::vector<double> of_a = common.of_a(figure_values(a.results, a.arm, c)),
                                  of_b = common.of_b(figure_values(b.results, b.arm, c));
        const std::string key = comparison.scenario + "/" + comparison.name() + "/" + column.name;
        comparison.columns.push_back({column.name, column.unit, compare_paired(of_a, of_b, root_seed, key), 0});
    }
    return comparison;
}

void correct_together(std::vector<Comparison>& comparisons) {
    std::vector<double> p;
    for (const Comparison& comparison : comparisons)
        for (const ComparedColumn& column : comparison.columns) p.push_back(column.paired.wilcoxon_p);
    const std::vector<double> corrected = holm(p);
    auto next = corrected.begin();
    for (Comparison& comparison : comparisons)
        for (ComparedColumn& column : comparison.columns) column.holm_p = *next++;
}

std::vector<Comparison> planned_against_baselines(const Study& study) {
    std::vector<Comparison> comparisons;
    for (const ScenarioResults& results : study.scenarios)
        for (const ArmResults& arm : results.arms)
            if (const ArmResults* baseline = baseline_of(results, arm))
                comparisons.push_back(
                    compare_arms({results, arm, arm.name}, {results, *baseline, baseline->name}, study.root_seed));
    correct_together(comparisons);
    return comparisons;
}

}  // namespace credence
