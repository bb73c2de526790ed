#pragma once
// What the targets of HDF5 files share.

#include "hdf5_checksums.hpp"
#include "hdf5_mutator.hpp"
#include "other_files.hpp"
#include "require.hpp"
#include "scratch_file.hpp"

#include <credence/error.hpp>

#include <span>
#include <string>

namespace credence::fuzz {

/// `read` reads the input as a file, or refuses it by an InputError of one line; it opens no other, and leaves none
/// open.
template <class Read>
int try_file(const std::uint8_t* data, std::size_t size, const Read& read) {
    const ScratchFile file(data, size);
    const OnlyFile only(file.path());
    try {
        read(file.path());
    } catch (const InputError& error) {
        require_one_line(error.what());
    }
    require_all_closed();
    return 0;
}

/// A report takes bootstraps, ten times as long as reading: it is made for one in eight inputs, and only for small
/// ones.
inline bool is_chosen(std::span<const std::uint8_t> image) { return metadata_checksum(image) % 8 == 0; }

}  // namespace credence::fuzz
