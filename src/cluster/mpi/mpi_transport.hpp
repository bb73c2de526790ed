#pragma once
// The ranks of an MPI job [src/cluster/ranks.hpp]. mpi_transport.cpp is built with MPI, no_mpi.cpp without it.

#include "cluster/ranks.hpp"

#include <memory>
#include <string>

namespace credence {

/// Starts MPI, and ends it with the object. Null where the program was built without MPI, and where this process has
/// started MPI before: MPI can be started only once.
std::unique_ptr<Transport> start_mpi();

/// The MPI library and its version; `none` where the program was built without MPI. Does not start MPI.
std::string mpi_library();

}  // namespace credence
