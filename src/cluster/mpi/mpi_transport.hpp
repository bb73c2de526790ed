#pragma once
// The ranks of an MPI job [cluster/ranks.hpp]. mpi_transport.cpp where MPI is built in, no_mpi.cpp where it is not.

#include "cluster/ranks.hpp"

#include <memory>
#include <string>

namespace credence {

/// Starts MPI, and ends it with the object. Null where the program was built without MPI, and where this process has
/// started MPI before: that can be done once.
std::unique_ptr<Transport> start_mpi();

/// The library and its version; `none` where the program was built without MPI. Starts nothing.
std::string mpi_library();

}  // namespace credence
