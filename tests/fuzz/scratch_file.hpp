#pragma once
// Readers take paths: an input becomes a file of its own, in memory where the system has such a folder.

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace credence::fuzz {

/// $TMPDIR where it is set, else /dev/shm where there is one, else the folder for temporary files.
inline std::filesystem::path scratch_folder() {
    if (std::getenv("TMPDIR") == nullptr && access("/dev/shm", W_OK) == 0) return "/dev/shm";
    return std::filesystem::temp_directory_path();
}

/// A file of this process that holds an input as long as it lives. HDF5 knows open files by device and inode, and may
/// have failed to close the last one: every input is a new inode.
class ScratchFile {
public:
    ScratchFile(const std::uint8_t* data, std::size_t size)
        : path_((scratch_folder() / ("credence-fuzz-" + std::to_string(getpid()) + ".h5")).string()) {
        std::remove(path_.c_str());
        std::FILE* file = std::fopen(path_.c_str(), "wb");
        if (file == nullptr || std::fwrite(data, 1, size, file) != size || std::fclose(file) != 0) {
            std::perror(path_.c_str());
            std::abort();
        }
    }
    ~ScratchFile() { std::remove(path_.c_str()); }
    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;

    const std::string& path() const { return path_; }

private:
    std::string path_;
};

}  // namespace credence::fuzz
