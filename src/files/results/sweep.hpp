#pragma once
// What a scenario's group says of its place in a grid, for readers that do not read the scenario's text.

#include <credence/sweep.hpp>

#include "files/hdf5/handle.hpp"

namespace credence {

/// The attributes `sweep_of`, `sweep_keys` and `sweep.KEY` for every key, a number where the value is one, else text.
/// None where the point is of no grid.
void write_sweep(const hdf5::Handle& group, const SweepPoint& point);

/// Throws hdf5::Error unless the group has just these attributes.
void check_sweep(const hdf5::Handle& group, const SweepPoint& point);

}  // namespace credence
