// Datasets, checked before they are read.

#include "files/hdf5/read.hpp"

#include "files/hdf5/write.hpp"

#include <algorithm>

namespace credence::hdf5 {

namespace {

/// Deflate, the strongest of the usual filters, never compresses by more than this.
constexpr hsize_t largest_compression = 1100;

}  // namespace

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

/// The layout of the stored values; throws where they are in other files.
H5D_layout_t Dataset::own_layout(const Handle& creation) const {
    const H5D_layout_t layout = H5Pget_layout(creation.id());
    if (layout == H5D_VIRTUAL || H5Pget_external_count(creation.id()) != 0)
        throw Error(place_, "keeps its values in other files", "Copy them into this one");
    return layout;
}

/// Throws where the file is too small to hold as much as the extents say.
void Dataset::check_storage(H5D_layout_t layout) const {
    if (std::find(extents_.begin(), extents_.end(), hsize_t{0}) != extents_.end()) return;
    const hsize_t stored = H5Dget_storage_size(dataset_.id());
    // 0 is also what HDF5 returns after an error of the system.
    if (stored == 0) throw failure(place_, "has no values");
    const hsize_t file = file_size(dataset_);
    // Chunks that were never written take no space in the file, so their extents cannot be checked against its size.
    hsize_t room = (layout == H5D_CHUNKED ? std::min(stored, file) * largest_compression : file) /
                   std::max<hsize_t>(H5Tget_size(type_.id()), 1);
    for (const hsize_t extent : extents_) room /= extent;
    if (room == 0) throw Error(place_, extents_text(extents_) + " does not fit into what is stored");
    if (layout == H5D_CHUNKED) return;
    hsize_t needed = H5Tget_size(type_.id());  // HDF5 itself would read beyond the stored bytes
    for (const hsize_t extent : extents_) needed *= extent;
    if (stored < needed) throw Error(place_, extents_text(extents_) + " is more than is stored");
}

void Dataset::require_extents(const Extents& extents) const {
    if (extents_ != extents)
        throw Error(place_, "has extents " + extents_text(extents_) + ", not " + extents_text(extents));
}

bool Dataset::has_type(hid_t type) const { return H5Tequal(type_.id(), type) > 0; }

void Dataset::require_type(hid_t type) const {
    if (!has_type(type)) throw Error(place_, "holds " + kind_text(type_.id()) + ", not " + kind_text(type));
}

std::vector<double> Dataset::read_real() const {
    if (H5Tget_class(type_.id()) != H5T_FLOAT) throw Error(place_, "holds " + kind_text(type_.id()) + ", not floats");
    std::vector<double> values(count_);
    read_into(H5T_NATIVE_DOUBLE, values.data());
    return values;
}

void Dataset::check_sum(std::uint32_t crc) const {
    if (has_attribute(dataset_, checksum_name) && read_number<std::int64_t>(dataset_, checksum_name) != crc)
        throw Error(place_, "is damaged: its values do not have their checksum");
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

}  // namespace credence::hdf5
