#include "files/hdf5/handle.hpp"

#include <credence/error.hpp>

#include "base/readable_file.hpp"
#include "files/system/system_file.hpp"

#include <cerrno>
#include <exception>

namespace credence::hdf5 {

QuietErrors::QuietErrors() : exceptions_(std::uncaught_exceptions()) {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

QuietErrors::~QuietErrors() {
    H5Eclear2(H5E_DEFAULT);
    if (std::uncaught_exceptions() == exceptions_) H5Eset_auto2(H5E_DEFAULT, function_, data_);
}

namespace {

/// In the place of a system's error: zlib could not inflate a chunk. HDF5 does not say whether it got no memory.
constexpr int not_inflated = -1;

/// HDF5 reports the system's errors only in the text of its descriptions: `..., errno = 24, error message = ...`; where
/// it gets no memory, by the entry's number, and where zlib gets none to begin with, in the text again. Where it got
/// none for its default lists of properties, it does not say so, but misses a property or a list later, which nothing
/// in a file can cause.
herr_t note_system_error(unsigned, const H5E_error2_t* entry, void* to) {
    const std::string said = entry->desc != nullptr ? entry->desc : "", number = "errno = ";
    int& error = *static_cast<int*>(to);
    if (const std::size_t at = said.rfind(number); at != std::string::npos)
        error = std::atoi(said.c_str() + at + number.size());
    else if (error == 0 && (entry->maj_num == H5E_RESOURCE || entry->min_num == H5E_NOSPACE ||
                            entry->min_num == H5E_CANTALLOC || said == "inflateInit() failed" ||
                            (entry->maj_num == H5E_PLIST && entry->min_num == H5E_NOTFOUND) ||
                            said == "can't find object for ID"))
        error = ENOMEM;
    else if (error == 0 && said == "inflate() failed")
        error = not_inflated;
    return 0;
}

}  // namespace

int system_error() {
    int error = 0;
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, note_system_error, &error);
    return error;
}

Error error_of(int error, const std::string& place, const std::string& problem) {
    if (error == 0) return Error(place, problem);
    if (error == not_inflated) return Error(place, problem + ", or had no memory to uncompress them");
    if (error == ENOMEM) return Error(place, "HDF5 got no memory", remedy_for_reading(error));
    return Error(place, "cannot be read (" + words_for(error) + ")", remedy_for_reading(error));
}

Handle::~Handle() {
    if (id_ >= 0) close_(id_);
}

void Handle::close() {
    const std::string place = place_of(*this);  // which is unknown once it is closed
    close(place);
}

Handle new_properties(hid_t kind, const std::string& place) {
    const hid_t id = H5Pcreate(kind);
    if (id < 0) throw error_of(ENOMEM, place, "");  // HDF5 does not always name the reason
    return {id, H5Pclose, place, ""};
}

std::string place_of(const Handle& object) {
    const ssize_t length = H5Iget_name(object.id(), nullptr, 0);
    if (length <= 0) return "/";
    std::string name(static_cast<std::size_t>(length), '\0');
    H5Iget_name(object.id(), name.data(), name.size() + 1);
    return printable(name);
}

std::string place_of(const Handle& object, const std::string& name) {
    const std::string place = place_of(object);
    return (place == "/" ? place : place + "/") + printable(name);
}

std::string attribute_place(const Handle& object, const std::string& name) {
    return place_of(object) + "@" + printable(name);
}

}  // namespace credence::hdf5
