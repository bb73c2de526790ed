// Object headers of version 1, which have neither signature nor checksum: found from the superblock and from the nodes
// of symbol tables (SNOD).

#include "hdf5_structure.hpp"

#include <set>

namespace credence::fuzz {

namespace {

constexpr std::uint64_t layout_message = 8, continuation_message = 16;

class OldHeaderWalk {
public:
    OldHeaderWalk(Image image, Structure& structure) : image_(image), structure_(structure) {}

    void header(std::uint64_t first) {
        constexpr std::uint64_t head = 16;
        if (!holds(image_, first, head) || number_at(image_, first, 1) != 1) return;
        chunk(first + head, number_at(image_, first + 8, 4));
    }

private:
    void chunk(std::uint64_t first, std::uint64_t length) {
        constexpr std::uint64_t head = 8;
        if (!holds(image_, first, length) || !seen_.insert(first).second) return;
        for (std::uint64_t at = first; at + head <= first + length;) {
            const std::uint64_t type = number_at(image_, at, 2), size = number_at(image_, at + 2, 2), body = at + head;
            if (body + size > first + length) return;
            if (size > 0) message(type, body, size);
            at = body + size;
        }
    }

    void message(std::uint64_t type, std::uint64_t body, std::uint64_t size) {
        structure_.regions.push_back({Region::Kind::message, body, size, static_cast<std::uint8_t>(type)});
        if (type == continuation_message) chunk(number_at(image_, body, 8), number_at(image_, body + 8, 8));
        if (type == layout_message) add_contiguous_data(image_, body, structure_);
    }

    Image image_;
    Structure& structure_;
    std::set<std::uint64_t> seen_;
};

}  // namespace

void add_root(Image image, Structure& structure) {
    if (number_at(image, 8, 1) == 0) OldHeaderWalk(image, structure).header(number_at(image, 64, 8));
}

void add_symbols(Image image, std::size_t node, Structure& structure) {
    constexpr std::uint64_t entry_size = 40;
    OldHeaderWalk walk(image, structure);
    for (std::uint64_t i = 0; i < number_at(image, node + 6, 2); ++i)
        walk.header(number_at(image, node + 8 + i * entry_size + 8, 8));
}

}  // namespace credence::fuzz
