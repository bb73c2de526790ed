#pragma once
// Where the parts of an HDF5 file image lie, as far as a mutator needs it: what checksums cover, and what is worth
// changing. Written after the HDF5 File Format Specification, version 3; only files with 8-byte addresses and lengths.
// An image may be damaged in any way: what does not fit into it is left out.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace credence::fuzz {

using Image = std::span<std::uint8_t>;

/// Bytes first ... first + length - 1 have their checksum at `sum_at`, right behind them or, as four bytes that count
/// as 0, among them.
struct Summed {
    std::size_t first = 0, length = 0, sum_at = 0;
};

/// What is worth changing: the body of a message of an object header, a block of a heap or a tree, or raw data.
struct Region {
    enum class Kind { message, block, data };
    Kind kind = Kind::message;
    std::size_t first = 0, length = 0;
    std::uint8_t type = 0;  ///< of a message: 1 dataspace, 3 datatype, 6 link, 8 layout, 11 filters, 12 attribute ...
};

struct Structure {
    std::vector<Summed> summed;
    std::vector<Region> regions;
};

Structure structure_of(Image image);

/// A little-endian number of `width` bytes; 0 where the image ends before it.
std::uint64_t number_at(Image image, std::size_t at, std::size_t width);

/// Whether all of first ... first + length - 1 is in the image.
bool holds(Image image, std::uint64_t first, std::uint64_t length);

/// Whether the four letters stand there.
bool is_signature(Image image, std::uint64_t at, const char* letters);

/// Raw data of a contiguous dataset, from the body of its layout message.
void add_contiguous_data(Image image, std::size_t layout, Structure& structure);

// Parts of structure_of, in hdf5_old_headers.cpp: objects that the superblock or a node of a symbol table (SNOD) names.
void add_root(Image image, Structure& structure);
void add_symbols(Image image, std::size_t node, Structure& structure);

// Parts of structure_of, in hdf5_trees.cpp: blocks that belong to the header of a heap (FRHP) or a tree (BTHD).
void add_heap(Image image, std::size_t header, Structure& structure);
void add_tree(Image image, std::size_t header, Structure& structure);

}  // namespace credence::fuzz
