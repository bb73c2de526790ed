#pragma once
// A scenario's declaration in a results file: by its world or, if this program does not have that world, by the file's
// own content.

#include <credence/detail/results.hpp>

#include "files/hdf5/read.hpp"

#include <string>

namespace credence {

/// Scenario, columns and series of a scenario's group, without arms. `file` names it in messages. Throws hdf5::Error,
/// and InputError for a broken scenario.
ScenarioResults read_declared(const hdf5::Handle& group, const std::string& file, Keep keep);

}  // namespace credence
