#pragma once
// Recognises the kind of a file that a command was given, so that a wrong one is refused with the name of the command
// that reads it.

#include <string>
#include <vector>

namespace credence::cli {

/// `unknown` includes files that cannot be read: the command itself reports why.
enum class FileKind { scenario, results, trajectories, record, noise, journal, unknown };

/// Of a record also by the path FILE:ARM.
FileKind kind_of(const std::string& path);

/// Throws InputError, naming the command that reads the file, where the file is of a known kind that is not one of
/// `accepted`, the first of which is the command's main kind.
void check_kind(const std::string& path, const std::vector<FileKind>& accepted);

}  // namespace credence::cli
