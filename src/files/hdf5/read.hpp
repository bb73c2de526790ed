#pragma once
// Reading HDF5. Files are not trusted: kind, type, rank, extents and storage are checked before anything is allocated.
// HDF5's own parser has known overflows on crafted files; newer releases have fewer.

#include <credence/error.hpp>

#include "files/hdf5/handle.hpp"
#include "files/system/checksum.hpp"

#include <algorithm>

namespace credence::hdf5 {

// All functions but `read_file` throw Error.

/// Opens a file for reading, after checks of our own: a regular file that starts with HDF5's signature.
Handle open_file(const std::string& path);

/// The size in bytes of the file that contains the object.
hsize_t file_size(const Handle& object);

/// The name of a type in messages, such as `64-bit floats`.
std::string kind_text(hid_t type);

/// Names of a group's links, and of an object's attributes, in the order of their creation. Links other than hard ones
/// could lead to other files and are refused.
std::vector<std::string> link_names(const Handle& group);
std::vector<std::string> attribute_names(const Handle& object);
/// Those of links in alphabetical order: other programs need not keep the order of their creation.
std::vector<std::string> sorted_link_names(const Handle& group);
bool has_link(const Handle& group, const std::string& name);
bool has_attribute(const Handle& object, const std::string& name);

/// Returns `name`; throws unless it is a hard link. Soft links could lead anywhere, external ones to other files: no
/// object may be opened by name without this check.
const std::string& hard(const Handle& group, const std::string& name);

Handle open_group(const Handle& parent, const std::string& name);

/// A scalar attribute of fixed-length text, without the nulls that pad it.
std::string read_text(const Handle& object, const std::string& name);

void read_attribute(const Handle& object, const std::string& name, Type type, void* value);

/// A scalar attribute of exactly T's type.
template <class T>
T read_number(const Handle& object, const std::string& name) {
    T value{};
    read_attribute(object, name, type_of<T>(), &value);
    return value;
}

constexpr hsize_t values_at_once = hsize_t{1} << 17;

/// A dataset whose storage is consistent with its extents. Where it has a checksum, its values must have it too.
class Dataset {
public:
    Dataset(const Handle& group, const std::string& name);

    const std::string& place() const { return place_; }
    const Extents& extents() const { return extents_; }
    /// The dataset's handle, for its attributes.
    const Handle& object() const { return dataset_; }
    /// Whether the type in the file is exactly T's.
    template <class T>
    bool holds() const {
        return has_type(type_of<T>().file);
    }
    /// Throws where the extents differ; the message shows both.
    void require_extents(const Extents& extents) const;

    /// All values, row-major; the type in the file must be exactly T's.
    template <class T>
    std::vector<T> read() const {
        require<T>();
        std::vector<T> values(count_);
        read_into(type_of<T>().memory, values.data());
        check_sum(checksum(values.data(), values.size() * sizeof(T)));
        return values;
    }
    /// Of a one-dimensional dataset: values first ... first + count - 1, which must exist; the type as for read().
    template <class T>
    std::vector<T> read_some(hsize_t first, hsize_t count) const {
        require<T>();
        std::vector<T> values(count);
        read_some_into(type_of<T>().memory, first, count, values.data());
        return values;
    }
    /// Of a one-dimensional dataset: all values in order, a part at a time, which bounds the memory that long ones
    /// take; each part is passed to `visit`, and begins at a multiple of `values_at_once`. Throws at the end where the
    /// values do not have the checksum that was written with them.
    template <class T, class Visit>
    void read_parts(Visit visit) const {
        std::uint32_t crc = 0;
        for (hsize_t first = 0; first < count_; first += values_at_once) {
            const std::vector<T> part = read_some<T>(first, std::min(values_at_once, count_ - first));
            crc = checksum(part.data(), part.size() * sizeof(T), crc);
            visit(part);
        }
        check_sum(crc);
    }
    /// Throws unless the type in the file is exactly T's.
    template <class T>
    void require() const {
        require_type(type_of<T>().file);
    }
    /// All values, row-major, of any floating-point type.
    std::vector<double> read_real() const;

private:
    H5D_layout_t own_layout(const Handle& creation) const;
    void check_storage(H5D_layout_t layout) const;
    bool has_type(hid_t type) const;
    void require_type(hid_t type) const;
    void check_sum(std::uint32_t crc) const;
    void read_into(hid_t memory_type, void* values) const;
    void read_some_into(hid_t memory_type, hsize_t first, hsize_t count, void* values) const;

    std::string place_;
    Handle dataset_, type_;
    Extents extents_;
    std::size_t count_ = 1;
};

// Files of other programs: parts of datasets of numbers, stored in any way, and text of any kind.

/// A dataset of numbers of any size that is read in parts, as doubles.
class RealDataset {
public:
    /// Throws where it holds anything but floating-point numbers or, if `integers` may be there, integers.
    RealDataset(const Handle& group, const std::string& name, bool integers);

    const std::string& place() const { return checked_.place(); }
    const Extents& extents() const { return checked_.extents(); }
    /// Distance of 1 from the next number in the file's floating type, at least 2^-52.
    double epsilon() const { return epsilon_; }
    /// The extents of a chunk, or 1 in each dimension where the storage is not chunked.
    const Extents& chunk() const { return chunk_; }

    /// Values at first ... first + count - 1 in each dimension, row-major. `values` has as many.
    void read(const Extents& first, const Extents& count, std::vector<double>& values) const;

private:
    void require_filters(const Handle& creation) const;

    Dataset checked_;
    Extents chunk_;
    double epsilon_ = 0;
};

/// Throws where the bits of a type of integers lie beyond its bytes: HDF5 would read them there.
void require_bits(const Handle& type, const std::string& place);

/// A text attribute without padding: fixed or variable length, ASCII or UTF-8, a scalar or a list, whose entries are
/// joined by commas.
std::string read_any_text(const Handle& object, const std::string& name);

/// The result of `read` on a file. Throws its PlacedError as InputError `FILE: PLACE: PROBLEM. REMEDY.`
template <class Read>
auto translated(const std::string& path, const std::string& usual_remedy, Read read) {
    try {
        const QuietErrors quiet;
        return read();
    } catch (const PlacedError& error) {
        Complaint complaint = error.complaint();
        if (complaint.remedy.empty()) complaint.remedy = usual_remedy;
        throw InputError(complaint).at(path);
    }
}

/// Opens a file and returns the result of `read` on it, its errors translated.
template <class Read>
auto read_file(const std::string& path, const std::string& usual_remedy, Read read) {
    return translated(path, usual_remedy, [&] { return read(open_file(path)); });
}

}  // namespace credence::hdf5
