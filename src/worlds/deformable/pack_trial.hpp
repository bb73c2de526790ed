#pragma once
// A trial in the deforming world as the engine runs it.

#include "engine/consulted.hpp"
#include "slam/estimators/estimators.hpp"
#include "slam/trial/trial.hpp"

#include <type_traits>

namespace credence {
inline namespace CREDENCE_TARGET {

/// A trial in the deforming world.
/// `consults` is false where the features are written out, for which no planner is compiled.
template <class Layout, class Real, class Tag = EstimatorTag<KalmanFilter>>
struct DeformableTrial
    : WatchedTrial<ProblemView, Layout, Real, Workspace<Layout, Real, typename Tag::template type<Layout, Real>>> {
    using Steps = credence::Steps<Layout, Real, typename Tag::template type<Layout, Real>, KeyedDraws<Real>,
                                  Detail<Layout, Real>>;
    static constexpr bool consults = std::is_same_v<decltype(Layout(0).features()), int>;
    Controller controller;
    Chosen<Real> chosen;

    DeformableTrial(Controller one, const Chosen<Real>& by_planner) : controller(one), chosen(by_planner) {}
    static double truncate(const ProblemView& problem) { return problem.world.truncate; }
    void run(const ProblemView& problem, const KeyedDraws<Real>& draws, const PackPlace<Real>& place, void* room,
             PackDetails<Real>& details, Real* columns, Real* all_series) const {
        auto& [work, detail] = *static_cast<typename DeformableTrial::Room*>(room);
        detail.watch(problem, details);
        run_trial(problem, controller, draws, detail, work, columns, all_series, chosen.of(place));
    }

    // As of Consulted.
    static Steps steps(const ProblemView& problem, const KeyedDraws<Real>& draws, std::byte* room,
                       PackDetails<Real>& details) {
        auto& [work, detail] = *reinterpret_cast<typename DeformableTrial::Room*>(room);
        detail.watch(problem, details);
        return Steps(problem, draws, detail, work);
    }
    static std::size_t cells(const ProblemView&) { return 0; }
    static void describe_cells(const ProblemView&, PlannerBatch&) {}
    static void tell(const ProblemView& problem, Steps&, int, unsigned char* known, unsigned char*) {
        for (int j = 0; j < problem.features; ++j) known[j] = true;
    }
    template <class Price>
    static void ahead(const ProblemView& problem, Steps&, int, const Price& price) {
        for (int i = 0; i < problem.control.candidate_count; ++i)
            price(i, command_from<Real>(problem.control.candidates[i]), all_lanes<Real>(),
                  [&](auto, const Real& squared) { return in_range(problem.sensor, squared); }, Real(0));
    }
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
