#include "hdf5_checksums.hpp"

#include <algorithm>
#include <bit>

namespace credence::fuzz {

namespace {

struct Sums {
    std::uint32_t a = 0, b = 0, c = 0;

    void mix() {
        const auto step = [](std::uint32_t& x, std::uint32_t& y, std::uint32_t& z, int bits) {
            x -= z;
            x ^= std::rotl(z, bits);
            z += y;
        };
        step(a, b, c, 4);
        step(b, c, a, 6);
        step(c, a, b, 8);
        step(a, b, c, 16);
        step(b, c, a, 19);
        step(c, a, b, 4);
    }

    void finish() {
        const auto step = [](std::uint32_t& x, std::uint32_t y, int bits) {
            x ^= y;
            x -= std::rotl(y, bits);
        };
        step(c, b, 14);
        step(a, c, 11);
        step(b, a, 25);
        step(c, b, 16);
        step(a, c, 4);
        step(b, a, 14);
        step(c, b, 24);
    }
};

/// Up to four bytes, little-endian, as if zeros followed.
std::uint32_t word(std::span<const std::uint8_t> bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < std::min(at + 4, bytes.size()); ++i)
        value |= std::uint32_t{bytes[i]} << (8 * (i - at));
    return value;
}

void write_word(Image image, std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) image[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

}  // namespace

std::uint32_t metadata_checksum(std::span<const std::uint8_t> bytes) {
    const std::uint32_t start = 0xdeadbeefu + static_cast<std::uint32_t>(bytes.size());
    Sums sums{start, start, start};
    if (bytes.empty()) return sums.c;
    std::size_t at = 0;
    for (; bytes.size() - at > 12; at += 12) {
        sums.a += word(bytes, at);
        sums.b += word(bytes, at + 4);
        sums.c += word(bytes, at + 8);
        sums.mix();
    }
    sums.a += word(bytes, at);
    sums.b += word(bytes, at + 4);
    sums.c += word(bytes, at + 8);
    sums.finish();
    return sums.c;
}

void repair_checksums(Image image) { repair_checksums(image, structure_of(image)); }

void repair_checksums(Image image, const Structure& structure) {
    for (const Summed& part : structure.summed) {
        const bool inside = part.sum_at < part.first + part.length;
        if (inside) write_word(image, part.sum_at, 0);
        write_word(image, part.sum_at, metadata_checksum(image.subspan(part.first, part.length)));
    }
}

}  // namespace credence::fuzz
