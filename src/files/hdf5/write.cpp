#include "files/hdf5/write.hpp"

#include <hdf5_hl.h>

#include <cstddef>

namespace credence::hdf5 {

namespace {

constexpr unsigned creation_order = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;

/// Properties of a new group or dataset. Tracked creation order also lets an attribute exceed 64 kB.
Handle creation_properties(hid_t kind) {
    const std::string place = "/", problem = "HDF5 refuses its creation properties";
    Handle properties = new_properties(kind, place);
    check(H5Pset_obj_track_times(properties.id(), false), place, problem);
    check(H5Pset_attr_creation_order(properties.id(), creation_order), place, problem);
    // Beyond 8 attributes HDF5 would keep them in a B-tree, which takes longer to write.
    check(H5Pset_attr_phase_change(properties.id(), 16, 12), place, problem);
    if (kind == H5P_GROUP_CREATE) check(H5Pset_link_creation_order(properties.id(), creation_order), place, problem);
    // Every value is written, so HDF5 need not write its fill values first.
    if (kind == H5P_DATASET_CREATE) check(H5Pset_fill_time(properties.id(), H5D_FILL_TIME_NEVER), place, problem);
    return properties;
}

/// A scalar: no dimensions.
template <class At>
Handle dataspace(const Extents& extents, const At& place) {
    const hid_t space = extents.empty() ? H5Screate(H5S_SCALAR)
                                        : H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr);
    return {space, H5Sclose, place, "HDF5 refuses its extents"};
}

hobj_ref_t reference_to(const Handle& object) {
    hobj_ref_t reference{};
    check(H5Rcreate(&reference, object.id(), ".", H5R_OBJECT, H5I_INVALID_HID), Place{[&] { return place_of(object); }},
          "HDF5 could not refer to it");
    return reference;
}

}  // namespace

Handle new_group(const Handle& parent, const std::string& name) {
    const Place place{[&] { return place_of(parent, name); }};
    static const Handle& creation = *new Handle(creation_properties(H5P_GROUP_CREATE));  // of runs whose process exits
    return {H5Gcreate2(parent.id(), name.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), H5Gclose, place,
            "HDF5 could not make this group"};
}

void write_text(const Handle& object, const std::string& name, const std::string& text) {
    const Place place{[&] { return attribute_place(object, name); }};
    const std::string problem = "HDF5 could not make this attribute";
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, place, problem);
    // HDF5 has no empty text: it is stored as one null, which is padding.
    check(H5Tset_size(type.id(), std::max<std::size_t>(text.size(), 1)), place, problem);
    check(H5Tset_cset(type.id(), H5T_CSET_UTF8), place, problem);
    check(H5Tset_strpad(type.id(), H5T_STR_NULLPAD), place, problem);
    write_attribute(object, name, {type.id(), type.id()}, text.c_str(), {});
}

void write_attribute(const Handle& object, const std::string& name, Type type, const void* values,
                     const Extents& extents) {
    const Place place{[&] { return attribute_place(object, name); }};
    const std::string problem = "HDF5 could not make this attribute";
    const Handle space = dataspace(extents, place);
    Handle attribute(H5Acreate2(object.id(), name.c_str(), type.file, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                     place, problem);
    check(H5Awrite(attribute.id(), type.memory, values), place, problem);
    attribute.close(place);
}

Handle new_dataset(const Handle& group, const std::string& name, Type type, const Extents& extents,
                   const Description& description) {
    const Place place{[&] { return place_of(group, name); }};
    const std::string problem = "HDF5 could not make this dataset";
    const Handle space = dataspace(extents, place);
    static const Handle& creation = *new Handle(creation_properties(H5P_DATASET_CREATE));
    Handle dataset(H5Dcreate2(group.id(), name.c_str(), type.file, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT),
                   H5Dclose, place, problem);
    write_text(dataset, "long_name", description.long_name);
    write_text(dataset, "units", description.units);
    return dataset;
}

void write_values(const Handle& dataset, Type type, hsize_t first, hsize_t count, const void* values) {
    const Place place{[&] { return place_of(dataset); }};
    const std::string problem = "HDF5 could not write its values";
    const Handle space(H5Dget_space(dataset.id()), H5Sclose, place, problem),
        memory(H5Screate_simple(1, &count, nullptr), H5Sclose, place, problem);
    check(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, &first, nullptr, &count, nullptr), place, problem);
    check(H5Dwrite(dataset.id(), type.memory, memory.id(), space.id(), H5P_DEFAULT, values), place, problem);
}

Handle write_dataset(const Handle& group, const std::string& name, Type type, const void* values,
                     const Extents& extents, const Description& description) {
    Handle dataset = new_dataset(group, name, type, extents, description);
    check(H5Dwrite(dataset.id(), type.memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values),
          Place{[&] { return place_of(dataset); }}, "HDF5 could not write its values");
    std::size_t size = H5Tget_size(type.memory);
    for (const hsize_t extent : extents) size *= extent;
    write_number<std::int64_t>(dataset, checksum_name, checksum(values, size));
    return dataset;
}

Dimension as_dimension(Handle dataset, const std::string& name, hsize_t size) {
    check(H5DSset_scale(dataset.id(), name.c_str()), Place{[&] { return place_of(dataset); }},
          "HDF5 could not make it a dimension");
    const hobj_ref_t reference = reference_to(dataset);
    return {size, std::move(dataset), reference, {}};
}

void Dimension::close() {
    const Place place{[&] { return place_of(scale); }};
    const std::string problem = "HDF5 could not note the variables along it";
    const Handle type(H5Tcreate(H5T_COMPOUND, sizeof(Use)), H5Tclose, place, problem);
    check(H5Tinsert(type.id(), "dataset", offsetof(Use, variable), H5T_STD_REF_OBJ), place, problem);
    check(H5Tinsert(type.id(), "dimension", offsetof(Use, axis), H5T_NATIVE_INT), place, problem);
    if (!uses.empty()) write_attribute(scale, "REFERENCE_LIST", {type.id(), type.id()}, uses.data(), {uses.size()});
    scale.close();
}

void attach(const Handle& variable, const Dimensions& dimensions) {
    const Handle type(H5Tvlen_create(H5T_STD_REF_OBJ), H5Tclose, Place{[&] { return place_of(variable); }},
                      "HDF5 could not attach its dimensions");
    const hobj_ref_t reference = reference_to(variable);
    std::vector<hvl_t> scales;
    for (const Dimension* dimension : dimensions) {
        dimension->uses.push_back({reference, static_cast<int>(scales.size()), 0});
        scales.push_back({1, const_cast<hobj_ref_t*>(&dimension->reference)});
    }
    write_attribute(variable, "DIMENSION_LIST", {type.id(), type.id()}, scales.data(), {scales.size()});
}

Extents extents_of(const Dimensions& dimensions, std::size_t count, const std::string& name) {
    Extents extents;
    hsize_t room = 1;
    for (const Dimension* dimension : dimensions) {
        extents.push_back(dimension->size);
        room *= dimension->size;
    }
    if (room != count)
        throw Error(name, "has " + std::to_string(count) + " values, its dimensions take " + std::to_string(room));
    return extents;
}

}  // namespace credence::hdf5
