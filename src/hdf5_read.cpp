#include "hdf5_read.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

namespace credence::hdf5 {

namespace {

/// Deflate, the strongest of the usual filters, never shrinks by more.
constexpr hsize_t largest_compression = 1100;
constexpr hsize_t longest_text = hsize_t{64} << 20;

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

Handle open_attribute(const Handle& object, const std::string& name) {
    const std::string place = attribute_place(object, name);
    if (!has_attribute(object, name)) throw Error(place, "is missing");
    return {H5Aopen(object.id(), name.c_str(), H5P_DEFAULT), H5Aclose, place, "HDF5 cannot open it"};
}

void require_scalar(const Handle& attribute, const std::string& place) {
    const Handle space(H5Aget_space(attribute.id()), H5Sclose, place, "HDF5 cannot read its extents");
    if (H5Sget_simple_extent_type(space.id()) != H5S_SCALAR) throw Error(place, "is not a scalar");
}

}  // namespace

const std::string& hard(const Handle& group, const std::string& name) {
    H5L_info_t info;
    if (H5Lexists(group.id(), name.c_str(), H5P_DEFAULT) <= 0 ||
        H5Lget_info(group.id(), name.c_str(), &info, H5P_DEFAULT) < 0)
        throw Error(place_of(group, name), "is missing");
    if (info.type != H5L_TYPE_HARD)
        throw Error(place_of(group, name), "is a link to somewhere else", "Copy what it points to into the file");
    return name;
}

Handle open_file(const std::string& path) {
    constexpr std::array<unsigned char, 8> signature{0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
    const std::string whole = "the file", another = "Give an HDF5 file";
    std::error_code trouble;
    const std::filesystem::file_status status = std::filesystem::status(path, trouble);
    if (!std::filesystem::exists(status)) throw Error(whole, "cannot be found", "Check the path");
    if (!std::filesystem::is_regular_file(status)) throw Error(whole, "is not a regular file", another);
    std::array<unsigned char, 8> start{};
    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw Error(whole, "cannot be opened", "Check its permissions");
    stream.read(reinterpret_cast<char*>(start.data()), static_cast<std::streamsize>(start.size()));
    if (!stream || start != signature) throw Error(whole, "is not an HDF5 file", another);
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "/", "HDF5 gives no properties");
#if H5_VERSION_GE(1, 10, 7) && !(H5_VERSION_GE(1, 12, 0) && !H5_VERSION_GE(1, 12, 1))
    // Finished files appear whole, under their name; locks only fail on file systems that have none.
    check(H5Pset_file_locking(access.id(), false, true), "/", "HDF5 refuses its access properties");
#endif
    return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose, whole, "is truncated or damaged"};
}

std::vector<std::string> link_names(const Handle& group) {
    H5G_info_t info;
    check(H5Gget_info(group.id(), &info), place_of(group), "cannot be listed");
    std::vector<std::string> names;
    for (hsize_t i = 0; i < info.nlinks; ++i) {
        const auto get = [&](char* to, std::size_t room) {
            const ssize_t length = H5Lget_name_by_idx(group.id(), ".", H5_INDEX_CRT_ORDER, H5_ITER_INC, i, to, room,
                                                      H5P_DEFAULT);
            if (length <= 0) throw Error(place_of(group), "cannot be listed in the order in which it was made");
            return static_cast<std::size_t>(length);
        };
        std::string name(get(nullptr, 0), '\0');
        get(name.data(), name.size() + 1);
        // HDF5 writes no such name, and would take it for a path, which could lead through links to other files.
        if (name.find('/') != std::string::npos) throw Error(place_of(group, name), "has a name with a slash");
        names.push_back(hard(group, name));
    }
    return names;
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
    return H5Lexists(group.id(), name.c_str(), H5P_DEFAULT) > 0;
}
bool has_attribute(const Handle& object, const std::string& name) { return H5Aexists(object.id(), name.c_str()) > 0; }

