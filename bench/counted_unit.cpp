// The engine's own source once more, one trial at a time, so that only useful work is done: what no lane sees is
// skipped, and there is one lane.

#include "counted_unit.hpp"

#include "numeric/lane.hpp"

#include "counted.hpp"

namespace credence {
inline namespace CREDENCE_UNIT {
template <>
struct PackOf<CREDENCE_LANES> {
    using type = Counted;
};
}  // namespace CREDENCE_UNIT
}  // namespace credence

#define CREDENCE_WRITTEN_OUT 3
#include "../src/worlds/deformable/unit.cpp"

namespace credence::bench {

Unit counted_unit() {
    return {"counted", 1, credence::CREDENCE_UNIT::simulate, credence::CREDENCE_UNIT::workspace_size};
}

std::uint64_t counted_operations() { return Counted::operations; }

}  // namespace credence::bench
