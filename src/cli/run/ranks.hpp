#pragma once
// Whether `credence run` shares its blocks among the ranks of an MPI job.

#include "cli/command.hpp"

#include "cluster/ranks.hpp"

#include <memory>

namespace credence::cli {

/// Whether another process, rank 0 of the same job, refuses the same command line: then this one need not say so again. MPI
/// answers it, because an inherited environment names a rank as well; every process of the job has to ask, rank 0 too,
/// unless it has started MPI before. Without MPI each process speaks for itself.
bool rank_0_says_it(const std::string& command, const std::vector<std::string>& arguments);

/// The ranks of the run; null where this process runs alone. `--mpi auto`: where an MPI launcher started more than one
/// process, and `--shard auto` does not make each of them a run of its own. Throws
/// InputError, also where the environment names other ranks and MPI knows of none.
std::unique_ptr<Transport> transport_of(const Parsed& parsed);

/// A rank other than 0: the exit code.
int follow_rank_0(Transport& post);

}  // namespace credence::cli
