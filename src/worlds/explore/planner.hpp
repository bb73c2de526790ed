#pragma once
// The controllers of the world `explore` [docs/explore.md]. Planning is the deformable world's: a candidate is
// predicted, what it would show is gated at the predicted mean, and its cost is that of the covariance after that; but
// what it would show is what is in sight there, and a wall forbids it. Letters as in measurement_space.hpp.

#include "slam/planning/baselines.hpp"
#include "slam/planning/planner.hpp"
#include "worlds/explore/view.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// The state with features that enter it: landmarks one by one are no groups where they can be absent.
struct ExploreLayout : Layout<Process::heading, any_count> {
    constexpr ExploreLayout(int features, int groups) : Layout(features), groups_(groups) {}
    constexpr int group_count() const { return groups_; }

private:
    int groups_;
};

/// Where a controller computes, and what a trial knows of the world beside the belief.
template <class Real>
struct ExploreState {
    using State = ExploreLayout;
    PlannerWorkspace<State, Real> planner;
    Mask<Real> mapped[State::feature_capacity];  ///< whether a sighting, or the start, has given the landmark its place
    Mask<Real>* viewed = nullptr;                ///< [cells]
    int *queue = nullptr, *from = nullptr;       ///< [cells] of a search through the grid

    /// Where landmark j is in the state.
    Mask<Real> present(const ExploreView& problem, int j) const {
        return problem.map == LandmarkMap::none ? mapped[j] : all_lanes<Real>();
    }
};

/// trace(W P+) of a candidate that moves the robot by u, by the sightings of which `sees(j, squared)` is true in some
/// lane.
template <class Real, class Sees>
CREDENCE_FLAT Real trace_in_measurement_space(const MeasurementSpace<ExploreLayout, Real>& space,
                                              const Vector2<Real>& u, const ExploreView& problem,
                                              const ExploreLayout& layout, const Sees& sees,
                                              MeasurementElimination<ExploreLayout, Real>& work) {
    const Vector2<Real> a{-u.y, u.x}, there = space.position + u;
    const Real half_squared = Real(0.5 * space.weights.position) * squared_norm(u);
    const Real variance = Real(problem.filter.variance_heading), weight = Real(space.weights.heading);
    Real N[ExploreLayout::feature_capacity];
    int of[ExploreLayout::feature_capacity], count = 0;
    for (int j = 0; j < layout.features(); ++j) {
        const Vector2<Real> d = space.feature[j] - there;
        const Real squared = squared_norm(d);
        work.seen[count] = sees(j, squared);
        if (!any(work.seen[count])) continue;
        N[count] = believed_variance(problem.filter, sigma_at(problem.sensor, squared));
        work.g[count] = {d.y, -d.x};
        work.v[count] = space.w[j] + scaled(variance, work.g[count]);
        work.c[count] = add_scaled(add_scaled(scaled(half_squared, space.w[j]), a.x, space.x[j]), a.y, space.y[j]);
        of[count++] = j;
    }
    for (int i = 0; i < count; ++i) {
        const Vector2<Real> noise = scaled(variance, work.g[i]), weighted = scaled(weight, work.v[i]);
        for (int l = i; l < count; ++l) {
            work.S[i][l] = add_outer(space.A[of[i]][of[l]], noise, work.g[l]);
            work.C[i][l] = add_outer(space.G[of[i]][of[l]], weighted, work.v[l]);
            work.C[i][l] = add_outer(work.C[i][l], space.w[of[i]], work.c[l]);
            work.C[i][l] = add_outer(work.C[i][l], work.c[i], space.w[of[l]]);
        }
        work.S[i][i] = add_noise(work.S[i][i], N[i]);
    }
    Real cost = space.prior.at(a, squared_norm(u));
    const ExploreLayout those(count, 0);
    for (int i = 0; i < count; ++i) cost = cost - take_out(those, i, work);
    return cost;
}

