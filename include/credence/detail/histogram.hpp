#pragma once
// Module statistics: histograms of a sample, with bins of round width.

#include <cstdint>
#include <vector>

namespace credence {

/// equal: bins of one width. ratio: bins of one ratio, the same edges for every sample: 10^(i/24).
enum class BinWidths { equal, ratio };

/// Bin b holds the values in [edges[b], edges[b + 1]). Values beyond the 0.1 % and 99.9 % quantiles may lie in no bin.
struct Histogram {
    BinWidths widths = BinWidths::equal;
    std::vector<double> edges;  ///< one more than counts; none for no values
    std::vector<std::int64_t> counts;
    std::int64_t below = 0, above = 0;  ///< values before the first edge, and from the last one on

    std::int64_t total() const;
};

/// Counts values without NaN, of which it reorders some; there are about `about` bins of equal width, and at most some
/// hundred of equal ratio. Where all values are whole, a bin of equal width holds a whole number of them, its edges
/// half-way between. Else 0 is an edge. Bins of equal ratio need positive values: others count as below.
Histogram histogram(std::vector<double>& values, BinWidths widths, int about = 48);

}  // namespace credence
