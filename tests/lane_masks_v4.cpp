// lane_masks.hpp for AVX-512, in a namespace of its own like the engine's targets.

#include "lane_masks.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

int wrong_masks_of_eight(const double* numbers, int count, double low, double high) {
    return wrong_masks<8>(numbers, count, low, high);
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
