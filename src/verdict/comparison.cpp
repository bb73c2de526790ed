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

std::int64_t CommonTrials::row_of_a(std::int64_t place) const {
    auto span = spans_.begin();
    for (; place >= span->rows; ++span) place -= span->rows;
    return span->a + place;
}

std::vector<double> CommonTrials::selected(const std::vector<double>& values, std::int64_t Span::* first) const {
    std::vector<double> chosen;
    chosen.reserve(static_cast<std::size_t>(count_));
    for (const Span& span : spans_)
        chosen.insert(chosen.end(), values.begin() + span.*first, values.begin() + span.*first + span.rows);
    return chosen;
}

namespace {

/// `c`, `other`: where each has the column.
PairedComparison compare_column(const ComparedArm& a, const ComparedArm& b, std::size_t c, std::size_t other,
                                const CommonTrials& common, std::uint64_t root_seed, const std::string& key) {
    if (a.results.keep == Keep::aggregates)
        return compare_totals(column_differences(a.results, a.arm, b.arm, c), a.arm.totals.trials.columns[c],
                              b.arm.totals.trials.columns[c]);
    PairedComparison paired = compare_paired(common.of_a(figure_values(a.results, a.arm, c)),
                                             common.of_b(figure_values(b.results, b.arm, other)), root_seed, key);
    for (std::int64_t& trial : paired.carrying.first)
        trial = trial_numbers(a.results, common.row_of_a(trial), 1).front();
    return paired;
}

}  // namespace

Comparison compare_arms(const ComparedArm& a, const ComparedArm& b, std::uint64_t root_seed) {
    if ((a.results.keep == Keep::aggregates || b.results.keep == Keep::aggregates) && &a.results != &b.results)
        throw std::logic_error("totals of different files have no pairs");
    Comparison comparison{a.results.scenario.name, a.label, b.label, {}};
    const CommonTrials common(a.results, b.results);
    for (std::size_t c = 0; c < a.results.columns.size(); ++c)
        if (const Column& column = a.results.columns[c]; is_reported(column)) {
            const auto same = std::ranges::find(b.results.columns, column.name, &Column::name);
            if (same == b.results.columns.end()) continue;  // a file of before the column
            const auto other = static_cast<std::size_t>(same - b.results.columns.begin());
            const std::string key = comparison.scenario + "/" + comparison.name() + "/" + column.name;
            comparison.columns.push_back(
                {column.name, column.unit, compare_column(a, b, c, other, common, root_seed, key), 0, column.places});
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

std::vector<Comparison> planned_against_baselines(const std::vector<ScenarioResults>& scenarios,
                                                  std::uint64_t root_seed) {
    std::vector<Comparison> comparisons;
    for (const ScenarioResults& results : scenarios)
        for (const ArmResults& arm : results.arms)
            if (const ArmResults* baseline = baseline_of(results, arm))
                comparisons.push_back(
                    compare_arms({results, arm, arm.name}, {results, *baseline, baseline->name}, root_seed));
    correct_together(comparisons);
    return comparisons;
}

}  // namespace credence