/// The candidate of least cost among those that no wall ends: by the belief about the state, or, `informed`, about the
/// truth. The robot stays where no candidate is left.
template <class Real, int capacity, int features>
class ExplorePlanner {
    using State = ExploreLayout;

public:
    ExplorePlanner(const ExploreView& problem, bool informed, const Belief<Real, capacity>& belief,
                   const Truth<Real, features>& truth, const State& layout, int k, ExploreState<Real>& work)
        : problem_(problem), informed_(informed), belief_(belief), truth_(truth), layout_(layout), k_(k), work_(work) {}

    /// Calls costs(i, cost, allowed) with every candidate's.
    template <class Costs>
    Command<Real> choose(const Costs& costs) {
        const ControlParameters& control = problem_.control;
        auto& planner = work_.planner;
        if (!is_trace(control.criterion)) return choose_plainly(costs).command;
        prepare_still(belief_, problem_.filter, layout_, k_, planner.still);
        look_from_truth();
        enter_measurement_space(planner.still, problem_.filter, layout_, control.weights, planner.space);
        const Choice<Real> fast = least_cost(
            [&](const Command<Real>&, const Vector2<Real>& u, const auto& sees) {
                return trace_in_measurement_space(planner.space, u, problem_, layout_, sees, planner.elimination);
            },
            costs);
        const Planning<State, Real> given{control, problem_.filter, problem_.sensor, layout_, planner};
        const Mask<Real> unsure =
            negated(lost_to_rounding(given, planner.space.prior.constant, 0) <= Real(most_lost) * least_);
        return any(unsure) ? chosen(unsure, choose_plainly(costs), fast).command : fast.command;
    }

    /// The same by the covariance after the update itself: slow, and the oracle of the fast form.
    template <class Costs>
    Choice<Real> choose_plainly(const Costs& costs) {
        auto& planner = work_.planner;
        prepare_candidates(belief_, problem_.filter, layout_, k_, planner.still);
        look_from_truth();
        Real of_absent(0);
        for (int j = 0; problem_.control.criterion == Criterion::log_det && j < layout_.features(); ++j)
            of_absent = of_absent + select(work_.present(problem_, j), Real(0), Real(2) * log(Real(absent_variance)));
        return least_cost(
            [&](const Command<Real>& command, const Vector2<Real>&, const auto& sees) {
                expect(planner.still, command, problem_.filter, problem_.sensor, layout_, sees, planner.next);
                return cost_of(planner.next.covariance, problem_.control, layout_) - of_absent;
            },
            costs);
    }

private:
    /// Costs are exact to about 10^-9 where no more than this share of them can be lost to rounding.
    static constexpr double most_lost = 2e5;

    void look_from_truth() {
        if (!informed_) return;
        Real* mean = work_.planner.still.mean;
        mean[State::heading] = truth_.heading;
        const auto set = [&](int i, const Vector2<Real>& place) { mean[i] = place.x, mean[i + 1] = place.y; };
        set(State::position, truth_.position);
        for (int j = 0; j < layout_.features(); ++j) set(State::feature(j), truth_.feature[j]);
    }

