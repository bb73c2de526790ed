#pragma once
// Masks of packs beside the same comparisons of plain doubles. Included by a test and, compiled for AVX-512, by
// lane_masks_v4.cpp.

#include <credence/detail/lane.hpp>

namespace credence {
inline namespace CREDENCE_TARGET {

/// In how many lanes packs of W of the numbers are told wrong whether low <= x <= high, or lose the answer on the way
/// from a mask to bits and back. `numbers` [count], count a multiple of W.
template <int W>
int wrong_masks(const double* numbers, int count, double low, double high) {
    int wrong = 0;
    for (int first = 0; first < count; first += W) {
        const Pack<W> x = load<Pack<W>>(numbers + first);
        const auto mask = within(x, Pack<W>(low), Pack<W>(high));
        const unsigned told[] = {lane_bits(mask), lane_bits(mask_of_bits<Pack<W>>(lane_bits(mask)))};
        for (const unsigned bits : told)
            for (int i = 0; i < W; ++i)
                wrong += (bits >> i & 1) != (low <= numbers[first + i] && numbers[first + i] <= high);
    }
    return wrong;
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
