#pragma once
// A file from elsewhere must not make its reader open another one, nor leave anything open.

#include <string>

namespace credence::fuzz {

/// While an object exists, HDF5 may open no other file: the process ends, naming the file.
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
