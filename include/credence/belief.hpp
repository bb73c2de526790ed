#pragma once
// Room 6: the belief, and what can be asked of it.

#include <credence/real.hpp>

namespace credence {
inline namespace CREDENCE_UNIT {

/// A symmetric matrix of which only the upper triangle is kept: entry[i][j] with i <= j.
template <class Real, int capacity>
struct Symmetric {
    Real entry[capacity][capacity];

    Real& at(int i, int j) { return i <= j ? entry[i][j] : entry[j][i]; }
    const Real& at(int i, int j) const { return i <= j ? entry[i][j] : entry[j][i]; }
};

/// What the filter holds: mean x [n] and covariance P [n, n], n <= capacity.
template <class Real, int capacity>
struct Belief {
    Real mean[capacity];
    Symmetric<Real, capacity> covariance;
};

template <class Real, int capacity>
void copy(const Symmetric<Real, capacity>& from, int n, Symmetric<Real, capacity>& to) {
    for (int i = 0; i < n; ++i)
        for (int j = i; j < n; ++j) to.entry[i][j] = from.entry[i][j];
}

template <class Real, int capacity>
Real trace(const Symmetric<Real, capacity>& P, int n) {
    Real sum = P.entry[0][0];
    for (int i = 1; i < n; ++i) sum = sum + P.entry[i][i];
    return sum;
}

/// A normalised squared error, and whether its matrix was positive definite: where not, the number means nothing.
template <class Real>
struct SquaredError {
    Real value{};
    Mask<Real> positive_definite{};
};

/// e' P^-1 e over the block [first, first + count) of the state, with that block's P, by Cholesky: P = U'U, U'y = e,
/// y'y [Bar-Shalom 2001, 5.4.2].
template <class Real, int capacity>
SquaredError<Real> normalised_squared_error(const Symmetric<Real, capacity>& P, const Real* error, int first,
                                            int count) {
    Symmetric<Real, capacity> U;
    Real y[capacity];
    SquaredError<Real> result{Real(0), all_lanes<Real>()};
    for (int i = 0; i < count; ++i) {
        Real pivot = P.entry[first + i][first + i];
        Real rest = error[first + i];
        for (int k = 0; k < i; ++k) {
            pivot = fnma(U.entry[k][i], U.entry[k][i], pivot);
            rest = fnma(U.entry[k][i], y[k], rest);
        }
        result.positive_definite = both(result.positive_definite, pivot > Real(0));
        const Real inverse_root = Real(1) / sqrt(pivot);
        y[i] = rest * inverse_root;
        result.value = fma(y[i], y[i], result.value);
        for (int j = i + 1; j < count; ++j) {
            Real entry = P.entry[first + i][first + j];
            for (int k = 0; k < i; ++k) entry = fnma(U.entry[k][i], U.entry[k][j], entry);
            U.entry[i][j] = entry * inverse_root;
        }
    }
    return result;
}

}  // namespace CREDENCE_UNIT
}  // namespace credence
