#pragma once
// The moments of a pack of trials [columns.hpp, moment_count], whatever the world.

#include <credence/detail/batch.hpp>
#include <credence/columns.hpp>
#include "slam/trial/problem.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// Numbers of a trial's moments beside those of the groups' NEES.
inline int own_moment_count(int n) { return n * (n + 2); }

/// Adds a step. `P(i, j)`, i <= j, covariance [n, n]; `standardised` e_j/sigma_j [n]; `inverse_sigma` 1/sqrt(P_jj) [n];
/// `moments` [own_moment_count].
template <class Real, class Covariance>
[[gnu::noinline]] void add_moments(int n, const Covariance& P, const Real* standardised, const Real* inverse_sigma,
                                   Real* moments) {
    for (int j = 0; j < n; ++j) moments[j] = moments[j] + standardised[j];
    Real *products = moments + n, *correlations = products + n * (n + 1) / 2;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j <= i; ++j, ++products, ++correlations) {
            *products = fma(standardised[i], standardised[j], *products);
            *correlations = fma(P(j, i) * inverse_sigma[i], inverse_sigma[j], *correlations);
        }
}

/// Stores the moments of the trials from `trial` on: NEES and standardised errors as means over the steps.
template <class Real>
void keep_moments(const CommonView& problem, Real* own, const Real* all_series, int trial, const Batch& batch) {
    const int steps = problem.poses - 1, padded = (batch.trials + octet - 1) / octet * octet, n = problem.state_size;
    const Real share = Real(1.0 / steps);
    double* to = batch.moments + trial;
    for (int b = 0; b < problem.group_count; ++b, to += padded) {
        Real sum = Real(0);
        for (int k = 0; k < steps; ++k) sum = sum + all_series[b * steps + k];
        store(sum * share, to);
    }
    for (int i = 0; i < own_moment_count(n); ++i, to += padded) store(i < n ? own[i] * share : own[i], to);
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
