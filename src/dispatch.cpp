#include <credence/simulate.hpp>

namespace credence {

inline namespace portable {  // CREDENCE_UNIT by default, hence inline here too
void simulate(const ProblemView&, const Batch&);
}
#ifdef CREDENCE_X86_UNITS
namespace v3 {
void simulate(const ProblemView&, const Batch&);
}
namespace v4 {
void simulate(const ProblemView&, const Batch&);
}
#endif

namespace {

#ifdef CREDENCE_X86_UNITS
bool runs_v3() {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
           __builtin_cpu_supports("bmi2");
}

bool runs_v4() {
    return runs_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
}
#endif

}  // namespace

std::vector<Unit> runnable_units() {
    std::vector<Unit> units;
#ifdef CREDENCE_X86_UNITS
    if (runs_v4()) units.push_back({"v4", 8, v4::simulate});
    if (runs_v3()) units.push_back({"v3", 4, v3::simulate});
#endif
    units.push_back({"portable", 1, portable::simulate});
    return units;
}

Unit best_unit() { return runnable_units().front(); }

}  // namespace credence
