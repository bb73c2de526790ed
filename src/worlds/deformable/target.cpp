// One unit of the engine. CMake compiles this file once for each instruction set, with CREDENCE_TARGET naming it and
// CREDENCE_LANES saying how many trials run at once. Nothing here may emit a symbol outside that namespace: no
// containers, no library calls.

#include "slam/estimators/estimators.hpp"
#include "worlds/simulate.hpp"
#include "engine/detail.hpp"
#include "engine/simulate_batch.hpp"
#include "slam/trial/trial.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

namespace {

/// A trial in the deforming world.
template <class Layout, class Real, class Tag = EstimatorTag<KalmanFilter>>
struct DeformableTrial
    : WatchedTrial<ProblemView, Layout, Real, Workspace<Layout, Real, typename Tag::template type<Layout, Real>>> {
    Controller controller;

    explicit DeformableTrial(Controller one) : controller(one) {}
    static double truncate(const ProblemView& problem) { return problem.world.truncate; }
    void run(const ProblemView& problem, const KeyedDraws<Real>& draws, const PackPlace<Real>&, void* room,
             PackDetails<Real>& details, Real* columns, Real* all_series) const {
        auto& [work, detail] = *static_cast<typename DeformableTrial::Room*>(room);
        detail.watch(problem, details);
        run_trial(problem, controller, draws, detail, work, columns, all_series);
    }
};

/// Calls use(std::type_identity<Trial>) with the one that fits: a few features are written out by the compiler, more
/// run the same source, rolled. Same bits either way.
template <Process process, class Use>
auto with_process(const ProblemView& problem, Estimator estimator, const Use& use) {
    using Real = Pack<CREDENCE_LANES>;
    if (estimator != own_estimator(process))
        return with_estimator<process>(estimator, [&](auto tag) {
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
auto with_trial(const ProblemView& problem, Estimator estimator, const Use& use) {
    if (problem.process == Process::heading) return with_process<Process::heading>(problem, estimator, use);
    return with_process<Process::translation>(problem, estimator, use);
}

}  // namespace

void simulate(const ProblemView& problem, const Arm& arm, const Batch& batch) {
    with_trial(problem, arm.estimator, [&](auto type) {
        using Trial = typename decltype(type)::type;
        BatchOf<Trial>::simulate(problem, Trial(arm.controller), batch);
    });
}

std::size_t workspace_size(const ProblemView& problem, Estimator estimator) {
    return with_trial(problem, estimator,
                      [&](auto type) { return BatchOf<typename decltype(type)::type>::workspace_size(problem); });
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
