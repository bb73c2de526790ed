#include "files/system/checksum.hpp"

#include <libdeflate.h>

namespace credence {

std::uint32_t checksum(const void* bytes, std::size_t size, std::uint32_t crc) {
    return libdeflate_crc32(crc, bytes, size);
}

}  // namespace credence
