#pragma once
// RAII wrappers for HDF5's C API. (HighFive is not in every distribution, and HDF5's own C++ API has no dimension
// scales.) Make all HDF5 calls on one thread. Writing: write.hpp; reading: read.hpp.

#include "base/placed_error.hpp"

#include <hdf5.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace credence::hdf5 {

/// An error of HDF5 or of a file's content.
class Error : public PlacedError {
public:
    using PlacedError::PlacedError;
};

/// Stops HDF5 from printing its error stack while the object exists; if the scope is left by an exception, for good,
/// since a damaged file can keep the library from closing, and HDF5 would print that at exit.
class QuietErrors {
public:
    QuietErrors();
    ~QuietErrors();
    QuietErrors(const QuietErrors&) = delete;
    QuietErrors& operator=(const QuietErrors&) = delete;

private:
    H5E_auto2_t function_ = nullptr;
    void* data_ = nullptr;
    int exceptions_;
};

/// The system's error in which the HDF5 call that failed last ended (too many open files, a disk that cannot be read),
/// or 0. It must be asked for before any other call to HDF5.
int system_error();
/// The error of a call to HDF5: the system's reason if there was one, else `problem`.
Error error_of(int system_error, const std::string& place, const std::string& problem);

/// The error of the HDF5 call that failed last. `At` is a text or a Place, below.
template <class At>
Error failure(const At& place, const std::string& problem) {
    const int error = system_error();
    return error_of(error, place, problem);
}

/// Owns one HDF5 identifier. Where closing can lose data, call close(), which checks; the destructor cannot.
class Handle {
public:
    using Close = herr_t (*)(hid_t);
    /// Throws Error(place, problem) where `id` is invalid.
    template <class At>
    Handle(hid_t id, Close close, const At& place, const std::string& problem) : id_(id), close_(close) {
        if (id_ < 0) throw failure(place, problem);
    }
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
    Handle& operator=(Handle&&) = delete;
    ~Handle();

    hid_t id() const { return id_; }
    void close();
    template <class At>
    void close(const At& place);

private:
    hid_t id_;
    Close close_;
};

/// Throws Error(place, problem) where an HDF5 call returned a failure.
template <class At>
void check(herr_t returned, const At& place, const std::string& problem) {
    if (returned < 0) throw failure(place, problem);
}

template <class At>
void Handle::close(const At& place) {
    check(close_(std::exchange(id_, H5I_INVALID_HID)), place, "HDF5 could not close it");
}

/// A property list of the class `kind`; throws Error(place, …) where it gets no memory, as it needs nothing else.
Handle new_properties(hid_t kind, const std::string& place);

/// The HDF5 type of a number in files, always little-endian, and in memory.
struct Type {
    hid_t file, memory;
};
template <class T>
Type type_of();
template <>
inline Type type_of<double>() { return {H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE}; }
template <>
inline Type type_of<float>() { return {H5T_IEEE_F32LE, H5T_NATIVE_FLOAT}; }
template <>
inline Type type_of<std::int8_t>() { return {H5T_STD_I8LE, H5T_NATIVE_INT8}; }
template <>
inline Type type_of<std::int32_t>() { return {H5T_STD_I32LE, H5T_NATIVE_INT32}; }
template <>
inline Type type_of<std::int64_t>() { return {H5T_STD_I64LE, H5T_NATIVE_INT64}; }
template <>
inline Type type_of<std::uint64_t>() { return {H5T_STD_U64LE, H5T_NATIVE_UINT64}; }

using Extents = std::vector<hsize_t>;

/// The place of an object for messages: `/group`, `/group/name`, `/group@attribute`. Names come from files: control
/// characters are escaped, and long names are cut. HDF5 takes its time to name an object: see Place.
std::string place_of(const Handle& object);
std::string place_of(const Handle& object, const std::string& name);
std::string attribute_place(const Handle& object, const std::string& name);

/// A place that is put into words only where an error is reported: `Place{[&] { return place_of(object); }}`.
template <class Words>
struct Place {
    Words words;
    operator std::string() const { return words(); }
};
template <class Words>
Place(Words) -> Place<Words>;

}  // namespace credence::hdf5
