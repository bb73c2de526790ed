// The expected memory and file size of a run.

#include "numeric/chi_square.hpp"
#include <credence/study.hpp>

#include <algorithm>

namespace credence {

namespace {

/// The memory of a scenario, for its totals and details and for the threads' current blocks, and its part of the file.
struct ScenarioFootprint {
    std::int64_t totals = 0, under_way = 0, file = 0;
};

ScenarioFootprint footprint_of(const ScenarioResults& results, std::int64_t trials, int threads) {
    const auto arms = static_cast<std::int64_t>(results.arms.size()),
               all_series = static_cast<std::int64_t>(results.all_series.size());
    const bool trials_kept = results.keep == Keep::trials;
    std::int64_t column_bytes = trials_kept ? 8 : 0;
    for (const Column& column : results.columns)
        if (trials_kept)
            column_bytes += column.type == ColumnType::real ? 8 : column.type == ColumnType::integer ? 4 : 1;
    const std::int64_t cells = all_series * results.steps(), numbers = results.steps() * (results.state_size() + 1),
                       moments = results.moment_count();
    const std::int64_t kept = std::min<std::int64_t>(trials, detailed_trials(results.steps(), results.state_size()));
    const std::int64_t distribution =
        distribution_counted(results.steps()) ? std::int64_t{results.steps()} * distribution_cells * 8 : 0;
    // A thread's running sums of octets, their squares and the series not yet folded; and details of its block, in the
    // engine's order and in that of the results. (This memory is free again when the blocks are committed.)
    const std::int64_t detailed_blocks = std::min<std::int64_t>(threads, (kept + block_size - 1) / block_size);
    const std::int64_t of_details =
        std::min<std::int64_t>(kept, block_size) * (numbers + moments) * 16 * detailed_blocks;
    return {totals_size(results, kept), arms * (threads * cells * 150 + of_details),
            arms * (trials * column_bytes + cells * 2 * 2 * 8 + (all_series + 20) * 1500 +
                    kept * (numbers * 4 + moments * 8) + distribution)};
}

}  // namespace

Footprint footprint(const Study& study, std::int64_t trials, int threads) {
    Footprint total;
    std::int64_t totals = 0, largest = 0, under_way = 0;
    for (const ScenarioResults& results : study.scenarios) {
        const ScenarioFootprint scenario = footprint_of(results, trials, threads);
        total.file += scenario.file;
        total.cells += static_cast<std::int64_t>(results.arms.size() * results.all_series.size()) * results.steps();
        totals += scenario.totals;
        largest = std::max(largest, scenario.totals);
        under_way = std::max(under_way, scenario.under_way);
    }
    // Totals of finished scenarios are dropped beyond a limit. The table at the end reads a few columns at once; the
    // threads have stacks, and blocks wait to be committed.
    total.memory =
        std::min(totals, most_totals_in_memory + largest) + under_way + static_cast<std::int64_t>(threads) * (16 << 20);
    if (keep_of(study) == Keep::trials) total.memory += 6 * trials * 8;
    // A scenario's settings, names and places in journal and file: measured with sweeps of 100 to 1,000 points.
    total.memory += static_cast<std::int64_t>(study.scenarios.size()) * (300 << 10);
    return total;
}

}  // namespace credence
