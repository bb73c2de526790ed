#pragma once
// HDF5 refuses metadata whose checksum does not fit, before any reader of ours sees it. A mutator writes them anew.

#include "hdf5_structure.hpp"

namespace credence::fuzz {

/// Writes the checksums of superblock, object headers, fractal heaps and version-2 B-trees anew. Blocks are summed up
/// in any order: none of them covers another's checksum.
void repair_checksums(Image image);
void repair_checksums(Image image, const Structure& structure);

/// Bob Jenkins' lookup3 (hashlittle, initial value 0), the checksum of HDF5's metadata.
std::uint32_t metadata_checksum(std::span<const std::uint8_t> bytes);

}  // namespace credence::fuzz
