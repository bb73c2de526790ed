// The part of a target that runs trials of the world `explore`; what deformable/target.cpp says holds here.

#include "worlds/explore/pack_trial.hpp"
#include "worlds/simulate.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

namespace {

using Real = Pack<CREDENCE_LANES>;

}  // namespace

void simulate_explore(const ExploreView& problem, const ExploreArm& arm, const Batch& batch) {
    with_estimator<Process::heading>(arm.estimator, [&](auto tag) {
        simulate_arm<ExploreTrial<Real, decltype(tag)>>(problem, arm, batch);
    });
}

std::size_t explore_workspace_size(const ExploreView& problem, const ExploreArm& arm) {
    return with_estimator<Process::heading>(arm.estimator, [&](auto tag) {
        return workspace_size_of<ExploreTrial<Real, decltype(tag)>>(problem, arm.planner);
    });
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
