#include <credence/error.hpp>
#include "worlds/simulate.hpp"
#include <credence/text.hpp>

#include <cstdlib>

#ifdef CREDENCE_X86_TARGETS
#include <cpuid.h>
#endif

namespace credence {

inline CREDENCE_DECLARE_TARGET(portable)  // CREDENCE_TARGET by default, hence inline here too
#ifdef CREDENCE_X86_TARGETS
CREDENCE_DECLARE_TARGET(v3)
#endif
#ifdef CREDENCE_TARGET_V4
CREDENCE_DECLARE_TARGET(v4)
#endif

namespace {

#ifdef CREDENCE_X86_TARGETS
/// The instructions of x86-64-v3 that a compiler may use and that clang 14 cannot ask for by name.
bool has_lzcnt_movbe_f16c() {
    constexpr unsigned movbe = 1u << 22, f16c = 1u << 29, lzcnt = 1u << 5;
    unsigned eax = 0, ebx = 0, basic = 0, extended = 0, edx = 0;
    return __get_cpuid(1, &eax, &ebx, &basic, &edx) && __get_cpuid(0x80000001, &eax, &ebx, &extended, &edx) &&
           (basic & movbe) && (basic & f16c) && (extended & lzcnt);
}

bool runs_v3() {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
           __builtin_cpu_supports("bmi2") && has_lzcnt_movbe_f16c();
}

#ifdef CREDENCE_TARGET_V4
bool runs_v4() {
    return runs_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
}
#endif
#endif

/// A target of this build, and whether this processor runs it.
struct BuiltTarget {
    Target target;
    bool runs = false;
};

/// The best one first.
std::vector<BuiltTarget> built_targets() {
    return {
#ifdef CREDENCE_TARGET_V4
        {CREDENCE_LIST_TARGET(v4, 8), runs_v4()},
#endif
#ifdef CREDENCE_X86_TARGETS
        {CREDENCE_LIST_TARGET(v3, 4), runs_v3()},
#endif
        {CREDENCE_LIST_TARGET(portable, 1), true}};
}

/// The target of this name; throws InputError where there is none that runs.
Target forced_target(const std::string& name) {
    std::vector<std::string> runnable;
    std::string why = "this program was not built for it";
    for (const auto& [target, runs] : built_targets()) {
        if (runs && target.name == name) return target;
        if (runs)
            runnable.push_back(target.name);
        else if (target.name == name)
            why = "this processor cannot run it";
    }
    throw invalid_value(force_target_variable, name, why, "Unset it, or give one of " + joined(runnable));
}

}  // namespace

std::vector<Target> runnable_targets() {
    std::vector<Target> targets;
    for (const auto& [target, runs] : built_targets())
        if (runs) targets.push_back(target);
    return targets;
}

Target best_target() {
    const char* forced = std::getenv(force_target_variable);
    return forced ? forced_target(forced) : runnable_targets().front();
}

}  // namespace credence
