#pragma once
// The environment variables of this process's launcher (Slurm, mpirun): they name this process among those that were
// started. docs/cluster.md has the table.

#include <credence/study.hpp>

#include <functional>
#include <optional>
#include <string>

namespace credence::cli {

/// The value of an environment variable; nothing where it is not set.
using Variables = std::function<std::optional<std::string>(const std::string& name)>;
Variables environment();

/// Reads `I/N`. Throws InputError where the text is invalid, or I is not one of 0 ... N - 1.
Shard parse_shard(const std::string& text);

/// The shard that this process has to compute [--shard auto]. Two launchers may be nested, and each counts:
///   the task of a Slurm array   a = (SLURM_ARRAY_TASK_ID - SLURM_ARRAY_TASK_MIN) / SLURM_ARRAY_TASK_STEP of A =
///                               SLURM_ARRAY_TASK_COUNT
///   the process of a launcher   p of P, of the first of OMPI_COMM_WORLD_RANK / _SIZE (mpirun of Open MPI), PMI_RANK /
///                               PMI_SIZE (other mpiruns), SLURM_PROCID / SLURM_NTASKS (srun)
/// Both together give shard a P + p of A P; one of them alone gives its own. A batch script that was not started by
/// srun is one process, though Slurm sets SLURM_PROCID and SLURM_NTASKS in it too.
/// Throws InputError where no variable names a shard, or they contradict each other.
Shard shard_of_launcher(const Variables& variables);

}  // namespace credence::cli
