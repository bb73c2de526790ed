#pragma once
// Writing HDF5 that is netCDF-4 as well. The same calls give the same bytes: no object times, creation order tracked,
// contiguous data, no filters.

#include "files/hdf5/handle.hpp"
#include "files/system/checksum.hpp"

#include <algorithm>

namespace credence {
class ByteFile;
}

namespace credence::hdf5 {

/// A new HDF5 file, readable by every release from 1.8 on, whose bytes are written to `bytes`, which must outlive it.
/// After closing it, check `bytes` for an error.
Handle new_file(ByteFile& bytes);

/// The attributes that every variable has.
struct Description {
    std::string long_name, units;
};

/// The attribute of a variable that holds the checksum of its values. Files written before there was one lack it.
inline constexpr const char* checksum_name = "crc32";

/// A dimension of variables, with its coordinate: an HDF5 dimension scale, a netCDF dimension. HDF5's H5DSattach_scale
/// would read and rewrite the list of all variables along it for each of them, which took a fifth of a file's time; so
/// the two lists that it makes [HDF5 Dimension Scale Specification, 4.2] are written here: close() every dimension.
struct Dimension {
    struct Use {
        hobj_ref_t variable;
        int axis, padding;  ///< none without a name: the same calls give the same bytes
    };
    hsize_t size;
    Handle scale;
    hobj_ref_t reference;
    mutable std::vector<Use> uses;  ///< the variables along it

    /// Writes the list of the variables along it.
    void close();
};
using Dimensions = std::vector<const Dimension*>;

Handle new_group(const Handle& parent, const std::string& name);

/// A text attribute of fixed-length UTF-8, the one kind of text that every reader supports.
void write_text(const Handle& object, const std::string& name, const std::string& text);

// The functions on which the templates below are built.
void write_attribute(const Handle& object, const std::string& name, Type type, const void* values,
                     const Extents& extents);
Handle new_dataset(const Handle& group, const std::string& name, Type type, const Extents& extents,
                   const Description& description);
void write_values(const Handle& dataset, Type type, hsize_t first, hsize_t count, const void* values);
Handle write_dataset(const Handle& group, const std::string& name, Type type, const void* values,
                     const Extents& extents, const Description& description);
Dimension as_dimension(Handle dataset, const std::string& name, hsize_t size);
void attach(const Handle& variable, const Dimensions& dimensions);
Extents extents_of(const Dimensions& dimensions, std::size_t count, const std::string& name);

/// A scalar attribute.
template <class T>
void write_number(const Handle& object, const std::string& name, T value) {
    write_attribute(object, name, type_of<T>(), &value, {});
}

/// An array attribute.
template <class T>
void write_numbers(const Handle& object, const std::string& name, const std::vector<T>& values) {
    write_attribute(object, name, type_of<T>(), values.data(), {values.size()});
}

/// Number of rows by which a dataset along one dimension is written: this bounds the memory that long ones take.
inline constexpr std::int64_t rows_at_once = std::int64_t{1} << 17;

/// A dataset of `count` values along one dimension; `values(first, count)` returns some of them.
template <class T, class Values>
Handle new_long_dataset(const Handle& group, const std::string& name, std::int64_t count,
                        const Description& description, Values values) {
    Handle dataset = new_dataset(group, name, type_of<T>(), {static_cast<hsize_t>(count)}, description);
    std::uint32_t crc = 0;
    for (std::int64_t first = 0; first < count; first += rows_at_once) {
        const std::vector<T> some = values(first, std::min(rows_at_once, count - first));
        write_values(dataset, type_of<T>(), static_cast<hsize_t>(first), some.size(), some.data());
        crc = checksum(some.data(), some.size() * sizeof(T), crc);
    }
    write_number<std::int64_t>(dataset, checksum_name, crc);
    return dataset;
}

template <class T>
Dimension new_dimension(const Handle& group, const std::string& name, const std::vector<T>& coordinate,
                        const Description& description) {
    return as_dimension(write_dataset(group, name, type_of<T>(), coordinate.data(), {coordinate.size()}, description),
                        name, coordinate.size());
}

/// A variable along dimensions of the same group; `values`, row-major, must have as many values as these.
template <class T>
Handle new_variable(const Handle& group, const std::string& name, const std::vector<T>& values,
                    const Dimensions& dimensions, const Description& description) {
    Handle variable = write_dataset(group, name, type_of<T>(), values.data(),
                                    extents_of(dimensions, values.size(), name), description);
    attach(variable, dimensions);
    return variable;
}

}  // namespace credence::hdf5
