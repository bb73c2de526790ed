#pragma once
// What a scenario in a results file declares: by its world, or where this program does not have that world, by
// what the file says of itself.

#include <credence/results.hpp>

#include "files/hdf5/read.hpp"

#include <string>

namespace credence {

/// Scenario, columns and series of a scenario's group, without arms. `file` names it in messages. Throws hdf5::Error,
/// and InputError for a broken scenario.
ScenarioResults read_declared(const hdf5::Handle& group, const std::string& file, Keep keep);

}  // namespace credence
