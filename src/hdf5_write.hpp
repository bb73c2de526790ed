#pragma once
// Room 12: writing HDF5 that is netCDF-4 as well, in memory. The same calls give the same bytes: no object times,
// creation order tracked, contiguous data, no filters.

#include "hdf5_handle.hpp"

namespace credence::hdf5 {

/// What every variable says of itself.
struct Description {
    std::string long_name, units;
};

/// A dimension that variables lie along, with its coordinate: an HDF5 dimension scale, a netCDF dimension.
struct Dimension {
    hsize_t size;
    Handle scale;
};
using Dimensions = std::vector<const Dimension*>;

/// A new file that exists in memory only; its bytes, which ends it.
Handle new_image();
std::vector<unsigned char> take_image(Handle file);

Handle new_group(const Handle& parent, const std::string& name);

/// An attribute of fixed-length UTF-8, the one kind of text that every reader gets right.
void write_text(const Handle& object, const std::string& name, const std::string& text);

// The plain functions below are what the templates stand on.
void write_attribute(const Handle& object, const std::string& name, Type type, const void* values,
                     const Extents& extents);
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

/// An attribute that is an array.
template <class T>
void write_numbers(const Handle& object, const std::string& name, const std::vector<T>& values) {
    write_attribute(object, name, type_of<T>(), values.data(), {values.size()});
}

template <class T>
Dimension new_dimension(const Handle& group, const std::string& name, const std::vector<T>& coordinate,
                        const Description& description) {
    return as_dimension(write_dataset(group, name, type_of<T>(), coordinate.data(), {coordinate.size()}, description),
                        name, coordinate.size());
}

/// A variable along dimensions of the same group; `values`, row-major, must fill them.
template <class T>
Handle new_variable(const Handle& group, const std::string& name, const std::vector<T>& values,
                    const Dimensions& dimensions, const Description& description) {
    Handle variable = write_dataset(group, name, type_of<T>(), values.data(),
                                    extents_of(dimensions, values.size(), name), description);
    attach(variable, dimensions);
    return variable;
}

}  // namespace credence::hdf5
