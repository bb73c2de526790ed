#pragma once
// The checksum of journals and of the datasets of results files.

#include <cstddef>
#include <cstdint>

namespace credence {

/// The CRC-32 of zlib, continued from `crc`.
std::uint32_t checksum(const void* bytes, std::size_t size, std::uint32_t crc = 0);

}  // namespace credence
