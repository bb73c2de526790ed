#pragma once
// Room 12: a file that appears under its name only when it is whole and on the disk.

#include <cstddef>
#include <string>

namespace credence {

/// Puts `size` bytes into the file `path`, replacing what is there: written aside as `PATH.partial`, synced, renamed,
/// the folder synced. A crash leaves what was there before, and at worst the file aside, which the next writing takes
/// over.
/// Throws Failure where the system refuses; then what was there is untouched and nothing is left aside.
void write_durably(const std::string& path, const void* bytes, std::size_t size);

}  // namespace credence
