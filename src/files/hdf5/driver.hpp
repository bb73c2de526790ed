#pragma once
// HDF5's way to the disk. HDF5 may crash at its exit where the system refused it a write; here it never learns
// of that: the first error is kept for us, and what follows goes nowhere.

#include "files/system/byte_file.hpp"
#include "files/hdf5/handle.hpp"

namespace credence::hdf5 {

/// A new HDF5 file, readable by every release from 1.8 on, whose bytes go into `bytes`, which must outlive it. After
/// closing it ask `bytes` whether they are there.
Handle new_file(ByteFile& bytes);

}  // namespace credence::hdf5
