#pragma once
// A trial in the world `explore` as the engine runs it.

#include "engine/consulted.hpp"
#include "slam/estimators/estimators.hpp"
#include "worlds/explore/trial.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

template <class Real, class Tag>
using ExploreWorkspaceOf = ExploreWorkspace<Real, typename Tag::template type<ExploreLayout, Real>>;

/// A trial in this world, its cells behind the rest of its room.
template <class Number, class Tag>
struct ExploreTrial : WatchedTrial<ExploreView, ExploreLayout, Number, ExploreWorkspaceOf<Number, Tag>> {
    using Real = Number;
    using Room = typename WatchedTrial<ExploreView, ExploreLayout, Number, ExploreWorkspaceOf<Number, Tag>>::Room;
    using Steps = ExploreSteps<Real, typename Tag::template type<ExploreLayout, Real>, KeyedDraws<Real>,
                               Detail<ExploreLayout, Real>>;
    using Ahead = Belief<Real, ExploreLayout::capacity>;
    static constexpr bool consults = true;
    Explorer controller;
    Chosen<Real> chosen;

    ExploreTrial(Explorer one, const Chosen<Real>& by_planner) : controller(one), chosen(by_planner) {}
    static double truncate(const ExploreView& problem) { return problem.world.truncate; }
    static int column_count(const ExploreView&) { return explore_column_count; }
    static std::size_t padded(std::size_t bytes) { return (bytes + 63) / 64 * 64; }
    static std::size_t viewed_size(const ExploreView& problem) {
        return padded(static_cast<std::size_t>(problem.grid.count() * problem.control.horizon) * sizeof(Mask<Real>));
    }
    static std::size_t cells_size(const ExploreView& problem) {
        return padded(static_cast<std::size_t>(problem.grid.count()) * sizeof(int));
    }
    static std::size_t ahead_size(const ExploreView& problem) {
        return problem.control.horizon > 1 ? static_cast<std::size_t>(problem.control.horizon) * sizeof(Ahead) : 0;
    }
    static std::size_t room(const ExploreView& problem) {
        return padded(sizeof(Room)) + viewed_size(problem) + 2 * cells_size(problem) + ahead_size(problem);
    }
    static Room& enter(const ExploreView& problem, void* room, PackDetails<Real>& details) {
        Room& entered = *static_cast<Room*>(room);
        std::byte* behind = static_cast<std::byte*>(room) + padded(sizeof(Room));
        entered.work.viewed = reinterpret_cast<Mask<Real>*>(behind);
        entered.work.queue = reinterpret_cast<int*>(behind + viewed_size(problem));
        entered.work.from = reinterpret_cast<int*>(behind + viewed_size(problem) + cells_size(problem));
        entered.work.ahead = reinterpret_cast<Ahead*>(behind + viewed_size(problem) + 2 * cells_size(problem));
        entered.detail.watch(problem, details);
        return entered;
    }
    void run(const ExploreView& problem, const KeyedDraws<Real>& draws, const PackPlace<Real>& place, void* room,
             PackDetails<Real>& details, Real* columns, Real* all_series) const {
        auto& [work, detail] = enter(problem, room, details);
        run_trial(problem, controller, draws, detail, work, columns, all_series, chosen.of(place));
    }

    // As of Consulted.
    static Steps steps(const ExploreView& problem, const KeyedDraws<Real>& draws, std::byte* room,
                       PackDetails<Real>& details) {
        auto& [work, detail] = enter(problem, room, details);
        return Steps(problem, draws, detail, work);
    }
    static std::size_t cells(const ExploreView& problem) { return static_cast<std::size_t>(problem.grid.count()); }
    static void describe_cells(const ExploreView& problem, PlannerBatch& batch) {
        batch.cell_rows = problem.grid.rows;
        batch.cell_columns = problem.grid.columns;
    }
    static void tell(const ExploreView& problem, Steps& steps, int lane, unsigned char* known, unsigned char* viewed) {
        for (int j = 0; j < problem.features; ++j) known[j] = lane_bits(steps.work().present(problem, j)) >> lane & 1;
        for (int i = 0; i < problem.grid.count(); ++i) viewed[i] = lane_bits(steps.work().viewed[i]) >> lane & 1;
    }
    template <class Price>
    static void ahead(const ExploreView& problem, Steps& steps, int, const Price& price) {
        each_candidate_ahead<Real>(problem, steps.work().planner.still.mean, steps.work(), [](int, Mask<Real>) {},
                                   price);
    }
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
