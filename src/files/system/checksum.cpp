#include "files/system/checksum.hpp"

#include <zlib.h>

namespace credence {

std::uint32_t checksum(const void* bytes, std::size_t size, std::uint32_t crc) {
    return static_cast<std::uint32_t>(crc32_z(crc, static_cast<const Bytef*>(bytes), size));
}

}  // namespace credence
