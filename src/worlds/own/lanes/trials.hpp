#pragma once
// A pack of trials of a user's own world: its draws and the evaluation of its steps [docs/statistics.md], with a status
// in each lane. Groups are any, so each has a factor of its own, where built-in worlds eliminate from the last feature
// on once for many groups: the same numbers, not the same bits.
//
//   e  error [n], P  covariance [n, n]; nu  innovation [m], S  its covariance [m, m]

#include <credence/detail/draws.hpp>
#include "engine/simulate_batch.hpp"
#include "slam/trial/step_evaluation.hpp"
#include "worlds/own/lanes/factor.hpp"
#include "worlds/own/lanes/view.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// An innovation of which the rows that a lane did not observe are left out there: S has 1 on their diagonal and 0
/// beside it, nu has 0, which leaves factor and norm of the others as they are.
template <class Real>
struct ObservedRows {
    StoredMatrix<Real> S;
    const Real* observed;  ///< [m] 1 or 0

    Real at(int i, int j) const {
        if (i == j) return select(observed[i] == Real(1), S.at(i, i), Real(1));
        return select(both(observed[i] == Real(1), observed[j] == Real(1)), S.at(i, j), Real(0));
    }
    /// Whether a lane has row i.
    bool has(int i, int lane) const { return lane_of(observed[i], lane) == 1; }
};

template <class Real>
class PackOfTrials : public LanePack {
public:
    /// Reals that a pack needs beside itself, for a state of n and innovations of m rows.
    static std::size_t room(const OwnView& view) {
        const auto n = static_cast<std::size_t>(view.state_size), m = static_cast<std::size_t>(view.largest_innovation);
        const std::size_t most = n > m ? n : m;
        return (most + 2) * most + static_cast<std::size_t>(view.own_column_count);
    }

    /// `all_series` [series_count, K - 1] and `details` are filled.
    PackOfTrials(const OwnView& view, const KeyedDraws<Real>& draws, const PackPlace<Real>& place, Real* room,
                 PackDetails<Real>& details, Real* all_series)
        : view_(view), draws_(draws), there_(place.there), all_series_(all_series), details_(details) {
        first_trial = place.first;
        world = view.world;
        arm_name = view.arm_name;
        arm = view.arm;
        trials = lane_count(there_);
        poses = view.poses;
        state_size = view.state_size;
        largest_innovation = view.largest_innovation;
        own_column_count = static_cast<std::size_t>(view.own_column_count);
        const int most = state_size > largest_innovation ? state_size : largest_innovation;
        L_ = room;
        e_ = L_ + most * most;
        observed_ = e_ + most;
        Real* own = observed_ + most;
        for (int c = 0; c < view.own_column_count; ++c) own[c] = Real(0);
        own_columns = reinterpret_cast<double*>(own);
        LanePack::all_series = reinterpret_cast<const double*>(all_series_);
        normal = draw_normal;
        uniform = draw_uniform;
        step = take_step;
        counted = view.counted;
        count = view.count;
    }

    PackOfTrials(const PackOfTrials&) = delete;
    PackOfTrials& operator=(const PackOfTrials&) = delete;

    /// After the last step: writes the columns [column_count], in the order of own_columns().
    void write_columns(Real* to) {
        note_columns();
        outcome_.note_diverged(nees_ratio(), (poses - 1) * state_size);
        const int steps_of_trial = poses - 1;
        const auto write = [&](Real value) { *to++ = value; };
        write(all_series_[(view_.variance + 1) * steps_of_trial - 1]);
        for (int c = 0; c < view_.own_column_count; ++c) write(load<Real>(own_columns + c * lanes<Real>));
        write(total(view_.squared_error));
        write(nees_ratio());
        write(largest_innovation > 0 ? total(view_.nis) / total(view_.nis + 1) : Real(__builtin_nan("")));
        write(total(view_.variance) / Real(steps_of_trial));
        write(Real(0.5) * (Real(state_size * log_two_pi) + (determinants_.log() + total(0)) / Real(steps_of_trial)));
        write(outcome_.status);
        write(outcome_.pose);
    }

private:
    /// The trials of the pack that have not failed.
    Mask<Real> going_on() const { return both(there_, outcome_.status == Real(0)); }