    /// Offers each candidate at `cost_of(command, u, sees)`, less what its new cells are worth.
    template <class Cost, class Costs>
    Choice<Real> least_cost(const Cost& cost_of, const Costs& costs) {
        const ControlParameters& control = problem_.control;
        const Real* mean = work_.planner.still.mean;
        const Rotation<Real> heading = rotation(mean[State::heading]);
        const Vector2<Real> here = point_at(mean, State::position);
        Choice<Real> choice = no_choice<Real>(control);
        least_ = without_limit<Real>();
        if (problem_.coverage > 0) choice.scale = CostScale::logarithmic;  // costs can be negative
        for (int i = 0; i < control.candidate_count; ++i) {
            const Command<Real> command = command_from<Real>(control.candidates[i]);
            const Vector2<Real> u = rotate(heading, command.move), there = here + u;
            Mask<Real> allowed = all_lanes<Real>();
            for (int w = 0; w < problem_.wall_count && any(allowed); ++w)
                allowed = both(allowed, negated(free_share(problem_.walls[w], problem_.radius, here, u) < Real(1)));
            if (!any(allowed)) continue;
            const Rotation<Real> turned = rotation(mean[State::heading] + command.turn);
            const auto sees = [&](int j, const Real& squared) {
                const Mask<Real> seen = both(work_.present(problem_, j), in_range(problem_.sensor, squared));
                return any(seen) ? both(seen, in_sight(problem_, there, turned,
                                                      point_at(mean, State::feature(j)) - there, squared))
                                 : seen;
            };
            Real cost = cost_of(command, u, sees);
            least_ = select(both(allowed, cost < least_), cost, least_);
            if (problem_.coverage > 0)
                each_new_cell(problem_, there, turned, work_.viewed, [&](int, Mask<Real> fresh) {
                    cost = cost - select(fresh, Real(problem_.coverage), Real(0));
                });
            choice.offer(command, cost, allowed);
            costs(i, cost, allowed);
        }
        return choice;
    }

    const ExploreView& problem_;
    bool informed_;
    const Belief<Real, capacity>& belief_;
    const Truth<Real, features>& truth_;
    const State& layout_;
    int k_;
    ExploreState<Real>& work_;
    Real least_{};  ///< cost of an allowed candidate, before what its cells are worth
};

/// The cell that a place is in, or the nearest one.
inline int cell_at(const Grid& grid, double x, double y) {
    const auto index = [&](double along, int count) {
        const double cells = along / grid.cell;
        return !(cells > 0) ? 0 : cells < count ? static_cast<int>(cells) : count - 1;
    };
    return index(y - grid.corner.y, grid.rows) * grid.columns + index(x - grid.corner.x, grid.columns);
}

/// The first cell on a shortest way through the grid from cell `start` to one that was not in view in that lane; -1 if
/// none is reached. Of equal ways the first one to be found, neighbours taken to the east, north, west and south.
template <class Real>
int towards_unviewed(const Grid& grid, int start, int lane, ExploreState<Real>& work) {
    for (int i = 0; i < grid.count(); ++i) work.from[i] = -1;
    work.from[start] = start;
    work.queue[0] = start;
    for (int next = 0, end = 1; next < end; ++next) {
        int cell = work.queue[next];
        if (cell != start && !(lane_bits(work.viewed[cell]) >> lane & 1)) {
            while (work.from[cell] != start) cell = work.from[cell];
            return cell;
        }
        for (int direction = 0; direction < 4; ++direction) {
            const int neighbour = grid.neighbour(cell, direction);
            if (!(grid.ways[cell] >> direction & 1) || work.from[neighbour] >= 0) continue;
            work.from[neighbour] = cell;
            work.queue[end++] = neighbour;
        }
    }
    return -1;
}

/// To the centre of the next cell on the way to the frontier or, where a wall stands before it, to that of its own.
template <class Real, int capacity>
Command<Real> towards_frontier(const ExploreView& problem, const Belief<Real, capacity>& belief,
                               ExploreState<Real>& work) {
    const Vector2<Real> here = point_at(belief.mean, ExploreLayout::position);
    Vector2<Real> place = here;
    for (int lane = 0; lane < lanes<Real>; ++lane) {
        const double x = lane_of(here.x, lane), y = lane_of(here.y, lane);
        const int own = cell_at(problem.grid, x, y), next = towards_unviewed(problem.grid, own, lane, work);
        if (next < 0) continue;
        Point centre = problem.grid.centre(next);
        for (int w = 0; w < problem.wall_count; ++w)
            if (free_share<double>(problem.walls[w], problem.radius, {x, y}, {centre.x - x, centre.y - y}) < 1) {
                centre = problem.grid.centre(own);
                break;
            }
        set_lane(place.x, lane, centre.x);
        set_lane(place.y, lane, centre.y);
    }
    return towards<ExploreLayout>(place, belief, problem.control.squared_reach);
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
