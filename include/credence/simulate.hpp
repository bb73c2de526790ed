#pragma once
// Room 9: the door between the engine and the units: the same source, compiled once for each instruction set.

#include <credence/problem.hpp>

#include <cstdint>
#include <string>

namespace credence {

/// Trials are stored eight by eight, one next to the other: a pack of lanes writes its results where they belong.
inline constexpr int octet = 8;

/// Consecutive trials of one arm. Results are the same bits from every unit.
struct Batch {
    Controller controller = Controller::fixed;
    std::uint64_t root_seed = 0;
    std::int64_t first_trial = 0;
    int trials = 0;
    double* columns = nullptr;  ///< [octets, column_count, 8], a failed trial's still unfilled
    double* figures = nullptr;  ///< [octets, figure_count, K - 1, 8]
    double* scratch = nullptr;  ///< [column_count + figure_count (K - 1), 8], aligned to 64 bytes
};

using SimulateFunction = void (*)(const ProblemView&, const Batch&);

/// A unit by name: v4 (AVX-512), v3 (AVX2 and FMA) or portable; with the number of trials it runs at once.
struct Unit {
    std::string name;
    int lanes = 1;
    SimulateFunction simulate = nullptr;
};

/// Every unit that was built and that this processor can run, the best one first.
std::vector<Unit> runnable_units();
Unit best_unit();

}  // namespace credence