    /// Notes the trials of which a column of whole numbers is none of 32 bits.
    void note_columns() {
        constexpr double largest = 2147483647,
                         rounding = 6755399441055744;  // 1.5 * 2^52 leaves no place for a fraction
        for (int c = 0; c < view_.own_column_count; ++c) {
            if (!view_.whole[c]) continue;
            const Real value = load<Real>(own_columns + c * lanes<Real>);
            const Mask<Real> is_whole = value + Real(rounding) - Real(rounding) == value;
            outcome_.note(negated(both(is_whole, absolute(value) <= Real(largest))), Status::non_finite, steps);
        }
    }

    CREDENCE_FLAT static void draw_normal(const LanePack& pack, int source, int pose, int index, double* draw) {
        const Vector2<Real> pair =
            static_cast<const PackOfTrials&>(pack).draws_.normal(static_cast<Source>(source), pose, index);
        store(pair.x, draw);
        store(pair.y, draw + lanes<Real>);
    }
    CREDENCE_FLAT static void draw_uniform(const LanePack& pack, int source, int pose, int index, double* draw) {
        store(static_cast<const PackOfTrials&>(pack).draws_.uniform(static_cast<Source>(source), pose, index), draw);
    }
    static bool take_step(LanePack& pack, const LaneStep& step) { return static_cast<PackOfTrials&>(pack).take(step); }

    bool take(const LaneStep& step) {
        const StoredMatrix<Real> P{step.P, state_size};
        note_what_is_not_finite(step, P);
        evaluate_groups(step, P);
        if (view_.largest_innovation > 0) evaluate_innovation(step);
        note_figures();
        ++steps;
        const bool goes_on = any(going_on());
        if (view_.record != nullptr) view_.record(*view_.recorder, *this, step, goes_on);
        if (counted != nullptr) count(*this, whole_of_P, step.P, lanes<Real> * (state_size + 1));
        return goes_on;
    }

    /// The sum of a series over the steps.
    Real total(int f) const {
        const int steps_of_trial = poses - 1;
        Real sum = Real(0);
        for (int k = 0; k < steps_of_trial; ++k) sum = sum + all_series_[f * steps_of_trial + k];
        return sum;
    }
    Real nees_ratio() const { return total(0) / Real(poses - 1) / Real(state_size); }

    Real* series(int f) { return all_series_ + f * (poses - 1) + steps; }
    void note(Mask<Real> happened, Status what) { outcome_.note(happened, what, steps + 1); }

    static Real observed(Real nu) { return select(nu == nu, Real(1), Real(0)); }

    void note_what_is_not_finite(const LaneStep& step, const StoredMatrix<Real>& P) {
        Real zero_if_finite = Real(0);
        for (int j = 0; j < state_size; ++j) {
            zero_if_finite = fma(load<Real>(step.error + j * lanes<Real>), Real(0), zero_if_finite);
            for (int i = j; i < state_size; ++i) zero_if_finite = fma(P.at(i, j), Real(0), zero_if_finite);
        }
        note_observed(step);
        const ObservedRows<Real> S{{step.S, step.rows}, observed_};
        for (int j = 0; j < step.rows; ++j) {
            const Real nu = load<Real>(step.innovation + j * lanes<Real>);
            zero_if_finite = fma(select(nu == nu, nu, Real(0)), Real(0), zero_if_finite);
            for (int i = j; i < step.rows; ++i) zero_if_finite = fma(S.at(i, j), Real(0), zero_if_finite);
        }
        note(negated(zero_if_finite == Real(0)), Status::non_finite);
    }

    void note_observed(const LaneStep& step) {
        for (int i = 0; i < step.rows; ++i) observed_[i] = observed(load<Real>(step.innovation + i * lanes<Real>));
    }

    void evaluate_groups(const LaneStep& step, const StoredMatrix<Real>& P) {
        for (int b = 0; b < view_.group_count; ++b) {
            const GroupPlace group = view_.groups[b];
            if (group.components == nullptr)
                evaluate_group(step, P, b, StoredMatrix<Real>{step.P, state_size, group.first}, group.count,
                               [&](int i) { return group.first + i; });
            else
                evaluate_group(step, P, b, ChosenRows<Real>{P, group.components}, group.count,
                               [&](int i) { return group.components[i]; });
        }
        for (int j = 0; j < state_size; ++j) {
            const Real e = load<Real>(step.error + j * lanes<Real>);
            *series(view_.standardised_error + j) = e / sqrt(P.at(j, j));
            if (details_.keeps_errors) details_.errors[j * (poses - 1) + steps] = e;
            if (details_.variances != nullptr) details_.variances[j * (poses - 1) + steps] = P.at(j, j);
        }
        if (details_.moments != nullptr) add_step_moments(P);
    }

