#pragma once
// The step evaluation: compares a belief with the truth at every pose [docs/model.md, Reported per trial].
//
//   e  error x^ - x [n], P  covariance [n, n]; NEES e' P^-1 e of the whole state and of each group, with its own P

#include "slam/estimators/invariant_chart.hpp"
#include "slam/trial/problem.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// A trial's status, and the pose where it failed.
template <class Real>
struct Outcome {
    Real status = Real(0), pose = Real(-1);

    void note(Mask<Real> happened, Status what, int k) {
        const Mask<Real> first = both(happened, status == Real(0));
        status = select(first, Real(static_cast<int>(what)), status);
        pose = select(first, Real(k), pose);
    }
    /// After the last step, of so many numbers: steps times components.
    void note_diverged(Real nees_ratio, int numbers) {
        if (numbers < least_diverged_numbers) return;
        const Mask<Real> diverged = both(nees_ratio > Real(diverged_nees_ratio), status == Real(0));
        status = select(diverged, Real(static_cast<int>(Status::diverged)), status);
    }
};

/// Sums over the poses of one trial.
template <class Real>
struct Sums {
    Real unseen = Real(0), pose_error = Real(0), nees = Real(0), nis = Real(0), rows = Real(0), trace = Real(0);
    Real traces = Real(0);  ///< over the steps
    ScaledProduct<Real> determinants;  ///< of P, the product over the steps
    Real path_length = Real(0);
    Vector2<Real> position;  ///< of the true robot at the last pose
};

/// x^ - x, heading wrapped. [n].
template <class Layout, class Real, int state_capacity, int feature_capacity>
void estimation_error(const Belief<Real, state_capacity>& belief, const Truth<Real, feature_capacity>& truth,
                      const Layout& layout, Real* error) {
    if constexpr (Layout::has_heading)
        error[Layout::heading] = wrapped(belief.mean[Layout::heading] - truth.heading);
    error[Layout::position] = belief.mean[Layout::position] - truth.position.x;
    error[Layout::position + 1] = belief.mean[Layout::position + 1] - truth.position.y;
    for (int j = 0; j < layout.features(); ++j) {
        error[Layout::feature(j)] = belief.mean[Layout::feature(j)] - truth.feature[j].x;
        error[Layout::feature(j) + 1] = belief.mean[Layout::feature(j) + 1] - truth.feature[j].y;
    }
}

/// |x^_pose - x_pose|^2, heading included where there is one.
template <class Layout, class Real>
Real squared_pose_error(const Real* error) {
    Real sum = error[0] * error[0];
    for (int i = 1; i < Layout::pose_size; ++i) sum = fma(error[i], error[i], sum);
    return sum;
}

/// Notes the trouble at pose k, if there is any. `squared_errors` is meaningless where a matrix was not positive
/// definite.
template <class Real, int capacity>
void note_trouble(const Belief<Real, capacity>& belief, int n, Real squared_errors, Mask<Real> positive_definite,
                  int k, Outcome<Real>& outcome) {
    Real largest = Real(0), zero_if_finite = select(positive_definite, squared_errors, Real(0)) * Real(0);
    for (int i = 0; i < n; ++i) {
        const Real x = absolute(belief.mean[i]);
        largest = select(x > largest, x, largest);
        zero_if_finite = fma(x, Real(0), zero_if_finite);
        for (int j = i; j < n; ++j) {
            const Real p = absolute(belief.covariance.entry[i][j]);
            largest = select(p > largest, p, largest);
            zero_if_finite = fma(p, Real(0), zero_if_finite);
        }
    }
    outcome.note(negated(both(zero_if_finite == Real(0), largest <= Real(largest_number))), Status::non_finite, k);
    outcome.note(negated(positive_definite), Status::covariance_not_positive_definite, k);
}

/// Whether note_trouble could find anything. For a positive definite P the diagonal suffices: |P_ij| <= max P_ii, and
/// an entry that is not finite makes a pivot NaN or infinite.
template <class Layout, class Real, int capacity>
bool trouble(const Belief<Real, capacity>& belief, const Layout& layout, Real squared_errors,
             Mask<Real> positive_definite) {
    Real total = absolute(squared_errors);  // at least each of its terms, and not finite if one of them is not
    each(zero, layout.size(), [&](auto i) {
        total = total + (absolute(belief.mean[i]) + absolute(belief.covariance.entry[i][i]));
    });
    return any(negated(both(positive_definite, total <= Real(largest_number))));
}

