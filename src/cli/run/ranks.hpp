#pragma once
// Whether `credence run` shares its blocks among the ranks of an MPI job.

#include "cli/command.hpp"

#include "cluster/ranks.hpp"

#include <memory>

namespace credence::cli {

/// Whether another process, rank 0 of the same job, refuses the same command line, so that this one need not repeat the
/// message. MPI answers it, because the environment that names a rank may be inherited; every process of the job has to
/// ask, including rank 0, unless it has started MPI before. Without MPI each process prints its own message.
bool rank_0_says_it(const std::string& command, const std::vector<std::string>& arguments);

/// The ranks of the run; null where this process runs alone. `--mpi auto`: where an MPI launcher started more than one
/// process, and `--shard auto` does not make each of them a run of its own. Throws InputError, also where the
/// environment names other ranks and MPI does not know them.
std::unique_ptr<Transport> transport_of(const Parsed& parsed);

/// Runs a rank other than 0; returns the exit code.
int follow_rank_0(Transport& post);

}  // namespace credence::cli
