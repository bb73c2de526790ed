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
    Belief<Real, State::capacity> of_one;         ///< of the trial that is planned for, in all lanes
    MeasurementSpace<State, Real> space_of_one;
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
/// truth. The robot stays where no candidate is left. Lanes hold the trials of a pack until the measurement space is
/// entered; then, one trial after the other, its candidates, which see much the same, as trials do not.
template <class Real, int capacity, int features>
class ExplorePlanner {
    using State = ExploreLayout;

public:
    ExplorePlanner(const ExploreView& problem, bool informed, const Belief<Real, capacity>& belief,
                   const Truth<Real, features>& truth, const State& layout, int k, ExploreState<Real>& work)
        : problem_(problem), informed_(informed), belief_(belief), truth_(truth), layout_(layout), k_(k), work_(work) {}

    /// Calls costs(i, cost, allowed) with the candidates' of every trial.
    template <class Costs>
    Command<Real> choose(const Costs& costs) {
        auto& planner = work_.planner;
        const bool fast = is_trace(problem_.control.criterion);
        Real lost(__builtin_inf());
        if (fast) {
            prepare_still(belief_, problem_.filter, layout_, k_, planner.still);
            look_from_truth();
            enter_measurement_space(planner.still, problem_.filter, layout_, problem_.control.weights, planner.space);
            const Planning<State, Real> given{problem_.control, problem_.filter, problem_.sensor, layout_, planner};
            lost = lost_to_rounding(given, planner.space.prior.constant, 0);
        }
        Control controls[lanes<Real>];
        for (int lane = 0; lane < lanes<Real>; ++lane) {
            Choice<double> choice;
            double least = 0;
            if (fast) choice = choose_in_space(lane, costs, least);
            if (!(lane_of(lost, lane) <= most_lost * least)) choice = choose_plainly(lane, costs);
            controls[lane] = {choice.command.turn, {choice.command.move.x, choice.command.move.y}};
        }
        return in_lanes_of(controls, lanes<Real>);
    }