/// Normalised errors of a belief: NEES of every group, in the order of Layout's, with each group's own P;
/// e_i/sqrt(P_ii); det P.
template <class Layout, class Real>
struct StepEvaluation {
    Real nees[Layout::largest_group_count], standardised_error[Layout::capacity];
    ScaledProduct<Real> determinant;
    Mask<Real> positive_definite{};
};

template <class Layout, class Real, int capacity>
CREDENCE_INLINE void evaluate_groups(const Belief<Real, capacity>& belief, const Layout& layout, const Real* error,
                                  Elimination<Real, capacity>& work, StepEvaluation<Layout, Real>& evaluation) {
    const auto n = layout.size();
    const auto& P = belief.covariance;
    Real* nees = evaluation.nees;
    evaluation.positive_definite = all_lanes<Real>();
    const auto evaluate = [&](auto first, auto last, auto&& keep) CREDENCE_INLINE_LAMBDA {
        const auto visit = [&](auto i, const SquaredError<Real>& result) {
            keep(i, result);
            if (i == first)
                evaluation.positive_definite = both(evaluation.positive_definite, result.positive_definite);
        };
        nested_squared_errors<Layout::by_axis>(P, error, first, last, work, visit);
    };
    const auto standardise = [&](auto i) {
        const auto of_axis = i - (Layout::by_axis ? i % 2 : 0);  // one root serves both axes
        evaluation.standardised_error[i] = error[i] / sqrt(P.entry[of_axis][of_axis]);
    };
    evaluate(zero, n, [&](auto i, const SquaredError<Real>& result) {
        if (i == 0) {
            nees[Layout::group_all] = result.value;
            evaluation.determinant = result.determinant;
        }
        if (i == Layout::pose_size) nees[Layout::group_features] = result.value;
        if (i == n - two) nees[Layout::group_feature(layout.features() - one)] = result.value;
        // Computed here, the roots overlap with the elimination, which waits for its pivots.
        standardise(i);
        if (i + 1 < n && (n - i) % 2 == 0) standardise(i + one);
    });
    evaluate(zero, Layout::pose_size, [&](auto i, const SquaredError<Real>& result) {
        if (i == 0) nees[Layout::group_pose] = result.value;
        if constexpr (Layout::has_heading)
            if (i == Layout::position) nees[Layout::group_position] = result.value;
    });
    if constexpr (Layout::has_heading)
        nees[Layout::group_heading] = evaluation.standardised_error[0] * evaluation.standardised_error[0];
    each(zero, layout.features() - one, [&](auto j) {
        const auto f = Layout::feature(j);
        evaluate(f, f + two, [&](auto i, const SquaredError<Real>& result) {
            if (i == f) nees[Layout::group_feature(j)] = result.value;
        });
    });
}

/// Sums square(i) of the state's components by group and calls reported(sum) in the order of Layout's groups.
template <class Real, class Layout, class Square, class Reported>
CREDENCE_INLINE void add_by_group(const Layout& layout, const Square& square, Reported&& reported) {
    constexpr auto r = Layout::position;
    const auto of_feature = [&](auto j) {
        const auto f = Layout::feature(j);
        return square(f) + square(f + one);
    };
    const Real position = square(r) + square(r + one);
    Real pose = position;
    if constexpr (Layout::has_heading) pose = square(Layout::heading) + position;
    Real features = Real(0);
    each(zero, layout.features(), [&](auto j) { features = features + of_feature(j); });
    reported(pose + features);
    reported(pose);
    if constexpr (Layout::has_heading) {
        reported(square(Layout::heading));
        reported(position);
    }
    reported(features);
    each(zero, layout.group_count() - Layout::group_features - one, [&](auto j) { reported(of_feature(j)); });
}

