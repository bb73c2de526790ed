#pragma once
// Whole trials: credence on every target, and the baselines, on the same rows in the same run.

#include "kernels.hpp"
#include "measure.hpp"
#include "rows.hpp"
#include "table.hpp"

namespace credence::bench {

/// Registers trial/NAME/TARGET, trial/NAME/A and trial/NAME/B of every row.
void add_trials(const std::deque<Row>& rows, const Effort& effort);

/// Whether baseline A is run on a row: its joint update grows with the sixth power of M.
bool has_dynamic(const Row& row);

/// Throws where a baseline's columns, or the counted engine's, are not credence's.
void require_agreement(const std::deque<Row>& rows, const Effort& effort);

/// Registers a benchmark of a target's fused multiply-adds; returns the measured GFLOP/s.
void add_peak(const std::string& name, const Kernels& kernels, const Effort& effort);
double peak_of(const Samples& samples, const Kernels& kernels);

/// Measures the rows: a table for the best target, and one for the others.
std::vector<Table> trial_tables(const std::string& key, const std::string& title, const std::deque<Row>& rows);

/// Registers estimator/NAME of every estimator and controller, on the best target; and their table.
void add_estimators(const Effort& effort);
Table estimators_table();

}  // namespace credence::bench
