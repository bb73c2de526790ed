#pragma once
// Room 9: the door between the engine and the units: the same source, compiled once for each instruction set.

#include <credence/problem.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace credence {

/// Trials are kept eight by eight, one next to the other: a pack of lanes finds its numbers where they belong.
inline constexpr int octet = 8;

/// Consecutive trials of one arm, and where their results go. Results are the same bits from every unit. Sums are eight
/// running sums, trial i of the batch going to the one of i mod 8 in trial order; failed trials do not enter them.
struct Batch {
    Arm arm;
    std::uint64_t root_seed = 0;
    std::int64_t first_trial = 0;
    int trials = 0;
    double* columns = nullptr;          ///< [octets, column_count, 8], a failed trial's still unfilled
    double* sums = nullptr;             ///< [figure_count, K - 1, 8], added to
    double* square_sums = nullptr;      ///< [figure_count, K - 1, 8], added to
    double* run_square_sums = nullptr;  ///< [figure_count, 8], added to: of each trial's sum over its steps
    std::int32_t* covered = nullptr;    ///< [blocks, K - 1, levels], added to: trials below the coverage bounds
    double* nees = nullptr;             ///< [K - 1, octets, 8] of the whole state, failed trials' too
    // Of detailed trials only; null for others.
    double* errors = nullptr;           ///< [n, K - 1, octets, 8] failed trials' too
    double* product_sums = nullptr;     ///< [lags, 8], added to: sums of products of whitened innovations
    double* product_square_sums = nullptr;  ///< [lags, 8], added to: of each trial's sum, squared
    double* product_counts = nullptr;   ///< [lags, 8], added to
    void* workspace = nullptr;          ///< workspace_size bytes from a 64-byte boundary on
};

using SimulateFunction = void (*)(const ProblemView&, const Batch&);

/// A unit by name: v4 (AVX-512), v3 (AVX2 and FMA) or portable; with the number of trials it runs at once.
struct Unit {
    std::string name;
    int lanes = 1;
    SimulateFunction simulate = nullptr;
    std::size_t (*workspace_size)(const ProblemView&, Estimator) = nullptr;
};

/// What a unit compiled from src/simulate_unit.cpp offers under its name, and its entry in a list of units.
#define CREDENCE_DECLARE_UNIT(name)                    \
    namespace name {                                   \
    void simulate(const ProblemView&, const Batch&);   \
    std::size_t workspace_size(const ProblemView&, Estimator); \
    }
#define CREDENCE_LIST_UNIT(name, lanes) Unit{#name, lanes, name::simulate, name::workspace_size}

/// Environment variable that names the unit to run, for tests.
inline constexpr const char* force_unit_variable = "CREDENCE_FORCE_UNIT";

/// Every unit that was built and that this processor can run, the best one first.
std::vector<Unit> runnable_units();

/// The unit that runs where none is named: the first runnable one, or the one that CREDENCE_FORCE_UNIT names. Throws
/// InputError where that is none of runnable_units; who computes calls this before anything else.
Unit best_unit();

}  // namespace credence
