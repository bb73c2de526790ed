// The part of a target that runs trials of the world `explore`; what deformable/target.cpp says holds here.

#include "slam/estimators/estimators.hpp"
#include "worlds/explore/trial.hpp"
#include "worlds/simulate.hpp"
#include "engine/detail.hpp"
#include "engine/simulate_batch.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

namespace {

using Real = Pack<CREDENCE_LANES>;
template <class Tag>
using WorkspaceOf = ExploreWorkspace<Real, typename Tag::template type<ExploreLayout, Real>>;

/// A trial in this world, its cells behind the rest of its room.
template <class Tag>
struct ExploreTrial : WatchedTrial<ExploreView, ExploreLayout, Real, WorkspaceOf<Tag>> {
    using Room = typename WatchedTrial<ExploreView, ExploreLayout, Real, WorkspaceOf<Tag>>::Room;
    Explorer controller;

    explicit ExploreTrial(Explorer one) : controller(one) {}
    static double truncate(const ExploreView& problem) { return problem.world.truncate; }
    static int column_count(const ExploreView&) { return explore_column_count; }
    static std::size_t padded(std::size_t bytes) { return (bytes + 63) / 64 * 64; }
    static std::size_t viewed_size(const ExploreView& problem) {
        return padded(static_cast<std::size_t>(problem.grid.count()) * sizeof(Mask<Real>));
    }
    static std::size_t cells_size(const ExploreView& problem) {
        return padded(static_cast<std::size_t>(problem.grid.count()) * sizeof(int));
    }
    static std::size_t room(const ExploreView& problem) {
        return padded(sizeof(Room)) + viewed_size(problem) + 2 * cells_size(problem);
    }
    void run(const ExploreView& problem, const KeyedDraws<Real>& draws, const PackPlace<Real>&, void* room,
             PackDetails<Real>& details, Real* columns, Real* all_series) const {
        auto& [work, detail] = *static_cast<Room*>(room);
        std::byte* behind = static_cast<std::byte*>(room) + padded(sizeof(Room));
        work.viewed = reinterpret_cast<Mask<Real>*>(behind);
        work.queue = reinterpret_cast<int*>(behind + viewed_size(problem));
        work.from = reinterpret_cast<int*>(behind + viewed_size(problem) + cells_size(problem));
        detail.watch(problem, details);
        run_trial(problem, controller, draws, detail, work, columns, all_series);
    }
};

}  // namespace

void simulate_explore(const ExploreView& problem, const ExploreArm& arm, const Batch& batch) {
    with_estimator<Process::heading>(arm.estimator, [&](auto tag) {
        using Trial = ExploreTrial<decltype(tag)>;
        BatchOf<Trial>::simulate(problem, Trial(arm.controller), batch);
    });
}

std::size_t explore_workspace_size(const ExploreView& problem, Estimator estimator) {
    return with_estimator<Process::heading>(estimator, [&](auto tag) {
        return BatchOf<ExploreTrial<decltype(tag)>>::workspace_size(problem);
    });
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
