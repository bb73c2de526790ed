// Reading files of other programs.

#include "files/hdf5/read.hpp"

#include <credence/text.hpp>

#include <algorithm>
#include <cmath>

namespace credence::hdf5 {

namespace {

constexpr std::size_t longest_attribute = std::size_t{1} << 20;

/// 2^-52, or more where the type has fewer digits.
double epsilon_of(const Handle& type) {
    std::size_t sign = 0, exponent = 0, exponent_size = 0, mantissa = 0, mantissa_size = 0;
    H5Tget_fields(type.id(), &sign, &exponent, &exponent_size, &mantissa, &mantissa_size);
    return std::ldexp(1.0, -static_cast<int>(std::min<std::size_t>(mantissa_size, 52)));
}

std::size_t element_count(const Handle& attribute, const std::string& place) {
    const Handle space(H5Aget_space(attribute.id()), H5Sclose, place, "HDF5 cannot read its extents");
    if (H5Sget_simple_extent_type(space.id()) == H5S_NULL) return 0;
    return static_cast<std::size_t>(std::max<hssize_t>(H5Sget_simple_extent_npoints(space.id()), 0));
}

/// The text without the nulls and spaces that languages pad with.
std::string without_padding(const std::string& text) { return trimmed(text.substr(0, text.find('\0'))); }

std::vector<std::string> variable_texts(const Handle& attribute, const Handle& type, std::size_t count,
                                        const std::string& place) {
    std::vector<char*> pointers(count, nullptr);
    check(H5Aread(attribute.id(), type.id(), pointers.data()), place, "HDF5 cannot read it");
    std::vector<std::string> texts;
    for (const char* text : pointers) texts.push_back(without_padding(text == nullptr ? "" : text));
    const Handle space(H5Aget_space(attribute.id()), H5Sclose, place, "HDF5 cannot read its extents");
    H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, pointers.data());
    return texts;
}

std::vector<std::string> fixed_texts(const Handle& attribute, const Handle& type, std::size_t count,
                                     const std::string& place) {
    const std::size_t size = H5Tget_size(type.id());
    if (size == 0 || size > longest_attribute / count) throw Error(place, "is longer than it can be");
    std::string all(size * count, '\0');
    check(H5Aread(attribute.id(), type.id(), all.data()), place, "HDF5 cannot read it");
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < count; ++i) texts.push_back(without_padding(all.substr(i * size, size)));
    return texts;
}

}  // namespace

void require_bits(const Handle& type, const std::string& place) {
    const std::size_t bits = 8 * H5Tget_size(type.id()), precision = H5Tget_precision(type.id());
    const int offset = H5Tget_offset(type.id());
    if (precision == 0 || precision > bits || offset < 0 || static_cast<std::size_t>(offset) > bits - precision)
        throw Error(place, "is damaged: its integers lie beyond their bytes");
}

RealDataset::RealDataset(const Handle& group, const std::string& name, bool integers)
    : checked_(group, name), chunk_(checked_.extents().size(), 1) {
    const Handle type(H5Dget_type(checked_.object().id()), H5Tclose, place(), "HDF5 cannot read its type");
    const H5T_class_t kind = H5Tget_class(type.id());
    if (kind != H5T_FLOAT && !integers)
        throw Error(place(), "does not hold floating-point numbers", "Write it as doubles, or as singles");
    if (kind != H5T_FLOAT && kind != H5T_INTEGER) throw Error(place(), "does not hold numbers", "Write it as integers");
    if (kind == H5T_FLOAT) epsilon_ = epsilon_of(type);
    else require_bits(type, place());
    const Handle creation(H5Dget_create_plist(checked_.object().id()), H5Pclose, place(),
                          "HDF5 cannot read its layout");
    if (H5Pget_layout(creation.id()) != H5D_CHUNKED) return;
    H5Pget_chunk(creation.id(), static_cast<int>(chunk_.size()), chunk_.data());
    require_filters(creation);
}

/// Throws where the values are compressed with a filter that this HDF5 does not have.
void RealDataset::require_filters(const Handle& creation) const {
    for (int i = 0; i < H5Pget_nfilters(creation.id()); ++i) {
        unsigned flags = 0, settings = 0;
        std::size_t setting_count = 0;
        char name[64] = "";
        const H5Z_filter_t filter = H5Pget_filter2(creation.id(), static_cast<unsigned>(i), &flags, &setting_count,
                                                   &settings, sizeof name - 1, name, nullptr);
        if (filter < 0 || H5Zfilter_avail(filter) <= 0)
            throw Error(place(), "is compressed by a filter that is not installed, " + std::to_string(filter) + " `" +
                                     printable(name) + "`",
                        "Write it with gzip, or uncompressed");
    }
}

void RealDataset::read(const Extents& first, const Extents& count, std::vector<double>& values) const {
    const Handle space(H5Dget_space(checked_.object().id()), H5Sclose, place(), "HDF5 cannot read its extents");
    const Handle memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose, place(),
                        "HDF5 gives no extents");
    check(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, first.data(), nullptr, count.data(), nullptr), place(),
          "HDF5 cannot select a part of it");
    check(H5Dread(checked_.object().id(), H5T_NATIVE_DOUBLE, memory.id(), space.id(), H5P_DEFAULT, values.data()),
          place(), "is damaged: HDF5 cannot read its values");
}

std::string read_any_text(const Handle& object, const std::string& name) {
    const std::string place = attribute_place(object, name);
    const Handle attribute(H5Aopen(object.id(), name.c_str(), H5P_DEFAULT), H5Aclose, place, "HDF5 cannot open it");
    const Handle type(H5Aget_type(attribute.id()), H5Tclose, place, "HDF5 cannot read its type");
    if (H5Tget_class(type.id()) != H5T_STRING) throw Error(place, "is not text");
    const std::size_t count = element_count(attribute, place);
    if (count == 0) return {};
    if (count > longest_attribute) throw Error(place, "is longer than it can be");
    return joined(H5Tis_variable_str(type.id()) > 0 ? variable_texts(attribute, type, count, place)
                                                    : fixed_texts(attribute, type, count, place));
}

}  // namespace credence::hdf5
