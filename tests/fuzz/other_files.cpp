#include "other_files.hpp"

#include "require.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <hdf5.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdarg>

namespace {

const std::string* only_file = nullptr;
ssize_t refused = 0;  // objects that HDF5 could not close, because they are damaged: it keeps them

/// HDF5's own function of that name, behind one of ours.
herr_t close_by(const char* function, hid_t object) {
    const auto close = reinterpret_cast<herr_t (*)(hid_t)>(dlsym(RTLD_NEXT, function));
    const herr_t returned = close(object);
    if (returned < 0) ++refused;
    return returned;
}

}  // namespace

namespace credence::fuzz {

OnlyFile::OnlyFile(const std::string& path) {
    H5dont_atexit();  // as the program does
    only_file = &path;
}

OnlyFile::~OnlyFile() { only_file = nullptr; }

void require_all_closed() {
    constexpr unsigned objects = H5F_OBJ_DATASET | H5F_OBJ_GROUP | H5F_OBJ_DATATYPE | H5F_OBJ_ATTR;
    require(H5Fget_obj_count(H5F_OBJ_ALL, objects) == refused, "every object in the file is closed");
}

}  // namespace credence::fuzz

/// These replace HDF5's functions, in files that credence closes.
extern "C" herr_t H5Aclose(hid_t attribute) { return close_by("H5Aclose", attribute); }
extern "C" herr_t H5Dclose(hid_t dataset) { return close_by("H5Dclose", dataset); }
extern "C" herr_t H5Gclose(hid_t group) { return close_by("H5Gclose", group); }
extern "C" herr_t H5Oclose(hid_t object) { return close_by("H5Oclose", object); }
extern "C" herr_t H5Tclose(hid_t type) { return close_by("H5Tclose", type); }

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
