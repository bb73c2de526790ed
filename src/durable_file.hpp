#pragma once
// Room 12: a file that appears under its name only when it is whole and on the disk.

#include <functional>
#include <string>

namespace credence {

/// Makes the file `path`, replacing what is there: `write` fills an empty file aside, `PATH.partial`, given its
/// descriptor, and returns 0 or an error of the system; it is synced and renamed, and the folder synced. A crash leaves
/// what was there before, and at worst the file aside, which the next writing takes over. Throws Failure where the
/// system refuses, and what `write` throws; then what was there is untouched and nothing is left aside.
void write_durably(const std::string& path, const std::function<int(int descriptor)>& write);

}  // namespace credence
