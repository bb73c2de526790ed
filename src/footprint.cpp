// What a run is expected to take.

#include <credence/chi_square.hpp>
#include <credence/study.hpp>

#include <algorithm>

namespace credence {

Footprint footprint(const Study& study, std::int64_t trials, int threads) {
    Footprint total;
    for (const ScenarioResults& results : study.scenarios) {
        const auto arms = static_cast<std::int64_t>(results.arms.size());
        const bool trials_kept = results.keep == Keep::trials;
        std::int64_t column_bytes = trials_kept ? 8 : 0, figures = static_cast<std::int64_t>(results.figures.size());
        for (const Column& column : results.columns)
            if (trials_kept) column_bytes += column.type == ColumnType::real ? 8 : column.type == ColumnType::integer ? 4 : 1;
        const std::int64_t cells = figures * results.steps();
        const std::int64_t kept = std::min<std::int64_t>(trials, detailed_trials(results.steps(), results.state_size()));
        const std::int64_t detail = kept * results.steps() * (results.state_size() + 1) * 4;
        const std::int64_t shape = shape_counted(results.steps()) ? std::int64_t{results.steps()} * shape_cells * 8 : 0;
        total.file += arms * (trials * column_bytes + cells * 2 * 2 * 8 + (figures + 20) * 1500 + detail + shape);
        total.memory += arms * (cells * 2 * 64 + 4 * detail + 2 * shape);
    }
    // The table at the end looks at a few columns at once; the threads have stacks, and blocks wait to be committed.
    if (keep_of(study) == Keep::trials) total.memory += 6 * trials * 8;
    total.memory += static_cast<std::int64_t>(threads) * (16 << 20);
    return total;
}

}  // namespace credence
