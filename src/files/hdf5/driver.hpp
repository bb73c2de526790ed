#pragma once
// An HDF5 file driver that writes through a ByteFile. HDF5 may crash at exit after the system refused a write; through
// this driver HDF5 never sees such an error: the ByteFile keeps the first one and ignores later writes.

#include "files/system/byte_file.hpp"
#include "files/hdf5/handle.hpp"

namespace credence::hdf5 {

/// A new HDF5 file, readable by every release from 1.8 on, whose bytes are written to `bytes`, which must outlive it.
/// After closing it, check `bytes` for an error.
Handle new_file(ByteFile& bytes);

}  // namespace credence::hdf5