Handle open_group(const Handle& parent, const std::string& name) {
    return {H5Gopen2(parent.id(), hard(parent, name).c_str(), H5P_DEFAULT), H5Gclose, place_of(parent, name),
            "is no readable group"};
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

Dataset::Dataset(const Handle& group, const std::string& name)
    : place_(place_of(group, name)),
      dataset_(H5Dopen2(group.id(), hard(group, name).c_str(), H5P_DEFAULT), H5Dclose, place_,
               "is no readable dataset"),
      type_(H5Dget_type(dataset_.id()), H5Tclose, place_, "HDF5 cannot read its type") {
    const Handle creation(H5Dget_create_plist(dataset_.id()), H5Pclose, place_, "HDF5 cannot read its layout");
    const H5D_layout_t layout = own_layout(creation);  // before HDF5 opens other files for a virtual dataset's extents
    const Handle space(H5Dget_space(dataset_.id()), H5Sclose, place_, "HDF5 cannot read its extents");
    const int rank = H5Sget_simple_extent_ndims(space.id());
    if (rank < 1) throw Error(place_, "has no extents");
    extents_.resize(static_cast<std::size_t>(rank));
    H5Sget_simple_extent_dims(space.id(), extents_.data(), nullptr);
    if (layout == H5D_CHUNKED && H5Pget_chunk(creation.id(), 0, nullptr) != rank)
        throw Error(place_, "is damaged: its chunks have other dimensions");
    check_storage(layout);
    for (const hsize_t extent : extents_) count_ *= extent;
}

/// How the values are kept; throws where that is in other files.
H5D_layout_t Dataset::own_layout(const Handle& creation) const {
    const H5D_layout_t layout = H5Pget_layout(creation.id());
    if (layout == H5D_VIRTUAL || H5Pget_external_count(creation.id()) != 0)
        throw Error(place_, "keeps its values in other files", "Copy them into this one");
    return layout;
}

/// Throws where the file is too small to hold what the extents promise.
void Dataset::check_storage(H5D_layout_t layout) const {
    if (std::find(extents_.begin(), extents_.end(), hsize_t{0}) != extents_.end()) return;
    hsize_t room = file_size(dataset_) * (layout == H5D_CHUNKED ? largest_compression : 1) /
                   std::max<hsize_t>(H5Tget_size(type_.id()), 1);
    const hsize_t stored = H5Dget_storage_size(dataset_.id());
    if (stored == 0) throw Error(place_, "has no values");
    for (const hsize_t extent : extents_) room /= extent;
    if (room == 0) throw Error(place_, extents_text(extents_) + " does not fit into the file");
    if (layout == H5D_CHUNKED) return;
    hsize_t needed = H5Tget_size(type_.id());  // HDF5 itself would read on behind what is stored
    for (const hsize_t extent : extents_) needed *= extent;
    if (stored < needed) throw Error(place_, extents_text(extents_) + " is more than is stored");
}

void Dataset::require_extents(const Extents& extents) const {
    if (extents_ != extents)
        throw Error(place_, "has extents " + extents_text(extents_) + ", not " + extents_text(extents));
}

void Dataset::require_type(hid_t type) const {
    if (H5Tequal(type_.id(), type) <= 0)
        throw Error(place_, "holds " + kind_text(type_.id()) + ", not " + kind_text(type));
}

std::vector<double> Dataset::read_real() const {
    if (H5Tget_class(type_.id()) != H5T_FLOAT) throw Error(place_, "holds " + kind_text(type_.id()) + ", not floats");
    std::vector<double> values(count_);
    read_into(H5T_NATIVE_DOUBLE, values.data());
    return values;
}

void Dataset::read_into(hid_t memory_type, void* values) const {
    check(H5Dread(dataset_.id(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), place_,
          "is damaged: HDF5 cannot read its values");
}

void Dataset::read_some_into(hid_t memory_type, hsize_t first, hsize_t count, void* values) const {
    const std::string problem = "is damaged: HDF5 cannot read its values";
    if (extents_.size() != 1 || first > extents_[0] || count > extents_[0] - first) throw Error(place_, "is too short");
    if (count == 0) return;
    const Handle space(H5Dget_space(dataset_.id()), H5Sclose, place_, problem),
        memory(H5Screate_simple(1, &count, nullptr), H5Sclose, place_, problem);
    check(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, &first, nullptr, &count, nullptr), place_, problem);
    check(H5Dread(dataset_.id(), memory_type, memory.id(), space.id(), H5P_DEFAULT, values), place_, problem);
}

std::string extents_text(const Extents& extents) {
    std::string text;
    for (const hsize_t extent : extents) text += (text.empty() ? "[" : ", ") + std::to_string(extent);
    return text + "]";
}

}  // namespace credence::hdf5
