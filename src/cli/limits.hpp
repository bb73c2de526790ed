#pragma once
// Room 14: limits of the system (ulimit) that the program runs under.

namespace credence::cli {

/// Throws InputError where a thread has less stack than the work takes: it would end in a segmentation fault.
void check_stack();

/// The columns of a merge stay in the shards' files, and those open: as many as the system allows, not the 1024 of a usual
/// shell.
void allow_open_files();

}  // namespace credence::cli
