#pragma once
// The bytes of a journal on the disk: appended, synced, cut where they are torn.

#include "files/system/system_file.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// A file to read, as long as it was when it was opened.
class JournalBytes {
public:
    /// Opens it for reading only and without a lock, so that whoever writes it neither waits nor fails; nothing where
    /// there is none. Throws InputError where it cannot be read.
    static std::optional<JournalBytes> open(const std::string& path);

    const std::string& path() const { return path_; }
    std::int64_t size() const { return size_; }
    /// Exactly `size` bytes from `position` on. Throws InputError where they are not there or cannot be read.
    void read(std::int64_t position, void* bytes, std::size_t size) const;
    std::string read(std::int64_t position, std::int64_t size) const;
    /// Seconds since something was written into it, by the system's clock; at least 0.
    double seconds_since_change() const;

protected:
    JournalBytes(std::string path, Descriptor file);

    std::string path_;
    Descriptor file_;
    std::int64_t size_ = 0;
};

/// A file that is only ever appended to, locked against a second writer while it is open.
class JournalFile : public JournalBytes {
public:
    /// Opens it, or makes it with these permissions. Throws InputError where another program holds it, Failure where the system refuses.
    JournalFile(const std::string& path, mode_t mode);

    /// Appends and syncs: when it returns the bytes are on the disk. Throws Failure where the system refuses; then what
    /// had been there before is there still, and nothing else. Throws it too where another program cut or lengthened the
    /// file; then nothing is written.
    void append(const std::vector<std::string>& pieces);
    /// Leaves the first `size` bytes.
    void cut(std::int64_t size);
    /// Removes it, unless its name leads to another file by now. Throws Failure.
    void remove();
};

}  // namespace credence
