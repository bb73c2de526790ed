#pragma once
// The planner of the world `explore` [docs/explore.md]. Planning is the deformable world's: a candidate is
// predicted, what it would show is gated at the predicted mean, and its cost is that of the covariance after that; but
// what it would show is what is in sight there, and a wall forbids it. Letters as in measurement_space.hpp.

#include "worlds/explore/costs.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// Where no wall ends the way from `here` by u.
template <class Real>
Mask<Real> is_free(const ExploreView& problem, const Vector2<Real>& here, const Vector2<Real>& u) {
    Mask<Real> free = all_lanes<Real>();
    for (int w = 0; w < problem.wall_count && any(free); ++w)
        free = both(free, negated(free_share(problem.walls[w], problem.radius, here, u) < Real(1)));
    return free;
}

/// Where a landmark at a squared range would be in sight, of those `there` in the state, within range.
template <class Real>
Mask<Real> would_see(const ExploreView& problem, Mask<Real> present, const Vector2<Real>& there,
                     const Rotation<Real>& turned, const Vector2<Real>& landmark, const Real& squared) {
    const Mask<Real> seen = both(present, in_range(problem.sensor, squared));
    return any(seen) ? both(seen, in_sight(problem, there, turned, landmark - there, squared)) : seen;
}

/// What the landmarks that are not in the state add to a cost.
template <class Real>
Real cost_of_absent(const ExploreView& problem, const ExploreLayout& layout, const ExploreState<Real>& work) {
    Real sum(0);
    for (int j = 0; problem.control.criterion == Criterion::log_det && j < layout.features(); ++j)
        sum = sum + select(work.present(problem, j), Real(0), Real(2 * log(absent_variance)));
    return sum;
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

    /// The least cost of a candidate that no wall ends, once one was chosen; infinite where there was none.
    Real least() const { return best_; }

    /// Calls costs(i, cost, allowed) with the candidates' of every trial.
    template <class Costs>
    Command<Real> choose(const Costs& costs) {
        auto& planner = work_.planner;
        const bool traces = is_trace(problem_.control.criterion),
                   fast = traces || problem_.control.criterion == Criterion::log_det;
        Real lost(__builtin_inf());
        if (fast) {
            prepare_still(belief_, problem_.filter, layout_, k_, planner.still);
            look_from_truth();
            enter_measurement_space(planner.still, problem_.filter, layout_, problem_.control.weights, planner.space);
            const Planning<State, Real> given{problem_.control, problem_.filter, problem_.sensor, layout_, planner};
            lost = lost_to_rounding(given, traces ? planner.space.prior.constant : Real(1), 0);
            if (!traces) lost = lost + condition_pose(planner.still.covariance);
        }
        Control controls[lanes<Real>];
        for (int lane = 0; lane < lanes<Real>; ++lane) {
            Choice<double> choice;
            double least = 0;
            if (fast) choice = choose_in_space(lane, costs, least);
            if (!(lane_of(lost, lane) <= most_lost * (traces ? least : 1))) choice = choose_plainly(lane, costs);
            set_lane(best_, lane, choice.best);
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
        const Real of_absent(lane_of(cost_of_absent(problem_, layout_, work_), lane));
        double least = 0;
        return least_cost(
            lane,
            [&](const Command<Real>& command, const Vector2<Real>&, const auto& sees) {
                expect(one, command, problem_.filter, problem_.sensor, layout_, sees, planner.next);
                return cost_of(planner.next.covariance, problem_.control, layout_) - of_absent;
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

    /// The pose given the features that are in the state. Returns the largest share of a variance that this leaves, the
    /// other way round.
    Real condition_pose(const Symmetric<Real, capacity>& P) {
        auto& A = work_.planner.next.covariance;
        auto& given = work_.given;
        const auto n = layout_.size();
        copy(P, n, A);
        ScaledProduct<Real> of_features;
        Real largest(0);
        const auto note = [&](Mask<Real> present, const Real& variance, const Real& pivot) {
            const Real ratio = select(pivot > Real(0), variance / pivot, Real(__builtin_inf()));
            largest = select(both(present, ratio > largest), ratio, largest);
        };
        for (int i = State::pose_size; i < n; ++i) {
            const Mask<Real> present = work_.present(problem_, (i - State::pose_size) / 2);
            if (!any(present)) continue;
            const Real pivot = sweep(A, n, i, present);
            of_features.multiply(pivot);
            note(present, P.entry[i][i], pivot);
        }
        given.of_features = of_features.log();
        for (int i = 0; i < 3; ++i)
            for (int j = i; j < 3; ++j) given.pose.entry[i][j] = A.entry[i][j];
        const Real variance(problem_.filter.variance_heading);
        each_pose_pivot(given, variance, {Real(0), Real(0)}, [&](int i, const Real& pivot) {
            note(all_lanes<Real>(), P.entry[i][i] + (i == 0 ? variance : Real(0)), pivot);
        });
        return largest;
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
        const bool traces = is_trace(problem_.control.criterion);
        if (!traces) take_lane(lane, &work_.given, 1, &work_.given_of_one);
        return least_cost(
            lane,
            [&](const Command<Real>&, const Vector2<Real>& u, const auto& sees) {
                auto& room = work_.planner.elimination;
                return traces ? trace_in_measurement_space(one, u, problem_, layout_, sees, room)
                              : log_det_in_measurement_space(work_.given_of_one, one, u, problem_, layout_, sees, room);
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
        const Mask<Real> none = negated(all_lanes<Real>());
        Choice<double> choice = no_choice<double>(control);
        if (problem_.coverage > 0) choice.scale = CostScale::logarithmic;  // costs can be negative
        least = without_limit<double>();
        for (int first = 0; first < control.candidate_count; first += lanes<Real>) {
            const int left = control.candidate_count - first, count = left < lanes<Real> ? left : lanes<Real>;
            const Command<Real> command = in_lanes_of(control.candidates + first, count);
            const Vector2<Real> u = rotate(heading, command.move), there = here + u;
            const Mask<Real> allowed = is_free(problem_, here, u);
            if (!any(allowed)) continue;
            const Rotation<Real> turned = rotation(mean[State::heading] + command.turn);
            const auto sees = [&](int j, const Real& squared) {
                return is_present(j, lane) ? would_see(problem_, allowed, there, turned,
                                                       point_at(mean, State::feature(j)), squared)
                                           : none;
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
    Real best_{};
};

/// Calls price(i, command, allowed, sees, new cells) for every candidate from a mean, as ExplorePlanner does, but with
/// the trials of the pack in the lanes; before that fresh(cell, where) for each of its new cells.
template <class Real, class Fresh, class Price>
void each_candidate_ahead(const ExploreView& problem, const Real* mean, ExploreState<Real>& work, const Fresh& fresh,
                          const Price& price) {
    const Rotation<Real> heading = rotation(mean[ExploreLayout::heading]);
    const Vector2<Real> here = point_at(mean, ExploreLayout::position);
    for (int i = 0; i < problem.control.candidate_count; ++i) {
        const Command<Real> command = command_from<Real>(problem.control.candidates[i]);
        const Vector2<Real> u = rotate(heading, command.move), there = here + u;
        const Rotation<Real> turned = rotation(mean[ExploreLayout::heading] + command.turn);
        const Mask<Real> allowed = is_free(problem, here, u);
        const auto sees = [&](int j, const Real& squared) {
            return would_see(problem, work.present(problem, j), there, turned,
                             point_at(mean, ExploreLayout::feature(j)), squared);
        };
        Real cells(0);
        each_new_cell(
            problem, there, turned, [&](int cell) { return negated(work.viewed[cell]); },
            [&](int cell, Mask<Real> where) {
                cells = cells + select(where, Real(1), Real(0));
                fresh(cell, where);
            });
        price(i, command, allowed, sees, cells);
    }
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
