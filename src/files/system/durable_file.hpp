#pragma once
// A file that appears under its name only when it is whole and on the disk.

#include <credence/store.hpp>

#include <functional>
#include <string>

namespace credence {

/// Makes a file: `write` fills an empty one aside, `FILE.credence-partial`, given its descriptor, and returns 0 or an
/// error of the system; it is synced and renamed, and the folder synced. It has the owner and the permissions of the
/// file that it replaces. A crash leaves what was there before, and at worst the file aside, which the next writing
/// removes. Throws Failure where the system refuses or another file is there than may be replaced, and what `write`
/// throws; then what was there is untouched and nothing is left aside.
void write_durably(const Output& output, const std::function<int(int descriptor)>& write);

}  // namespace credence
