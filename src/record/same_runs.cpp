#include "record/same_runs.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// The first entry of the first dimension whose values differ; nothing where none do.
std::optional<std::uint64_t> first_difference(const RecordDataset& a, const RecordDataset& b) {
    constexpr std::uint64_t most_numbers = 1 << 20;
    const RecordExtents& extents = a.extents();
    std::uint64_t width = 1;
    for (std::size_t d = 1; d < extents.size(); ++d) width *= std::max<std::uint64_t>(extents[d], 1);
    const std::uint64_t rows = std::max<std::uint64_t>(most_numbers / width, 1);
    std::vector<double> of_a, of_b;
    for (std::uint64_t row = 0; row < extents.front(); row += rows) {
        RecordExtents first(extents.size(), 0), count = extents;
        first.front() = row;
        count.front() = std::min(rows, extents.front() - row);
        of_a.resize(count.front() * width);
        of_b.resize(of_a.size());
        a.read(first, count, of_a);
        b.read(first, count, of_b);
        const auto at = std::ranges::mismatch(of_a, of_b, same).in1;
        if (at != of_a.end()) return row + static_cast<std::uint64_t>(at - of_a.begin()) / width;
    }
    return std::nullopt;
}

}  // namespace

void require_same_runs(const RecordSource& first, const RecordSource& record) {
    const std::string remedy = "Give records of the same runs";
    if (const auto seed = record.seed(), other = first.seed(); seed && other && *seed != *other)
        throw RecordError(record_attribute_place("seed"), "is " + std::to_string(*seed) + ", and that of the first "
                          "record " + std::to_string(*other) + ": trials of different seeds are no pairs",
                          "Give records of the same seed");
    for (const char* path : {"error", "estimate", "trial", "truth", "time", "steps"}) {
        if (!first.has(path) || !record.has(path)) continue;
        const DatasetPointer a = first.open(path, Numbers::any), b = record.open(path, Numbers::any);
        if (a->extents() != b->extents())
            throw RecordError(b->place(), "is " + extents_text(b->extents()) + ", not " + extents_text(a->extents()) +
                                              " as in the first record: these are other runs", remedy);
        if (path == std::string("error") || path == std::string("estimate") || a->extents().empty()) continue;
        if (const std::optional<std::uint64_t> row = first_difference(*a, *b))
            throw RecordError(b->place(), "differs from that of the first record in entry " + std::to_string(*row) +
                                              ": these are other runs", remedy);
    }
}

}  // namespace credence
