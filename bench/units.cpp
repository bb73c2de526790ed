#include "units.hpp"

#include <algorithm>

namespace credence {

#ifdef CREDENCE_X86_UNITS
CREDENCE_DECLARE_UNIT(one_lane)
#endif

namespace bench {

std::vector<Unit> measured_units() {
    std::vector<Unit> units = runnable_units();
#ifdef CREDENCE_X86_UNITS
    const auto v3 = std::find_if(units.begin(), units.end(), [](const Unit& unit) { return unit.name == "v3"; });
    if (v3 != units.end()) units.insert(v3 + 1, CREDENCE_LIST_UNIT(one_lane, 1));
#endif
    return units;
}

}  // namespace bench
}  // namespace credence
