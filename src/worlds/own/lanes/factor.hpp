#pragma once
// Cholesky factors of the matrices that a user's own world reports, one in each lane, and the squared norms that they
// whiten. Sizes up to 4 are written out.

#include <credence/detail/each.hpp>
#include <credence/detail/elementary.hpp>
#include <credence/detail/lane.hpp>

namespace credence {
inline namespace CREDENCE_TARGET {

/// A symmetric matrix by columns in memory, of which the lower triangle from `first` on is read.
template <class Real>
struct StoredMatrix {
    const double* entries;
    int rows, first = 0;

    Real at(int i, int j) const { return load<Real>(entries + ((j + first) * rows + i + first) * lanes<Real>); }
    bool has(int, int) const { return true; }
};

/// Some of its rows and columns, in any order.
template <class Real>
struct ChosenRows {
    StoredMatrix<Real> all;
    const int* chosen;

    Real at(int i, int j) const {
        const int a = chosen[i], b = chosen[j];
        return all.at(a > b ? a : b, a > b ? b : a);
    }
    bool has(int, int) const { return true; }
};

/// What becomes of a right-hand side e under the factor of S = L L'.
template <class Real>
struct Whitened {
    Real squared_norm = Real(0);    ///< e' S^-1 e
    ScaledProduct<Real> determinant{};
    Mask<Real> sound{};             ///< no pivot is so small that rounding could have made it
};

/// Pivots above this share of their diagonal entry need no further look: 10 sqrt(epsilon), as for one trial.
inline constexpr double sound_pivot = 10 * 1.4901161193847656e-08;

/// Solves L y = e, S = L L' [n, n]. `L` [n, n] is room for the factor; `e` [n] becomes y.
template <class Real, class Matrix, class Count>
CREDENCE_INLINE Whitened<Real> whiten(const Matrix& S, Count n, Real* L, Real* e) {
    Whitened<Real> result;
    result.sound = all_lanes<Real>();
    each(zero, n, [&](auto j) CREDENCE_INLINE_LAMBDA {
        Real pivot = S.at(j, j);
        const Real size = pivot;
        each(zero, j, [&](auto k) CREDENCE_INLINE_LAMBDA { pivot = fnma(L[j * n + k], L[j * n + k], pivot); });
        result.sound = both(result.sound, pivot > Real(sound_pivot) * size);
        result.determinant.multiply(pivot);
        const Real reciprocal = Real(1) / sqrt(pivot);
        Real y = e[j];
        each(zero, j, [&](auto k) CREDENCE_INLINE_LAMBDA { y = fnma(L[j * n + k], e[k], y); });
        e[j] = y * reciprocal;
        result.squared_norm = fma(e[j], e[j], result.squared_norm);
        each(j + one, n, [&](auto i) CREDENCE_INLINE_LAMBDA {
            Real entry = S.at(i, j);
            each(zero, j, [&](auto k) CREDENCE_INLINE_LAMBDA { entry = fnma(L[i * n + k], L[j * n + k], entry); });
            L[i * n + j] = entry * reciprocal;
        });
    });
    return result;
}

/// The same for a size that is not known to the compiler, but mostly small.
template <class Real, class Matrix>
Whitened<Real> whiten_any(const Matrix& S, int n, Real* L, Real* e) {
    const auto written_out = [&](auto count) CREDENCE_INLINE_LAMBDA {
        Real near_L[count * count], near_e[count];  // in registers, as far as they fit
        each(zero, count, [&](auto i) CREDENCE_INLINE_LAMBDA { near_e[i] = e[i]; });
        const Whitened<Real> result = whiten<Real>(S, count, near_L, near_e);
        each(zero, count, [&](auto i) CREDENCE_INLINE_LAMBDA { e[i] = near_e[i]; });
        return result;
    };
    switch (n) {
        case 1: return written_out(Known<1>{});
        case 2: return written_out(Known<2>{});
        case 3: return written_out(Known<3>{});
        case 4: return written_out(Known<4>{});
        default: return whiten<Real>(S, n, L, e);
    }
}

/// Such matrices are too rare to be written out.
template <class Real>
Whitened<Real> whiten_any(const ChosenRows<Real>& S, int n, Real* L, Real* e) {
    return whiten<Real>(S, n, L, e);
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
