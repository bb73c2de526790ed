// The engine's own source, compiled once more for one trial at a time, so that only useful operations are counted: with
// a single lane, work for unseen features is skipped.

#include "counted_target.hpp"

#include <credence/detail/lane.hpp>

#include "counted.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {
template <>
struct PackOf<CREDENCE_LANES> {
    using type = Counted;
};
}  // namespace CREDENCE_TARGET
}  // namespace credence

#define CREDENCE_WRITTEN_OUT 3
#include "../src/worlds/deformable/target.cpp"

namespace credence::bench {

Target counted_target() {
    return {"counted", 1, credence::CREDENCE_TARGET::simulate, credence::CREDENCE_TARGET::workspace_size};
}

std::uint64_t counted_operations() { return Counted::operations; }

}  // namespace credence::bench
