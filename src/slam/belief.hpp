#pragma once
// The filter's belief: mean and covariance, and the quadratic forms e' P^-1 e that are computed from it.

#include <credence/detail/each.hpp>
#include <credence/detail/elementary.hpp>

namespace credence {
inline namespace CREDENCE_TARGET {

/// A symmetric matrix of which only the upper triangle is kept: entry[i][j] with i <= j.
template <class Real, int capacity>
struct Symmetric {
    Real entry[capacity][capacity];

    Real& at(int i, int j) { return i <= j ? entry[i][j] : entry[j][i]; }
    const Real& at(int i, int j) const { return i <= j ? entry[i][j] : entry[j][i]; }
};

/// The filter's mean x [n] and covariance P [n, n], n <= capacity.
template <class Real, int capacity>
struct Belief {
    Real mean[capacity];
    Symmetric<Real, capacity> covariance;
};

template <class Real, int capacity, class Size>
void copy(const Symmetric<Real, capacity>& from, Size n, Symmetric<Real, capacity>& to) {
    each(zero, n, [&](auto i) { each(i, n, [&](auto j) { to.entry[i][j] = from.entry[i][j]; }); });
}

template <class Real, int capacity, class Size>
Real trace(const Symmetric<Real, capacity>& P, Size n) {
    Real sum = P.entry[0][0];
    each(one, n, [&](auto i) { sum = sum + P.entry[i][i]; });
    return sum;
}

/// A normalised squared error, and whether its matrix was positive definite: where not, the numbers mean nothing.
template <class Real>
struct SquaredError {
    Real value{};
    Mask<Real> positive_definite{};
    ScaledProduct<Real> determinant{};  ///< of the matrix
};

/// S = L D L' of two rows, L = [1 0; slope 1]: the second row less `slope` times the first is not correlated with the
/// first, so that the two can be taken one after the other. Rounding then costs what the condition of S takes;
/// multiplying by S^-1, whose entries nearly cancel, would cost its square [Higham 2002, 10.1 and 14.1].
template <class Real>
struct Decorrelation {
    Real slope{};
    Vector2<Real> precision{};  ///< D^-1, zero where masked
    Mask<Real> positive_definite{};
    Real determinant{};         ///< of S

    /// L^-1 pair
    Vector2<Real> operator()(const Vector2<Real>& pair) const { return {pair.x, fnma(slope, pair.x, pair.y)}; }

    /// D^-1 L^-1 pair, of L^-1 pair
    Vector2<Real> weighted(const Vector2<Real>& pair) const { return {precision.x * pair.x, precision.y * pair.y}; }

    /// nu' S^-1 nu, of L^-1 nu
    Real squared(const Vector2<Real>& nu) const { return fma(precision.y * nu.y, nu.y, precision.x * nu.x * nu.x); }
};

template <class Real>
Decorrelation<Real> decorrelation(Real xx, Real xy, Real yy, Mask<Real> used) {
    const Real x = select(used, Real(1) / xx, Real(0)), slope = x * xy, rest = fnma(slope, xy, yy);
    return {slope, {x, select(used, Real(1) / rest, Real(0))},
            either(both(xx > Real(0), rest > Real(0)), negated(used)), xx * rest};
}

/// The same where S = xx I: the bits of decorrelation(xx, 0, xx, used).
template <class Real>
Decorrelation<Real> decorrelation_by_axis(Real xx, Mask<Real> used) {
    const Real x = select(used, Real(1) / xx, Real(0));
    return {Real(0), {x, x}, either(xx > Real(0), negated(used)), xx * xx};
}

/// A matrix and a vector that are being eliminated, from the last row up.
template <class Real, int capacity>
struct Elimination {
    Symmetric<Real, capacity> A;
    Real e[capacity];
};

/// Calls use(room). Where the loops are written out, it passes a local variable instead of `room`, so that the compiler
/// can keep it in registers.
template <class Layout, class Room, class Use>
CREDENCE_INLINE auto near_at_hand(const Layout&, Room& room, Use&& use) {
    if constexpr (Layout::written_out) {
        Room own;
        return use(own);
    } else {
        return use(room);
    }
}

/// Returns e' A^-1 e over the rows [i, i + 2) and eliminates these from the rows [first, i). The remaining A and e are
/// written to `left`, which may be the same object as the input. `by_axis`: A = A_1 (x) I_2, of which the entries of
/// the x axis are read and written.
template <bool by_axis, class Real, int capacity, class First, class Index>
CREDENCE_INLINE SquaredError<Real> eliminate_pair(const Symmetric<Real, capacity>& matrix, const Real* vector,
                                                  First first, Index i, Elimination<Real, capacity>& left) {
    const auto& A = matrix.entry;
    if constexpr (by_axis) {
        const Decorrelation<Real> pivot = decorrelation_by_axis(A[i][i], all_lanes<Real>());
        const Vector2<Real> e{vector[i], vector[i + one]};
        each(zero, half(i - first), [&](auto point) {
            const auto k = first + two * point;
            const Real scaled = pivot.precision.x * A[k][i];
            left.e[k] = fnma(scaled, e.x, vector[k]);
            left.e[k + one] = fnma(scaled, e.y, vector[k + one]);
            each(zero, point + one, [&](auto other) {
                const auto m = first + two * other;
                left.A.entry[m][k] = fnma(scaled, A[m][i], A[m][k]);
            });
        });
        return {pivot.squared(e), pivot.positive_definite, ScaledProduct<Real>(pivot.determinant)};
    } else {
        const Decorrelation<Real> pivot = decorrelation(A[i][i], A[i][i + one], A[i + one][i + one], all_lanes<Real>());
        const Vector2<Real> e = pivot({vector[i], vector[i + one]});
        Vector2<Real> W[capacity];
        each(first, i, [&](auto k) {
            W[k] = pivot({A[k][i], A[k][i + one]});
            const Vector2<Real> scaled = pivot.weighted(W[k]);
            left.e[k] = fnma(scaled.y, e.y, fnma(scaled.x, e.x, vector[k]));
            each(first, k + one,
                 [&](auto m) { left.A.entry[m][k] = fnma(scaled.y, W[m].y, fnma(scaled.x, W[m].x, A[m][k])); });
        });
        return {pivot.squared(e), pivot.positive_definite, ScaledProduct<Real>(pivot.determinant)};
    }
}

template <bool by_axis, class Real, int capacity, class First, class Index>
CREDENCE_INLINE SquaredError<Real> eliminate_pair(Elimination<Real, capacity>& left, First first, Index i) {
    return eliminate_pair<by_axis>(left.A, left.e, first, i, left);
}

/// Computes e' P^-1 e over the component ranges [i, last) of the state, for i = last - 2, last - 4 ... down to first,
/// each with its own part of P [Bar-Shalom 2001, 5.4.2]. Calls visit(i, error) with the squared error of the range [i,
/// last) and whether its P is positive definite. P is eliminated two rows at a time from its end, so that one
/// elimination serves every range that ends at `last`. Of an odd number of rows, the first is eliminated by itself.
template <bool by_axis, class Real, int capacity, class First, class Last, class Visit>
CREDENCE_INLINE void nested_squared_errors(const Symmetric<Real, capacity>& P, const Real* error, First first,
                                           Last last, Elimination<Real, capacity>& left, Visit&& visit) {
    SquaredError<Real> sum{Real(0), all_lanes<Real>()};
    const auto add = [&](auto i, const SquaredError<Real>& part) {
        sum.value = sum.value + part.value;
        sum.positive_definite = both(sum.positive_definite, part.positive_definite);
        sum.determinant.multiply(part.determinant);
        visit(i, sum);
    };
    each(zero, half(last - first), [&](auto pair) {
        const auto i = last - two * (pair + one);
        add(i, pair == 0 ? eliminate_pair<by_axis>(P, error, first, i, left) : eliminate_pair<by_axis>(left, first, i));
    });
    if ((last - first) % 2 != 0) {
        const bool alone = last - first == 1;
        const Real pivot = alone ? P.entry[first][first] : left.A.entry[first][first];
        const Real e = alone ? error[first] : left.e[first];
        add(first, {e * e / pivot, pivot > Real(0), ScaledProduct<Real>(pivot)});
    }
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
