#include "targets.hpp"

#include <algorithm>

namespace credence {

#ifdef CREDENCE_X86_TARGETS
CREDENCE_DECLARE_TARGET(one_lane)
#endif

namespace bench {

std::vector<Target> measured_targets() {
    std::vector<Target> targets = runnable_targets();
#ifdef CREDENCE_X86_TARGETS
    const auto v3 =
        std::find_if(targets.begin(), targets.end(), [](const Target& target) { return target.name == "v3"; });
    if (v3 != targets.end()) targets.insert(v3 + 1, CREDENCE_LIST_TARGET(one_lane, 1));
#endif
    return targets;
}

}  // namespace bench
}  // namespace credence
