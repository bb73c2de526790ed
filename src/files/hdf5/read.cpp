#include "files/hdf5/read.hpp"

#include "base/readable_file.hpp"

namespace credence::hdf5 {

namespace {

constexpr hsize_t longest_text = hsize_t{64} << 20;

Handle open_attribute(const Handle& object, const std::string& name) {
    const std::string place = attribute_place(object, name);
    if (!has_attribute(object, name)) throw Error(place, "is missing");
    return {H5Aopen(object.id(), name.c_str(), H5P_DEFAULT), H5Aclose, place, "HDF5 cannot open it"};
}

/// HDF5's answer to whether something exists; throws where HDF5 reports an error instead.
bool found(htri_t answer, const std::string& place) {
    check(answer, place, "cannot be looked up");
    return answer > 0;
}

void require_scalar(const Handle& attribute, const std::string& place) {
    const Handle space(H5Aget_space(attribute.id()), H5Sclose, place, "HDF5 cannot read its extents");
    if (H5Sget_simple_extent_type(space.id()) != H5S_SCALAR) throw Error(place, "is not a scalar");
}

/// The first bytes of a file, fewer where it is shorter. Throws Error.
std::string start_of(const std::string& path, std::size_t most) {
    try {
        return start_of_file(path, most);
    } catch (const Unreadable& why) {
        const std::string whole = "the file";
        if (why.is_missing()) throw Error(whole, "cannot be found", "Check the path");
        if (why.is_irregular()) throw Error(whole, "is not a regular file", "Give an HDF5 file");
        throw Error(whole, std::string("cannot be read (") + why.what() + ")", remedy_for_reading(why.error()));
    }
}

/// A merge has up to a thousand files open, so the library's cache for each must be small. It has a fixed size: to
/// evict what is closed, the library searches all of its cache each time an object is closed.
void limit_cache(const Handle& access) {
    constexpr std::size_t size = 128 << 10;
    H5AC_cache_config_t config;
    config.version = H5AC__CURR_CACHE_CONFIG_VERSION;
    check(H5Pget_mdc_config(access.id(), &config), "/", "HDF5 refuses its access properties");
    config.set_initial_size = true;
    config.initial_size = config.min_size = config.max_size = size;
    config.incr_mode = H5C_incr__off;
    config.flash_incr_mode = H5C_flash_incr__off;
    config.decr_mode = H5C_decr__off;
    check(H5Pset_mdc_config(access.id(), &config), "/", "HDF5 refuses its access properties");
}

std::vector<std::string> names_of_links(const Handle& group, H5_index_t order, hsize_t most,
                                        const std::string& problem) {
    H5G_info_t info;
    const std::string place = place_of(group);
    check(H5Gget_info(group.id(), &info), place, "HDF5 cannot read it");
    if (info.nlinks > most) throw Error(place, "holds more than " + std::to_string(most) + " objects");
    std::vector<std::string> names;
    for (hsize_t i = 0; i < info.nlinks; ++i) {
        const auto get = [&](char* to, std::size_t room) {
            const ssize_t length = H5Lget_name_by_idx(group.id(), ".", order, H5_ITER_INC, i, to, room, H5P_DEFAULT);
            if (length <= 0) throw failure(place, problem);
            return static_cast<std::size_t>(length);
        };
        names.emplace_back(get(nullptr, 0), '\0');
        get(names.back().data(), names.back().size() + 1);
    }
    return names;
}

}  // namespace

hsize_t file_size(const Handle& object) {
    const Handle file(H5Iget_file_id(object.id()), H5Fclose, place_of(object), "HDF5 does not know its file");
    hsize_t size = 0;
    check(H5Fget_filesize(file.id(), &size), place_of(object), "HDF5 does not know its file's size");
    return size;
}

std::string kind_text(hid_t type) {
    const std::size_t bits = 8 * H5Tget_size(type);
    switch (H5Tget_class(type)) {
        case H5T_INTEGER:
            return (H5Tget_sign(type) == H5T_SGN_NONE ? "unsigned " : "") + std::to_string(bits) + "-bit integers";
        case H5T_FLOAT: return std::to_string(bits) + "-bit floats";
        case H5T_STRING: return "text";
        default: return "something else";
    }
}

const std::string& hard(const Handle& group, const std::string& name) {
    const std::string place = place_of(group, name);
    if (!has_link(group, name)) throw Error(place, "is missing");
    H5L_info_t info;
    check(H5Lget_info(group.id(), name.c_str(), &info, H5P_DEFAULT), place, "cannot be looked up");
    if (info.type != H5L_TYPE_HARD)
        throw Error(place, "is a link to somewhere else", "Copy what it points to into the file");
    return name;
}

Handle open_file(const std::string& path) {
    const std::string whole = "the file", signature = "\x89HDF\r\n\x1a\n", start = start_of(path, signature.size());
    // A workspace saved by MATLAB is HDF5 after a header of its own; its variables have no attribute on the root.
    if (start.starts_with("MATLAB"))
        throw Error(whole, "is a MATLAB workspace", "Write the record with h5create, h5write and h5writeatt");
    if (start != signature) throw Error(whole, "is not an HDF5 file", "Give an HDF5 file");
    const Handle access = new_properties(H5P_FILE_ACCESS, whole);
#if H5_VERSION_GE(1, 10, 7) && !(H5_VERSION_GE(1, 12, 0) && !H5_VERSION_GE(1, 12, 1))
    // No lock is needed: finished files appear whole under their name, and locking fails on some file systems.
    check(H5Pset_file_locking(access.id(), false, true), "/", "HDF5 refuses its access properties");
#endif
    limit_cache(access);
    if (const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id()); file >= 0)
        return {file, H5Fclose, whole, ""};
    const Error refused = failure(whole, "is truncated or damaged");
    // Where another user of the library in this process has it open, such as h5py, the properties must be the same.
    if (const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT); file >= 0)
        return {file, H5Fclose, whole, ""};
    throw refused;
}

