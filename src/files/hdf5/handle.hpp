#pragma once
// RAII wrappers for HDF5's C API. (HighFive is not in every distribution, and HDF5's own C++ API has no dimension
// scales.) Make all HDF5 calls on one thread. Writing: write.hpp; reading: read.hpp.

#include <hdf5.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace credence::hdf5 {

/// An error of HDF5 or of a file's content, as `place: problem`. The store translates it to an InputError or a Failure.
class Error : public std::runtime_error {
public:
    Error(const std::string& place, const std::string& problem, std::string remedy = {})
        : std::runtime_error(place + ": " + problem), remedy_(std::move(remedy)) {}
    /// The remedy; empty where only the usual one helps.
    const std::string& remedy() const { return remedy_; }

private:
    std::string remedy_;
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

/// The error of the HDF5 call that failed last: the system's reason if there was one (too many open files, a disk that
/// cannot be read), else `problem`. It must be called before any other call to HDF5.
Error failure(const std::string& place, const std::string& problem);

/// Owns one HDF5 identifier. Where closing can lose data, call close(), which checks; the destructor cannot.
class Handle {
public:
    using Close = herr_t (*)(hid_t);
    /// Throws Error(place, problem) where `id` is invalid.
    Handle(hid_t id, Close close, const std::string& place, const std::string& problem);
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
    Handle& operator=(Handle&&) = delete;
    ~Handle();

    hid_t id() const { return id_; }
    void close();

private:
    hid_t id_;
    Close close_;
};

/// Throws Error(place, problem) where an HDF5 call returned a failure.
void check(herr_t returned, const std::string& place, const std::string& problem);

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
/// characters are escaped, and long names are cut.
std::string place_of(const Handle& object);
std::string place_of(const Handle& object, const std::string& name);
std::string attribute_place(const Handle& object, const std::string& name);

}  // namespace credence::hdf5
