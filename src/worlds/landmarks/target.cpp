// The part of a target that runs trials among landmarks; what deformable/target.cpp says holds here.

#include "slam/estimators/estimators.hpp"
#include "worlds/landmarks/trial.hpp"
#include "worlds/simulate.hpp"
#include "engine/simulate_batch.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

namespace {

/// A trial among landmarks.
template <class Tag>
struct LandmarkTrial {
    using View = LandmarkView;
    using Layout = credence::Layout<Process::heading, any_count>;
    using Real = Pack<CREDENCE_LANES>;
    using Workspace = CommonWorkspace<Layout, Real, typename Tag::template type<Layout, Real>>;

    static constexpr double truncate(const View&) { return __builtin_inf(); }
    void run(const View& problem, const KeyedDraws<Real>& draws, Detail<Layout, Real>& detail, Workspace& work,
             Real* columns, Real* all_series) const {
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
