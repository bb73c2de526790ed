#pragma once
// What kind of file a command was given, so that the wrong one is refused with the command that reads it.

#include <string>
#include <vector>

namespace credence::cli {

/// `unknown` is also what cannot be read: the command itself says why.
enum class FileKind { scenario, results, trajectories, record, noise, journal, unknown };

FileKind kind_of(const std::string& path);

/// Throws InputError, with the command that reads it, where the file is of a known kind but none of `accepted`, the first of
/// which is what the command is for.
void check_kind(const std::string& path, const std::vector<FileKind>& accepted);

}  // namespace credence::cli
