// The part of a target that runs trials among landmarks; what deformable/target.cpp says holds here.

#include "slam/estimators/estimators.hpp"
#include "worlds/landmarks/trial.hpp"
#include "worlds/simulate.hpp"
#include "engine/detail.hpp"
#include "engine/simulate_batch.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

namespace {

using Real = Pack<CREDENCE_LANES>;
using StateLayout = Layout<Process::heading, any_count>;

/// A trial among landmarks.
template <class Tag>
struct LandmarkTrial
    : WatchedTrial<LandmarkView, StateLayout, Real,
                   CommonWorkspace<StateLayout, Real, typename Tag::template type<StateLayout, Real>>> {
    static constexpr double truncate(const LandmarkView&) { return __builtin_inf(); }
    void run(const LandmarkView& problem, const KeyedDraws<Real>& draws, const PackPlace<Real>&, void* room,
             PackDetails<Real>& details, Real* columns, Real* all_series) const {
        auto& [work, detail] = *static_cast<typename LandmarkTrial::Room*>(room);
        detail.watch(problem, details);
        run_trial(problem, draws, detail, work, columns, all_series);
    }
};

}  // namespace

void simulate_landmarks(const LandmarkView& problem, Estimator estimator, const Batch& batch) {
    with_estimator<Process::heading>(estimator, [&](auto tag) {
        BatchOf<LandmarkTrial<decltype(tag)>>::simulate(problem, {}, batch);
    });
}

std::size_t landmarks_workspace_size(const LandmarkView& problem, Estimator estimator) {
    return with_estimator<Process::heading>(estimator, [&](auto tag) {
        return BatchOf<LandmarkTrial<decltype(tag)>>::workspace_size(problem);
    });
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
