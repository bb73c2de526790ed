#pragma once
// A file that appears under its name only when it is complete and on the disk.

#include <credence/detail/store.hpp>

#include <functional>
#include <string>
#include <vector>

namespace credence {

/// Writes a file: `write` fills an empty temporary one, `FILE.credence-partial`, given its descriptor, and returns 0 or
/// an error of the system; the temporary file is then synced and renamed, and the folder synced. The file gets the
/// owner and the permissions of the file that it replaces. After a crash the old file is unchanged; at worst the
/// temporary file remains, which the next writing removes. Throws Failure where the system refuses or another file
/// exists there than may be replaced, and whatever `write` throws; the old file is then unchanged and the temporary one
/// removed.
void write_durably(const Output& output, const std::function<int(int descriptor)>& write);

/// Throws InputError where writing the output would replace or remove a file that is read, by whatever name.
void check_not_read(const Output& output, const std::vector<std::string>& inputs);

}  // namespace credence