    /// The choice in one lane by the covariance after the update itself: slow, and the oracle of the fast form.
    template <class Costs>
    Choice<double> choose_plainly(int lane, const Costs& costs) {
        auto& planner = work_.planner;
        prepare_candidates(belief_, problem_.filter, layout_, k_, planner.still);
        look_from_truth();
        auto& one = work_.of_one;
        take_lane(lane, planner.still.mean, layout_.size(), one.mean);
        for (int i = 0; i < layout_.size(); ++i)
            take_lane(lane, planner.still.covariance.entry[i] + i, layout_.size() - i, one.covariance.entry[i] + i);
        double of_absent = 0;
        for (int j = 0; problem_.control.criterion == Criterion::log_det && j < layout_.features(); ++j)
            if (!is_present(j, lane)) of_absent += 2 * log(absent_variance);
        double least = 0;
        return least_cost(
            lane,
            [&](const Command<Real>& command, const Vector2<Real>&, const auto& sees) {
                expect(one, command, problem_.filter, problem_.sensor, layout_, sees, planner.next);
                return cost_of(planner.next.covariance, problem_.control, layout_) - Real(of_absent);
            },
            costs, least);
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

    /// One lane's numbers in all lanes. `from`, `to` [count] of Reals, or of what consists of them.
    template <class Numbers>
    static void take_lane(int lane, const Numbers* from, int count, Numbers* to) {
        const Real* source = reinterpret_cast<const Real*>(from);
        Real* target = reinterpret_cast<Real*>(to);
        const int reals = count * static_cast<int>(sizeof(Numbers) / sizeof(Real));
        for (int i = 0; i < reals; ++i) target[i] = Real(lane_of(source[i], lane));
    }

    /// The controls [count], one in each lane; in further lanes the first.
    static Command<Real> in_lanes_of(const Control* controls, int count) {
        double turn[lanes<Real>], x[lanes<Real>], y[lanes<Real>];
        for (int i = 0; i < lanes<Real>; ++i) {
            const Control& own = controls[i < count ? i : 0];
            turn[i] = own.turn, x[i] = own.move.x, y[i] = own.move.y;
        }
        return {load<Real>(turn), {load<Real>(x), load<Real>(y)}};
    }

    bool is_present(int j, int lane) const { return lane_bits(work_.present(problem_, j)) >> lane & 1; }

    template <class Costs>
    Choice<double> choose_in_space(int lane, const Costs& costs, double& least) {
        const auto& all = work_.planner.space;
        auto& one = work_.space_of_one;
        const int M = layout_.features();
        one.weights = all.weights;
        take_lane(lane, &all.position, 1, &one.position);
        take_lane(lane, &all.prior, 1, &one.prior);
        take_lane(lane, all.feature, M, one.feature);
        take_lane(lane, all.w, M, one.w);
        take_lane(lane, all.x, M, one.x);
        take_lane(lane, all.y, M, one.y);
        for (int j = 0; j < M; ++j) {
            take_lane(lane, all.A[j] + j, M - j, one.A[j] + j);
            take_lane(lane, all.G[j] + j, M - j, one.G[j] + j);
        }
        take_lane(lane, work_.planner.still.mean, layout_.size(), work_.of_one.mean);
        return least_cost(
            lane,
            [&](const Command<Real>&, const Vector2<Real>& u, const auto& sees) {
                return trace_in_measurement_space(one, u, problem_, layout_, sees, work_.planner.elimination);
            },
            costs, least);
    }

    /// Offers each candidate at `cost_of(command, u, sees)`, less what its new cells are worth, from the mean in
    /// `of_one`. `least`: without that worth.
    template <class Cost, class Costs>
    Choice<double> least_cost(int lane, const Cost& cost_of, const Costs& costs, double& least) {
        const ControlParameters& control = problem_.control;
        const Real* mean = work_.of_one.mean;
        const Rotation<Real> heading = rotation(mean[State::heading]);
        const Vector2<Real> here = point_at(mean, State::position);
        const Mask<Real> all_of_it = all_lanes<Real>(), none = negated(all_of_it);
        Choice<double> choice = no_choice<double>(control);
        if (problem_.coverage > 0) choice.scale = CostScale::logarithmic;  // costs can be negative
        least = without_limit<double>();
        for (int first = 0; first < control.candidate_count; first += lanes<Real>) {
            const int left = control.candidate_count - first, count = left < lanes<Real> ? left : lanes<Real>;
            const Command<Real> command = in_lanes_of(control.candidates + first, count);
            const Vector2<Real> u = rotate(heading, command.move), there = here + u;
            Mask<Real> allowed = all_of_it;
            for (int w = 0; w < problem_.wall_count && any(allowed); ++w)
                allowed = both(allowed, negated(free_share(problem_.walls[w], problem_.radius, here, u) < Real(1)));
            if (!any(allowed)) continue;
            const Rotation<Real> turned = rotation(mean[State::heading] + command.turn);
            const auto sees = [&](int j, const Real& squared) {
                if (!is_present(j, lane)) return none;
                const Mask<Real> seen = both(allowed, in_range(problem_.sensor, squared));
                return any(seen) ? both(seen, in_sight(problem_, there, turned,
                                                       point_at(mean, State::feature(j)) - there, squared))
                                 : seen;
            };
            const Real own = cost_of(command, u, sees);
            Real cost = own;
            if (problem_.coverage > 0)
                each_new_cell(
                    problem_, there, turned,
                    [&](int i) { return lane_bits(work_.viewed[i]) >> lane & 1 ? none : allowed; },
                    [&](int, Mask<Real> fresh) { cost = cost - select(fresh, Real(problem_.coverage), Real(0)); });
            for (int i = 0; i < count; ++i) {
                const bool is_allowed = lane_bits(allowed) >> i & 1;
                choice.offer(command_from<double>(control.candidates[first + i]), lane_of(cost, i), is_allowed);
                if (is_allowed) least = smaller(lane_of(own, i), least);
                costs(first + i, lane_of(cost, i), is_allowed);
            }
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
};

/// Calls price(i, command, allowed, sees, new cells) for every candidate from the mean in `still`, as ExplorePlanner
/// does, but with the trials of the pack in the lanes.
template <class Real, class Work, class Price>
void each_candidate_ahead(const ExploreView& problem, Work& work, const Price& price) {
    const Real* mean = work.planner.still.mean;
    const Rotation<Real> heading = rotation(mean[ExploreLayout::heading]);
    const Vector2<Real> here = point_at(mean, ExploreLayout::position);
    const Mask<Real> none = negated(all_lanes<Real>());
    for (int i = 0; i < problem.control.candidate_count; ++i) {
        const Command<Real> command = command_from<Real>(problem.control.candidates[i]);
        const Vector2<Real> u = rotate(heading, command.move), there = here + u;
        const Rotation<Real> turned = rotation(mean[ExploreLayout::heading] + command.turn);
        Mask<Real> allowed = all_lanes<Real>();
        for (int w = 0; w < problem.wall_count && any(allowed); ++w)
            allowed = both(allowed, negated(free_share(problem.walls[w], problem.radius, here, u) < Real(1)));
        const auto sees = [&](int j, const Real& squared) {
            const Mask<Real> seen = both(work.present(problem, j), in_range(problem.sensor, squared));
            return any(seen) ? both(seen, in_sight(problem, there, turned,
                                                   point_at(mean, ExploreLayout::feature(j)) - there, squared))
                             : none;
        };
        Real cells(0);
        each_new_cell(
            problem, there, turned, [&](int cell) { return negated(work.viewed[cell]); },
            [&](int, Mask<Real> fresh) { cells = cells + select(fresh, Real(1), Real(0)); });
        price(i, command, allowed, sees, cells);
    }
}

/// The cell that a place is in, or the nearest one.
inline int cell_at(const CellGrid& grid, double x, double y) {
    const auto index = [&](double along, int count) {
        const double cells = along / grid.cell;
        return !(cells > 0) ? 0 : cells < count ? static_cast<int>(cells) : count - 1;
    };
    return index(y - grid.corner.y, grid.rows) * grid.columns + index(x - grid.corner.x, grid.columns);
}

/// The first cell on a shortest way through the grid from cell `start` to one that was not in view in that lane; -1 if
/// none is reached. Of equal ways the first one to be found, neighbours taken to the east, north, west and south.
template <class Real>
int towards_unviewed(const CellGrid& grid, int start, int lane, ExploreState<Real>& work) {
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
