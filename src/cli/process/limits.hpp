#pragma once
// Limits of the system (ulimit) that the program runs under.

#include <cstdint>
#include <optional>
#include <string>

namespace credence::cli {

/// Throws InputError where a thread has less stack than the work takes: it would end in a segmentation fault.
void check_stack();

/// The least bytes of memory that the machine, the control group and ulimit -v leave to the program.
std::int64_t memory_limit();

/// Bytes that can still be written into the folder of a file; nothing where the system does not say.
std::optional<std::int64_t> free_space(const std::string& path);

/// The columns of a merge stay in the shards' files, and those open: as many as the system allows, not the 1024 of a usual
/// shell.
void allow_open_files();

}  // namespace credence::cli
