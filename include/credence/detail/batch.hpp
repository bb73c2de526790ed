#pragma once
// Module engine: a batch: consecutive trials of one arm, as requested of a simulation, and the arrays for its results.

#include <cstdint>

namespace credence {

struct Control;

/// Sizes of a scenario's columns and series.
struct SimulationShape {
    int poses = 0;          ///< K
    int state_size = 0;     ///< n
    int column_count = 0, series_count = 0;
    int group_count = 0;    ///< component groups: the first series are their NEES, the whole state's first
};

/// Trials are stored eight by eight, adjacent to each other, so that a pack of lanes can be loaded and stored directly.
inline constexpr int octet = 8;

/// Eight running sums each, trial i of a batch added to number i mod 8 in trial order.
struct RunningSums {
    double* sums = nullptr;             ///< [series_count, K - 1, 8]
    double* square_sums = nullptr;      ///< [series_count, K - 1, 8]
    double* run_square_sums = nullptr;  ///< [series_count, 8] of each trial's sum over its steps
    std::int32_t* covered = nullptr;    ///< [groups, K - 1, levels] trials below the coverage bounds, not by eight
};

/// Consecutive trials of one arm, and the arrays for their results. Results are the same bits from every target. The
/// running sums are added to, of the trials that neither failed nor diverged; those of diverged ones are apart.
struct Batch : RunningSums {
    std::uint64_t root_seed = 0;
    std::int64_t first_trial = 0;
    int trials = 0;
    double* columns = nullptr;          ///< [octets, column_count, 8], a failed trial's still unfilled
    RunningSums (*of_diverged)(void* owner) = nullptr;  ///< gives those of diverged trials, if one is there
    void* owner = nullptr;                              ///< for it
    double* nees = nullptr;             ///< [K - 1, octets, 8] of the whole state, failed trials' too
    // Of detailed trials only; null for others.
    double* errors = nullptr;           ///< [n, K - 1, octets, 8] failed trials' too
    double* moments = nullptr;          ///< [moment_count, octets, 8] failed trials' too
    double* product_sums = nullptr;     ///< [lags, 8], added to: sums of products of whitened innovations
    double* product_square_sums = nullptr;  ///< [lags, 8], added to: of each trial's sum, squared
    double* product_counts = nullptr;   ///< [lags, 8], added to
    void* workspace = nullptr;          ///< workspace_size bytes from a 64-byte boundary on
    /// [K - 1] where only the commands are asked for that the arm's planner chooses in the first trial; else null.
    Control* commands = nullptr;
};

}  // namespace credence
