#pragma once
// Whether records are of the same runs, and which of their steps all have.

#include "record/reader.hpp"

namespace credence {

/// Throws RecordError naming what shows that the runs of `record` are not those of `first`: another seed, other names
/// or units of components, other numbers of runs, steps or components, other `trial`, `truth`, `truth_covariance`,
/// `time` or `steps`. What only one of them has shows nothing.
void require_same_runs(const RecordSource& first, const RecordSource& record);

/// The steps, of all runs, at which records have results: none is compared by steps that it left out.
struct SharedSteps {
    std::int64_t of_any = 0, of_all = 0;  ///< of some record; of all, with the same components in the state
    std::vector<std::int64_t> of_each;
    std::vector<std::uint32_t> states;    ///< [trials, steps] hash of these components; 1: not all agree, 0: none
    std::int64_t trials = 0, steps = 0, n = 0;

    /// Adds a record. Throws RecordError where it has not as many runs, steps and components as the first.
    void add(const RecordReader& reader);
    bool have(std::int64_t trial, int step) const { return states[static_cast<std::size_t>(trial * steps + step)] > 1; }
};

}  // namespace credence
