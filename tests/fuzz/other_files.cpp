#include "other_files.hpp"

#include "require.hpp"

#include <fcntl.h>
#include <hdf5.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdarg>
#include <iterator>

namespace {

const std::string* only_file = nullptr;

}  // namespace

namespace credence::fuzz {

OnlyFile::OnlyFile(const std::string& path) { only_file = &path; }
OnlyFile::~OnlyFile() { only_file = nullptr; }

void require_all_closed() {
    constexpr unsigned objects = H5F_OBJ_DATASET | H5F_OBJ_GROUP | H5F_OBJ_DATATYPE | H5F_OBJ_ATTR;
    hid_t left[16];
    const ssize_t count = H5Fget_obj_ids(H5F_OBJ_ALL, objects, std::size(left), left);
    // What a damaged file keeps HDF5 from closing is still there, and cannot be closed now either.
    for (ssize_t i = 0; i < count; ++i) require(H5Idec_ref(left[i]) < 0, "every object in the file is closed");
}

}  // namespace credence::fuzz

/// Stands before libc's, for every library of the process that opens files by it, as HDF5 does; libc itself does not.
extern "C" int open(const char* path, int flags, ...) {
    std::va_list more;
    va_start(more, flags);
    const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(more, mode_t) : 0;
    va_end(more);
    if (only_file != nullptr && *only_file != path) {
        only_file = nullptr;
        credence::fuzz::require(false, "no other file is opened");
    }
    return static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}
