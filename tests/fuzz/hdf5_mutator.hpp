#pragma once
// A mutator of HDF5 files for libFuzzer, whose checksums always fit.

#include "hdf5_structure.hpp"

#include <functional>

namespace credence::fuzz {

/// Changes an image of `size` bytes with room for `room`: any bytes, or what a structure of the file says, a number or
/// text in its messages, blocks or raw data. `repair`, where given, then changes it further, before the checksums are
/// written anew. Returns the new size.
std::size_t mutate_hdf5(std::uint8_t* image, std::size_t size, std::size_t room, unsigned seed,
                        const std::function<void(Image)>& repair = {});

}  // namespace credence::fuzz
