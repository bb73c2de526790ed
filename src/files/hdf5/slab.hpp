#pragma once
// Reading files of other programs: parts of datasets of floating-point numbers, stored in any way, and text of any
// kind. The checks are those of read.hpp.

#include "files/hdf5/read.hpp"

namespace credence::hdf5 {

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
    Handle dataset_;
    Extents chunk_;
    double epsilon_ = 0;
};

/// Throws where the bits of a type of integers lie beyond its bytes: HDF5 would read them there.
void require_bits(const Handle& type, const std::string& place);

/// A text attribute without padding: fixed or variable length, ASCII or UTF-8, a scalar or a list, whose entries are
/// joined by commas.
std::string read_any_text(const Handle& object, const std::string& name);

}  // namespace credence::hdf5
