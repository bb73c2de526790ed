#pragma once
// The bytes of a journal on the disk: appended, synced, and cut where they are torn.

#include "files/system/system_file.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// A file for reading; its size is fixed when it is opened.
class JournalBytes {
public:
    /// Opens it read-only and without a lock, so that a program that writes it neither waits nor fails. Returns nothing
    /// if there is no file. Throws InputError where it cannot be read.
    static std::optional<JournalBytes> open(const std::string& path);

    const std::string& path() const { return path_; }
    std::int64_t size() const { return size_; }
    /// Whether the file is now shorter than that.
    bool is_cut() const;
    /// Exactly `size` bytes from `position` on. Throws InputError where the file is shorter or cannot be read.
    void read(std::int64_t position, void* bytes, std::size_t size) const;
    std::string read(std::int64_t position, std::int64_t size) const;
    /// Seconds since the file was last written, by the system's clock; at least 0.
    double seconds_since_change() const;

protected:
    JournalBytes(std::string path, Descriptor file);

    std::string path_;
    Descriptor file_;
    std::int64_t size_ = 0;
};

/// An append-only file, locked against a second writer while it is open.
class JournalFile : public JournalBytes {
public:
    /// Opens the file, or creates it with these permissions. Throws InputError where another program holds it, Failure
    /// where the system refuses.
    JournalFile(const std::string& path, mode_t mode);

    /// Appends and syncs: when it returns, the bytes are on the disk. Throws Failure where the system refuses; the file
    /// is then as it was before the call. Also throws Failure, without writing, where another program shortened or
    /// lengthened the file.
    void append(const std::vector<std::string>& pieces);
    /// Truncates the file to its first `size` bytes.
    void cut(std::int64_t size);
    /// Removes the file, unless its name by now leads to another one. Throws Failure.
    void remove();
};

}  // namespace credence
