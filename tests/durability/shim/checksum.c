/* NO_CHECKSUMS: a planted bug. Every checksum is 0, as if none were compared. */
#include "shim.h"

uint32_t libdeflate_crc32(uint32_t crc, const void *bytes, size_t size) {
    REAL(libdeflate_crc32, "libdeflate_crc32");
    return is_on("NO_CHECKSUMS") ? 0 : real(crc, bytes, size);
}
