#pragma once
// Limits of the system (ulimit, control groups) on the program.

#include <cstdint>
#include <optional>
#include <string>

namespace credence::cli {

/// Throws InputError where a thread's stack is too small for the work: it would end in a segmentation fault.
void check_stack();

/// The bytes of memory that the program may use: the least of what the machine, the control group and ulimit -v allow.
std::int64_t memory_limit();

/// Number of bytes that can still be written into the folder of a file; nothing where the system does not report it.
std::optional<std::int64_t> free_space(const std::string& path);

/// Raises the limit on open files to the largest that the system allows: a merge keeps the files of all shards open,
/// and a shell's usual limit is 1024.
void allow_open_files();

}  // namespace credence::cli
