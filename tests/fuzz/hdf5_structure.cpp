#include "hdf5_structure.hpp"

#include <cstring>
#include <set>

namespace credence::fuzz {

namespace {

constexpr std::size_t sum_size = 4;
constexpr std::uint8_t layout_message = 8, continuation_message = 16;

/// Walks the messages of an object header through all its chunks.
class HeaderWalk {
public:
    HeaderWalk(Image image, std::size_t header, Structure& structure)
        : image_(image), structure_(structure), flags_(static_cast<std::uint8_t>(number_at(image, header + 5, 1))) {
        std::size_t at = header + 6;
        if (flags_ & 0x20) at += 16;  // times
        if (flags_ & 0x10) at += 4;   // when attributes go into a heap
        const std::size_t width = std::size_t{1} << (flags_ & 3);
        const std::uint64_t size = number_at(image, at, width);
        at += width;
        if (holds(image, at, size + sum_size)) chunk(header, at, at + size);
    }

private:
    /// Messages from `at` to `end`, where the checksum of everything from `first` stands.
    void chunk(std::size_t first, std::size_t at, std::size_t end) {
        if (!seen_.insert(first).second) return;
        structure_.summed.push_back({first, end - first, end});
        const std::size_t head = flags_ & 4 ? 6 : 4;  // with the order of creation, or without
        while (at + head <= end) {
            const auto type = static_cast<std::uint8_t>(number_at(image_, at, 1));
            const std::size_t size = number_at(image_, at + 1, 2), body = at + head;
            if (body + size > end) return;
            if (size > 0) message(type, body, size);
            at = body + size;
        }
    }

    void message(std::uint8_t type, std::size_t body, std::size_t size) {
        structure_.regions.push_back({Region::Kind::message, body, size, type});
        if (type == layout_message) add_contiguous_data(image_, body, structure_);
        if (type != continuation_message) return;
        const std::uint64_t next = number_at(image_, body, 8), length = number_at(image_, body + 8, 8);
        if (length >= 8 && holds(image_, next, length) && is_signature(image_, next, "OCHK"))
            chunk(next, next + 4, next + length - sum_size);
    }

    Image image_;
    Structure& structure_;
    std::uint8_t flags_;
    std::set<std::size_t> seen_;
};

/// Superblocks of version 2 and 3 have a checksum, older ones have none.
void add_superblock(Image image, Structure& structure) {
    constexpr std::size_t covered = 44;
    if (number_at(image, 8, 1) >= 2 && holds(image, 0, covered + sum_size))
        structure.summed.push_back({0, covered, covered});
}

}  // namespace

std::uint64_t number_at(Image image, std::size_t at, std::size_t width) {
    if (!holds(image, at, width)) return 0;
    std::uint64_t number = 0;
    for (std::size_t i = width; i-- > 0;) number = number << 8 | image[at + i];
    return number;
}

bool holds(Image image, std::uint64_t first, std::uint64_t length) {
    return length <= image.size() && first <= image.size() - length;
}

bool is_signature(Image image, std::uint64_t at, const char* letters) {
    return holds(image, at, 4) && std::memcmp(image.data() + at, letters, 4) == 0;
}

void add_contiguous_data(Image image, std::size_t layout, Structure& structure) {
    if (number_at(image, layout, 1) != 3 || number_at(image, layout + 1, 1) != 1) return;
    const std::uint64_t first = number_at(image, layout + 2, 8), length = number_at(image, layout + 10, 8);
    if (length > 0 && holds(image, first, length))
        structure.regions.push_back({Region::Kind::data, first, length, 0});
}

Structure structure_of(Image image) {
    Structure structure;
    add_superblock(image, structure);
    add_root(image, structure);
    for (std::size_t at = 0; at + 4 <= image.size(); ++at) {
        if (is_signature(image, at, "OHDR")) HeaderWalk(image, at, structure);
        if (is_signature(image, at, "SNOD")) add_symbols(image, at, structure);
        if (is_signature(image, at, "FRHP")) add_heap(image, at, structure);
        if (is_signature(image, at, "BTHD")) add_tree(image, at, structure);
    }
    return structure;
}

}  // namespace credence::fuzz
