#include <credence/simulate.hpp>

namespace credence {

inline namespace portable {  // CREDENCE_UNIT by default, hence inline here too
void simulate(const ProblemView&, const Batch&);
}
#ifdef CREDENCE_HAS_V3
namespace v3 {
void simulate(const ProblemView&, const Batch&);
}
#endif

std::vector<Unit> runnable_units() {
    std::vector<Unit> units;
#ifdef CREDENCE_HAS_V3
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) units.push_back({"v3", v3::simulate});
#endif
    units.push_back({"portable", portable::simulate});
    return units;
}

SimulateFunction simulate_function() { return runnable_units().front().simulate; }

std::string instruction_set() { return runnable_units().front().name; }

}  // namespace credence
