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
    static constexpr bool consults = true;
    Explorer controller;
    Chosen<Real> chosen;

    ExploreTrial(Explorer one, const Chosen<Real>& by_planner) : controller(one), chosen(by_planner) {}
    static double truncate(const ExploreView& problem) { return problem.world.truncate; }
    static int column_count(const ExploreView&) { return explore_column_count; }
    static std::size_t room(const ExploreView& problem) {
        Pieces pieces;
        place(problem, pieces);
        return pieces.size();
    }
    static Room& enter(const ExploreView& problem, void* room, PackDetails<Real>& details) {
        Pieces pieces(static_cast<std::byte*>(room));
        Room& entered = *place(problem, pieces);
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

private:
    /// The room, and behind it what a trial keeps of the cells and plans ahead in.
    static Room* place(const ExploreView& problem, Pieces& pieces) {
        const auto cells = static_cast<std::size_t>(problem.grid.count()),
                   steps = static_cast<std::size_t>(problem.control.horizon);
        Room* room = pieces.take<Room>(1);
        auto* viewed = pieces.take<Mask<Real>>(steps * cells);
        int *queue = pieces.take<int>(cells), *from = pieces.take<int>(cells);
        auto* ahead = pieces.take<Belief<Real, ExploreLayout::capacity>>(steps > 1 ? steps : 0);
        if (room != nullptr)
            room->work.viewed = viewed, room->work.queue = queue, room->work.from = from, room->work.ahead = ahead;
        return room;
    }
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
