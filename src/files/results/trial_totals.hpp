#pragma once
// The totals of an arm's columns, and the blocks that are present if no trial is kept [docs/results-format.md, Totals
// of the columns].

#include <credence/detail/results.hpp>

#include "files/hdf5/read.hpp"
#include "files/hdf5/write.hpp"

#include <string>
#include <vector>

namespace credence {

/// Names of the datasets of the arm at `place` in the scenario, coordinates included.
std::vector<std::string> trial_totals_links(std::size_t place);

/// The largest number of parts of any of its exact totals.
std::size_t largest_part_count(const TrialTotals& totals);

/// Writes the blocks that are present, as ranges.
void write_block_ranges(const hdf5::Handle& group, const BlockRanges& blocks);
/// Reads the ranges, of a study that was asked for `asked` trials. Throws Error unless they are increasing and
/// separate.
BlockRanges read_block_ranges(const hdf5::Handle& group, std::int64_t asked);

void write_trial_totals(const hdf5::Handle& group, const hdf5::Dimension& part, const ScenarioResults& results,
                        const ArmResults& arm);
/// Reads those of the next arm of `results`, whose trials are known. Throws Error if they do not agree with these, or
/// with each other.
TrialTotals read_trial_totals(const hdf5::Handle& group, const ScenarioResults& results, hsize_t parts);

}  // namespace credence
