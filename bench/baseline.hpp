#pragma once
// The baselines: a whole trial of docs/model.md as a user of Eigen would write it, one trial at a time.
//   A  everything dynamic, the formulas as written (baseline_dynamic.cpp)
//   B  fixed sizes, Cholesky instead of an inverse, nothing on the heap (baseline_fixed.cpp)
// This header does not include Eigen, so that only the baselines are compiled for the machine they run on.

#include "slam/trial/problem.hpp"
#include <cstdint>
#include <memory>

namespace credence::bench {

/// standard: std::mt19937_64 and std::normal_distribution, seeded for each trial, as most people write it; keyed:
/// credence's own draws, so that columns can be compared.
enum class Draws { standard, keyed };

/// The first columns of ColumnIndex; the baselines have no status.
inline constexpr int compared_columns = column_nis_ratio + 1;

/// One arm of a scenario, prepared: everything that trials have in common is computed once.
class Baseline {
public:
    virtual ~Baseline() = default;
    /// Runs one trial; `columns` [compared_columns].
    virtual void run(std::uint64_t root_seed, std::int64_t trial, double* columns) = 0;
};

/// The Problem must outlive the baseline. Covered are the scenarios of the benchmarks: deformation that jitters, no
/// noise of the edges' own, no detection below 1, no initial pose noise, no truncation, factors of 1 but on Q, N.
std::unique_ptr<Baseline> make_dynamic(const ProblemView& problem, Controller controller, Draws draws);

/// The same, or nothing where no such size was compiled: M = 3, and with the heading model also 1, 2, 4, 6, 8.
std::unique_ptr<Baseline> make_fixed(const ProblemView& problem, Controller controller, Draws draws);

}  // namespace credence::bench
