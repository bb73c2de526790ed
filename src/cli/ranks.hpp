#pragma once
// Room 14: whether `credence run` shares its blocks among the ranks of an MPI job.

#include "command.hpp"

#include <credence/ranks.hpp>

#include <memory>

namespace credence::cli {

/// Whether this process follows rank 0 of the same command line, which says all there is to say; to be known before the
/// command line is understood, or MPI started.
bool follows_rank_0(const std::string& command, const std::vector<std::string>& arguments);

/// The ranks of the run; null where this process runs alone. `--mpi auto`: where an MPI launcher started more than one
/// process, and `--shard auto` does not make each of them a run of its own. Throws InputError.
std::unique_ptr<Post> post_of(const Parsed& parsed);

/// A rank other than 0: the exit code.
int follow_rank_0(Post& post);

}  // namespace credence::cli