std::vector<std::string> link_names(const Handle& group) {
    const std::vector<std::string> names =
        names_of_links(group, H5_INDEX_CRT_ORDER, HSIZE_UNDEF, "cannot be listed in the order in which it was made");
    for (const std::string& name : names) {
        // HDF5 writes no such name, and would interpret it as a path, which could lead through links to other files.
        if (name.find('/') != std::string::npos) throw Error(place_of(group, name), "has a name with a slash");
        hard(group, name);
    }
    return names;
}

std::vector<std::string> sorted_link_names(const Handle& group) {
    constexpr hsize_t most = 100000;
    return names_of_links(group, H5_INDEX_NAME, most, "HDF5 cannot list it");
}

std::vector<std::string> attribute_names(const Handle& object) {
    std::vector<std::string> names;
    const H5A_operator2_t note = [](hid_t, const char* name, const H5A_info_t*, void* to) -> herr_t {
        static_cast<std::vector<std::string>*>(to)->emplace_back(name);
        return 0;
    };
    hsize_t first = 0;
    check(H5Aiterate2(object.id(), H5_INDEX_CRT_ORDER, H5_ITER_INC, &first, note, &names), place_of(object),
          "its attributes cannot be listed in the order in which they were made");
    return names;
}

bool has_link(const Handle& group, const std::string& name) {
    const std::string place = place_of(group, name);
    return found(H5Lexists(group.id(), name.c_str(), H5P_DEFAULT), place);
}

bool has_attribute(const Handle& object, const std::string& name) {
    const std::string place = attribute_place(object, name);
    return found(H5Aexists(object.id(), name.c_str()), place);
}

Handle open_group(const Handle& parent, const std::string& name) {
    const std::string place = place_of(parent, name);
    return {H5Gopen2(parent.id(), hard(parent, name).c_str(), H5P_DEFAULT), H5Gclose, place, "is no readable group"};
}

std::string read_text(const Handle& object, const std::string& name) {
    const std::string place = attribute_place(object, name);
    const Handle attribute = open_attribute(object, name);
    const Handle type(H5Aget_type(attribute.id()), H5Tclose, place, "HDF5 cannot read its type");
    if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) > 0)
        throw Error(place, "is not text of a fixed length");
    require_scalar(attribute, place);
    const std::size_t size = H5Tget_size(type.id());
    if (size > std::min(file_size(object), longest_text)) throw Error(place, "is longer than it can be");
    std::string text(size, '\0');
    check(H5Aread(attribute.id(), type.id(), text.data()), place, "HDF5 cannot read it");
    text.resize(text.find_last_not_of('\0') + 1);
    return text;
}

void read_attribute(const Handle& object, const std::string& name, Type type, void* value) {
    const std::string place = attribute_place(object, name);
    const Handle attribute = open_attribute(object, name);
    const Handle own(H5Aget_type(attribute.id()), H5Tclose, place, "HDF5 cannot read its type");
    if (H5Tequal(own.id(), type.file) <= 0)
        throw Error(place, "holds " + kind_text(own.id()) + ", not " + kind_text(type.file));
    require_scalar(attribute, place);
    check(H5Aread(attribute.id(), type.memory, value), place, "HDF5 cannot read it");
}

}  // namespace credence::hdf5