/// Evaluates the belief at pose k: writes the step's series (in the order of step_series) and adds to the sums.
template <class Layout, class Real, int state_capacity, int feature_capacity>
CREDENCE_FLAT void evaluate_step(const CommonView& problem, const Layout& layout,
                              const Belief<Real, state_capacity>& belief, const Truth<Real, feature_capacity>& truth,
                              const Update<Real, state_capacity>& update, int k,
                              Elimination<Real, state_capacity>& work, Sums<Real>& sums, Outcome<Real>& outcome,
                              Real* all_series) {
    const int steps = problem.poses - 1;
    const auto n = layout.size();
    Real* next = all_series + (k - 1);
    const auto write = [&](Real value) { *next = value, next += steps; };

    Real error[state_capacity];
    StepEvaluation<Layout, Real> evaluation;
    estimation_error(belief, truth, layout, error);
    near_at_hand(layout, work, [&](auto& left) CREDENCE_INLINE_LAMBDA {
        evaluate_groups(belief, layout, error, left, evaluation);
    });
    // The reported covariance is P times a factor, which is 1 except in tests of the verdict.
    const double reported = problem.filter.covariance_factor;
    const Mask<Real> positive_definite = both(update.positive_definite, evaluation.positive_definite);
    const Real whole = evaluation.nees[Layout::group_all] * Real(1 / reported);
    const Real trace_P = Real(reported) * trace(belief.covariance, n);
    const Real squared_error = squared_pose_error<Layout>(error);
    each(zero, layout.group_count(), [&](auto b) { write(evaluation.nees[b] * Real(1 / reported)); });
    write(update.nis);
    write(update.rows);
    write(update.nis_features);
    write(update.nis_edges);
    write(update.unseen);
    add_by_group<Real>(layout, [&](auto i) { return error[i] * error[i]; }, write);
    add_by_group<Real>(layout, [&](auto i) { return Real(reported) * belief.covariance.entry[i][i]; }, write);
    const Real inverse_root = Real(1 / __builtin_sqrt(reported));
    each(zero, n, [&](auto i) { write(evaluation.standardised_error[i] * inverse_root); });
    if constexpr (Layout::has_heading)
        if (problem.charts == Charts::euclidean_and_invariant) {
            const InvariantNees<Real> nees = nees_in_invariant_chart(belief, layout, error, work);
            write(nees.all * Real(1 / reported));
            write(nees.pose * Real(1 / reported));
        }

    sums.nees = sums.nees + whole;
    sums.nis = sums.nis + update.nis;
    sums.rows = sums.rows + update.rows;
    sums.unseen = sums.unseen + update.unseen;
    sums.pose_error = sums.pose_error + squared_error;
    sums.trace = trace_P;
    sums.traces = sums.traces + trace_P;
    sums.determinants.multiply(evaluation.determinant);
    sums.path_length = sums.path_length + sqrt(squared_norm(truth.position - sums.position));
    sums.position = truth.position;
    if (trouble(belief, layout, whole + update.nis, positive_definite))
        note_trouble(belief, n, whole + update.nis, positive_definite, k, outcome);
}

/// The trial's columns in the order of ColumnIndex; those of a failed trial are filled by the engine.
template <class Real>
void write_columns(const CommonView& problem, const Sums<Real>& sums, Outcome<Real>& outcome, Real* columns) {
    const int n = problem.state_size, steps = problem.poses - 1;
    const double log_scale = n * (log_two_pi + problem.filter.log_covariance_factor);
    columns[column_trace_P] = sums.trace;
    columns[column_unseen] = sums.unseen;
    columns[column_pose_error] = sums.pose_error;
    columns[column_nees_ratio] = sums.nees / Real(steps * n);
    outcome.note_diverged(columns[column_nees_ratio], steps * n);
    columns[column_nis_ratio] = sums.nis / sums.rows;
    columns[column_mean_trace_P] = sums.traces / Real(steps);
    columns[column_log_score] =
        Real(0.5) * (Real(log_scale) + (sums.determinants.log() + sums.nees) / Real(steps));
    columns[column_path_length] = sums.path_length;
    columns[column_status] = outcome.status;
    columns[column_status_pose] = outcome.pose;
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