    /// `component(i)` is the i-th component of the group, and `of_group` its part of P.
    template <class Matrix, class Component>
    void evaluate_group(const LaneStep& step, const StoredMatrix<Real>& P, int b, const Matrix& of_group, int count,
                        const Component& component) {
        Real squared_error = Real(0), variance = Real(0);
        for (int i = 0; i < count; ++i) {
            const int j = component(i);
            const Real e = load<Real>(step.error + j * lanes<Real>);
            e_[i] = e;
            squared_error = fma(e, e, squared_error);
            variance = variance + P.at(j, j);
        }
        const Whitened<Real> whitened = whiten_checked(of_group, count);
        *series(b) = whitened.squared_norm;
        if (b == 0) determinants_.multiply(whitened.determinant);
        *series(view_.squared_error + b) = squared_error;
        *series(view_.variance + b) = variance;
    }

    void add_step_moments(const StoredMatrix<Real>& P) {
        Real *standardised = L_, *inverse_sigma = e_;  // not in use at this time
        for (int j = 0; j < state_size; ++j) {
            standardised[j] = *series(view_.standardised_error + j);
            inverse_sigma[j] = Real(1) / sqrt(P.at(j, j));
        }
        add_moments(state_size, [&](int i, int j) { return P.at(j, i); }, standardised, inverse_sigma,
                    details_.moments);
    }

    void evaluate_innovation(const LaneStep& step) {
        Real rows = Real(0);
        for (int i = 0; i < step.rows; ++i) {
            const Real nu = load<Real>(step.innovation + i * lanes<Real>);
            e_[i] = select(nu == nu, nu, Real(0));
            rows = rows + observed_[i];
        }
        *series(view_.nis + 1) = rows;
        *series(view_.nis) =
            step.rows > 0 ? whiten_checked(ObservedRows<Real>{{step.S, step.rows}, observed_}, step.rows).squared_norm
                          : Real(0);
        if (!details_.on) return;
        for (int i = 0; i < largest_innovation; ++i) {
            const bool is_row = i < step.rows;
            details_.products.keep(steps, i, is_row ? e_[i] : Real(0), is_row ? observed_[i] : Real(0));
        }
        details_.products.correlate(steps);
    }

    /// e' M^-1 e of e_ [n], which becomes L^-1 e; notes where M is not positive definite.
    template <class Matrix>
    Whitened<Real> whiten_checked(const Matrix& M, int n) {
        const Whitened<Real> whitened = whiten_any<Real>(M, n, L_, e_);
        const Mask<Real> open = both(going_on(), negated(whitened.sound));
        if (any(open)) note(look_closer(M, n, open), Status::covariance_not_positive_definite);
        return whitened;
    }

    /// The lanes of `open` in which M is not positive definite.
    template <class Matrix>
    [[gnu::cold, gnu::noinline]] Mask<Real> look_closer(const Matrix& M, int n, Mask<Real> open) {
        unsigned indefinite = 0;
        double* entries = reinterpret_cast<double*>(L_);
        for (int lane = 0; lane < lanes<Real>; ++lane) {
            if (!(lane_bits(open) >> lane & 1)) continue;
            int size = 0;
            for (int j = 0; j < n; ++j) {
                if (!M.has(j, lane)) continue;
                for (int i = 0; i < n; ++i)
                    if (M.has(i, lane)) *entries++ = lane_of(M.at(i > j ? i : j, i > j ? j : i), lane);
                ++size;
            }
            entries -= size * size;
            if (!view_.positive_definite(entries, size)) indefinite |= 1u << lane;
        }
        return mask_of_bits<Real>(indefinite);
    }

    /// Whether every series is a number whose square, over all steps, still adds up, as figures_add_up says.
    void note_figures() {
        constexpr double largest_figure = 1e140;
        Mask<Real> good = all_lanes<Real>();
        for (int f = 0; f < view_.series_count; ++f) good = both(good, absolute(*series(f)) <= Real(largest_figure));
        note(negated(good), Status::non_finite);
    }

    const OwnView& view_;
    const KeyedDraws<Real>& draws_;
    Mask<Real> there_;  ///< lanes that have a trial
    Outcome<Real> outcome_;
    Real* all_series_;
    PackDetails<Real>& details_;
    Real *L_, *e_, *observed_;
    ScaledProduct<Real> determinants_;  ///< of P, the product over the steps
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
