#pragma once
// Module engine: the block: 256 consecutive trials of one scenario under every arm. It is a pure function of (scenario,
// root seed, block index): threads, shards and resumed runs only choose which blocks to run.

#include <credence/detail/block_ranges.hpp>
#include <credence/detail/world.hpp>

#include <cstdint>
#include <vector>

namespace credence {

/// Sums of the series over some trials of a block.
struct SeriesSums {
    std::vector<double> sums;               ///< [series_count, K - 1]
    std::vector<double> square_sums;        ///< [series_count, K - 1]
    std::vector<double> run_square_sums;    ///< [series_count], of each trial's sum over its steps
    std::vector<std::int32_t> covered;      ///< [component groups, K - 1, levels] trials below each coverage bound
};

/// One arm's part of a block. Sums are over the trials that neither failed nor diverged: eight running sums, trial i
/// added to number i mod 8 in trial order, which are then added up in order. The result is the same for every lane
/// width up to 8.
struct ArmBlock : SeriesSums {
    SeriesSums diverged;                    ///< over diverged trials; empty where there are none
    std::vector<double> columns;            ///< [columns, trials], failed trials filled
    std::vector<std::uint16_t> cells;       ///< [K - 1, trials] cell of the NEES of the whole state, no_cell if failed
    int counted = 0;                        ///< trials that did not fail
    double seconds = 0;                     ///< that they took: no result

    // Of detailed trials only, else empty.
    std::vector<float> errors;              ///< [trials, K - 1, n], NaN if failed
    std::vector<float> nees;                ///< [trials, K - 1] of the whole state, NaN if failed
    std::vector<double> moments;            ///< [trials, moment_count], NaN if failed
    std::vector<double> product_sums;       ///< [lags] of products of whitened innovations, a lag apart
    std::vector<double> product_square_sums;///< [lags] of each trial's sum, squared
    std::vector<double> product_counts;     ///< [lags]
};
inline constexpr std::uint16_t no_cell = 0xffff;

struct Block {
    std::int64_t index = 0;
    int trials = 0;
    std::vector<ArmBlock> arms;             ///< in the order of the declaration
};

/// Whether the trials of a block are detailed: either all of them are or none.
bool detailed(const SimulationShape& shape, std::int64_t index);

/// A scenario prepared for running its blocks.
class BlockRunner {
public:
    BlockRunner(const World& world, const Scenario& scenario);

    /// Simulates the first `trials` trials of a block. Thread-safe.
    Block run(std::uint64_t root_seed, std::int64_t index, int trials) const;
    /// Throws InputError where its trials do not repeat themselves [Simulation].
    void check_repeats(std::uint64_t root_seed) const { simulation_->check_repeats(root_seed); }

private:
    std::vector<Column> columns_;
    std::size_t arms_ = 0;
    std::unique_ptr<const Simulation> simulation_;
};

/// The same for any simulation with these columns and this number of arms.
Block run_block(const Simulation& simulation, const std::vector<Column>& columns, std::size_t arms,
                std::uint64_t root_seed, std::int64_t index, int trials);

/// Frees the memory in which blocks were computed, except for what a thread uses now.
void free_workspaces();

}  // namespace credence
