#pragma once
// A file from elsewhere must not make its reader open another one, nor leave anything open.

#include <string>

namespace credence::fuzz {

/// As long as it lives, HDF5 may open no file but this: the process ends, saying which.
class OnlyFile {
public:
    explicit OnlyFile(const std::string& path);
    ~OnlyFile();
    OnlyFile(const OnlyFile&) = delete;
    OnlyFile& operator=(const OnlyFile&) = delete;
};

/// Whatever became of a file, its reader has closed every object of it. (HDF5 cannot close some damaged files.)
void require_all_closed();

}  // namespace credence::fuzz
