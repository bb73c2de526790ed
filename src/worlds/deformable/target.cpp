// One unit of the engine. CMake compiles this file once for each instruction set, with CREDENCE_TARGET naming it and
// CREDENCE_LANES saying how many trials run at once. Nothing here may emit a symbol outside that namespace: no
// containers, no library calls.

#include "worlds/deformable/pack_trial.hpp"
#include "worlds/simulate.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

namespace {

/// Calls use(std::type_identity<Trial>) with the one that fits: a few features are written out by the compiler, more
/// run the same source, rolled. Same bits either way.
template <Process process, class Use>
auto with_process(const ProblemView& problem, const Arm& arm, const Use& use) {
    using Real = Pack<CREDENCE_LANES>;
    if (arm.estimator != own_estimator(process) || arm.planner >= 0)
        return with_estimator<process>(arm.estimator, [&](auto tag) {
            return use(std::type_identity<DeformableTrial<Layout<process, any_count>, Real, decltype(tag)>>{});
        });
    const auto own = [&](auto features) {
        return use(std::type_identity<DeformableTrial<Layout<process, features()>, Real>>{});
    };
    switch (problem.features) {
#if CREDENCE_WRITTEN_OUT > 3
        case 1: return own(Known<1>{});
        case 2: return own(Known<2>{});
        case 4: return own(Known<4>{});
#endif
#if CREDENCE_WRITTEN_OUT > 4
        case 5: return own(Known<5>{});
        case 6: return own(Known<6>{});
#endif
#if CREDENCE_WRITTEN_OUT > 0
        case 3: return own(Known<3>{});
#endif
        default: return own(Known<any_count>{});
    }
}

template <class Use>
auto with_trial(const ProblemView& problem, const Arm& arm, const Use& use) {
    if (problem.process == Process::heading) return with_process<Process::heading>(problem, arm, use);
    return with_process<Process::translation>(problem, arm, use);
}

}  // namespace

void simulate(const ProblemView& problem, const Arm& arm, const Batch& batch) {
    with_trial(problem, arm, [&](auto type) {
        simulate_arm<typename decltype(type)::type>(problem, arm, batch);
    });
}

std::size_t workspace_size(const ProblemView& problem, const Arm& arm) {
    return with_trial(problem, arm, [&](auto type) {
        return workspace_size_of<typename decltype(type)::type>(problem, arm.planner);
    });
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
