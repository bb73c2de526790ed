// Blocks of fractal heaps and nodes of version-2 B-trees, found from their headers.

#include "hdf5_structure.hpp"

#include <algorithm>
#include <bit>

namespace credence::fuzz {

namespace {

constexpr std::size_t most_blocks = 4096;  ///< a damaged heap or tree could lead in circles

/// Bytes that a number up to `largest` takes.
std::size_t width_of(std::uint64_t largest) { return (static_cast<std::size_t>(std::bit_width(largest)) + 7) / 8; }

/// A fractal heap: its doubling table of direct blocks (FHDB), and indirect ones (FHIB) that point to them.
class HeapWalk {
public:
    HeapWalk(Image image, std::size_t header, Structure& structure) : image_(image), structure_(structure) {
        const auto at = [&](std::size_t offset, std::size_t width) { return number_at(image, header + offset, width); };
        const std::uint64_t filter_size = at(7, 2);
        const std::size_t covered = filter_size == 0 ? 142 : 154 + filter_size;
        if (!holds(image, header, covered + 4)) return;
        structure.summed.push_back({header, covered, header + covered});
        structure.regions.push_back({Region::Kind::block, header, covered, 0});
        if (filter_size != 0) return;  // blocks are compressed
        summed_ = (at(9, 1) & 2) != 0;
        columns_ = at(110, 2);
        start_size_ = at(112, 8);
        largest_direct_ = at(120, 8);
        offset_width_ = (at(128, 2) + 7) / 8;
        const std::uint64_t root = at(132, 8), rows = at(140, 2);
        if (columns_ == 0 || start_size_ == 0 || offset_width_ > 8) return;
        if (rows == 0)
            direct(root, start_size_);
        else
            indirect(root, rows);
    }

private:
    void direct(std::uint64_t first, std::uint64_t size) {
        const std::size_t sum_at = 13 + offset_width_;
        if (++blocks_ > most_blocks || size < sum_at + 4 || !holds(image_, first, size) ||
            !is_signature(image_, first, "FHDB"))
            return;
        if (summed_) structure_.summed.push_back({first, size, first + sum_at});
        structure_.regions.push_back({Region::Kind::block, first, size, 0});
    }

    void indirect(std::uint64_t first, std::uint64_t rows) {
        const std::uint64_t size = 13 + offset_width_ + rows * columns_ * 8;
        if (++blocks_ > most_blocks || rows > 64 || !holds(image_, first, size + 4) ||
            !is_signature(image_, first, "FHIB"))
            return;
        for (std::uint64_t entry = 0; entry < rows * columns_; ++entry)
            child(number_at(image_, first + 13 + offset_width_ + entry * 8, 8), entry / columns_);
        structure_.summed.push_back({first, size, first + size});
        structure_.regions.push_back({Region::Kind::block, first, size, 0});
    }

    /// Rows 0 and 1 hold blocks of the starting size, each one after that of twice the size of the one before.
    void child(std::uint64_t first, std::uint64_t row) {
        const std::uint64_t doublings = row == 0 ? 0 : row - 1;
        if (doublings > 40 || start_size_ > (std::uint64_t{1} << 23)) return;
        const std::uint64_t size = start_size_ << doublings;
        if (size <= largest_direct_) return direct(first, size);
        const auto own = static_cast<std::uint64_t>(std::bit_width(size / start_size_ / columns_));
        indirect(first, own);
    }

    Image image_;
    Structure& structure_;
    bool summed_ = false;
    std::uint64_t columns_ = 0, start_size_ = 0, largest_direct_ = 0;
    std::size_t offset_width_ = 0, blocks_ = 0;
};

/// A version-2 B-tree: records in leaves (BTLF) and in inner nodes (BTIN), which hold pointers behind theirs.
class TreeWalk {
public:
    TreeWalk(Image image, std::size_t header, Structure& structure) : image_(image), structure_(structure) {
        constexpr std::size_t covered = 34;
        if (!holds(image, header, covered + 4)) return;
        structure.summed.push_back({header, covered, header + covered});
        structure.regions.push_back({Region::Kind::block, header, covered, 0});
        const std::uint64_t node_size = number_at(image, header + 6, 4), depth = number_at(image, header + 12, 2);
        record_size_ = number_at(image, header + 10, 2);
        if (record_size_ == 0 || node_size < 10 || depth > 8) return;
        measure(node_size, depth);
        node(number_at(image, header + 16, 8), number_at(image, header + 24, 2), depth);
    }

private:
    /// How many records and how long a pointer a node of each depth has.
    void measure(std::uint64_t node_size, std::uint64_t depth) {
        const std::uint64_t leaf = (node_size - 10) / record_size_;
        count_width_ = width_of(leaf);
        std::uint64_t total = leaf;  // of records below and in a node of that depth
        total_widths_.push_back(0);
        for (std::uint64_t level = 1; level <= depth; ++level) {
            const std::uint64_t pointer = 8 + count_width_ + total_widths_.back();
            const std::uint64_t own =
                node_size < 10 + pointer ? 0 : (node_size - 10 - pointer) / (record_size_ + pointer);
            total = std::min(own + (own + 1) * total, std::uint64_t{1} << 60);
            total_widths_.push_back(width_of(total));
        }
    }

    void node(std::uint64_t first, std::uint64_t records, std::uint64_t depth) {
        std::uint64_t size = 6 + records * record_size_;
        const std::uint64_t pointers = first + size;
        const std::size_t pointer = depth == 0 ? 0 : 8 + count_width_ + total_widths_[depth - 1];
        if (depth > 0) size += (records + 1) * pointer;
        if (++nodes_ > most_blocks || !holds(image_, first, size + 4) ||
            !is_signature(image_, first, depth == 0 ? "BTLF" : "BTIN"))
            return;
        structure_.summed.push_back({first, size, first + size});
        structure_.regions.push_back({Region::Kind::block, first, size, 0});
        for (std::uint64_t child = 0; depth > 0 && child <= records; ++child) {
            const std::uint64_t at = pointers + child * pointer;
            node(number_at(image_, at, 8), number_at(image_, at + 8, count_width_), depth - 1);
        }
    }

    Image image_;
    Structure& structure_;
    std::uint64_t record_size_ = 0;
    std::size_t count_width_ = 0, nodes_ = 0;
    std::vector<std::size_t> total_widths_;  ///< of the number of records below a node of that depth; leaves have none
};

}  // namespace

void add_heap(Image image, std::size_t header, Structure& structure) { HeapWalk(image, header, structure); }
void add_tree(Image image, std::size_t header, Structure& structure) { TreeWalk(image, header, structure); }

}  // namespace credence::fuzz
