#pragma once
// What the planners minimise, as a number of a covariance [docs/model.md, Criteria]. W is the diagonal matrix of the
// components' weights.

#include <credence/detail/functions.hpp>
#include "slam/belief.hpp"
#include "slam/layout.hpp"

#include <limits>

namespace credence {

/// The weights of the state's components.
struct Weights {
    double heading = 1, position = 1, features = 1;
};

/// A robot that is steered to a place stays where it is if the way there is at most this share of its longest move: its
/// direction would be one of rounding.
inline constexpr double least_move = 1e-9;

struct ControlParameters {
    const Control* fixed = nullptr;       ///< [K - 1] control from pose k to k + 1
    const Control* waypoints = nullptr;   ///< [K - 1] the same along control.waypoints
    const Control* candidates = nullptr;  ///< in the order that decides ties
    const bool* repeated = nullptr;       ///< whether a later candidate has the same move
    int candidate_count = 0;
    double squared_reach = 0;             ///< of the candidate with the largest displacement
    int horizon = 1;                      ///< steps that the controller `horizon` plans ahead
    Criterion criterion = Criterion::trace;
    Weights weights;                      ///< of the traces, and of the largest eigenvalue
};

/// How costs compare: a logarithm may be negative, and has no relative tolerance.
enum class CostScale { linear, logarithmic };

inline namespace CREDENCE_TARGET {

constexpr CostScale scale_of(Criterion criterion) {
    const bool logarithm = criterion == Criterion::log_det || criterion == Criterion::pose_log_det;
    return logarithm ? CostScale::logarithmic : CostScale::linear;
}

/// Whether the cost is trace(W P): linear in P, so that planner.hpp has fast forms of it.
constexpr bool is_trace(Criterion criterion) {
    return scale_of(criterion) == CostScale::linear && criterion != Criterion::max_eigenvalue;
}

/// The components that a criterion weighs; the heading's unit differs from that of the others.
constexpr Weights weights_of(Criterion criterion, double heading_weight) {
    switch (criterion) {
        case Criterion::pose_trace: return {heading_weight, 1, 0};
        case Criterion::features_trace: return {0, 0, 1};
        default: return {heading_weight, 1, 1};
    }
}

/// The weight of component i.
template <class Layout>
constexpr double weight_at(const Weights& weights, int i) {
    return i < Layout::position ? weights.heading : i < Layout::pose_size ? weights.position : weights.features;
}

/// trace(W P)
template <class Layout, class Real, int capacity>
Real weighted_trace(const Symmetric<Real, capacity>& P, const Layout& layout, const Weights& weights) {
    Real sum = Real(weight_at<Layout>(weights, 0)) * P.entry[0][0];
    each(one, layout.size(), [&](auto i) { sum = sum + Real(weight_at<Layout>(weights, i)) * P.entry[i][i]; });
    return sum;
}

/// Calls visit(d_j) with the pivots of A = L D L', L unit lower triangular, for j = 0 ... n - 1. entry(i, j) gives A
/// for i >= j. L D is written to the part of `room` below the diagonal, which is not part of a symmetric matrix.
template <class Real, int capacity, class Size, class Entry, class Visit>
CREDENCE_INLINE void each_pivot(Size n, const Entry& entry, Symmetric<Real, capacity>& room, const Visit& visit) {
    auto& LD = room.entry;
    Real inverse[capacity], row[capacity];
    each(zero, n, [&](auto j) CREDENCE_INLINE_LAMBDA {
        Real pivot = entry(j, j);
        each(zero, j, [&](auto k) CREDENCE_INLINE_LAMBDA {
            row[k] = LD[j][k] * inverse[k];
            pivot = fnma(LD[j][k], row[k], pivot);
        });
        visit(pivot);
        inverse[j] = Real(1) / pivot;
        each(j + one, n, [&](auto i) CREDENCE_INLINE_LAMBDA {
            Real sum = entry(i, j);
            each(zero, j, [&](auto k) CREDENCE_INLINE_LAMBDA { sum = fnma(LD[i][k], row[k], sum); });
            LD[i][j] = sum;
        });
    });
}

/// Sweeps row i of a symmetric matrix [Goodnight 1979: A tutorial on the SWEEP operator] in the lanes `used`: once rows
/// s are swept, A_ss is -A_ss^-1, A_sr is A_ss^-1 A_sr and A_rr is A_rr - A_rs A_ss^-1 A_sr. Returns the pivot, or 1. A
/// pivot of 0 is that of a row of zeros.
template <class Real, int capacity, class Size, class Index>
CREDENCE_INLINE Real sweep(Symmetric<Real, capacity>& A, Size n, Index i, Mask<Real> used) {
    const Real pivot = A.entry[i][i];
    const Real inverse = select(both(used, pivot > Real(0)), Real(1) / pivot, Real(0));
    Real row[capacity];
    each(zero, n, [&](auto k) CREDENCE_INLINE_LAMBDA { row[k] = A.at(k, i); });
    each(zero, n, [&](auto k) CREDENCE_INLINE_LAMBDA {
        const Real scaled = inverse * row[k];
        each(k, n, [&](auto l) CREDENCE_INLINE_LAMBDA { A.entry[k][l] = fnma(scaled, row[l], A.entry[k][l]); });
    });
    each(zero, n, [&](auto k) CREDENCE_INLINE_LAMBDA { A.at(k, i) = select(used, inverse * row[k], row[k]); });
    A.entry[i][i] = select(used, -inverse, pivot);
    return select(used, pivot, Real(1));
}

/// log det of the first n components' part of P; NaN where that is not positive definite. `by_axis`: P = P_1 (x) I_2.
template <bool by_axis, class Real, int capacity, class Size>
CREDENCE_INLINE Real log_determinant(Symmetric<Real, capacity>& P, Size n) {
    ScaledProduct<Real> product;
    Mask<Real> positive = all_lanes<Real>();
    const auto visit = [&](const Real& pivot) {
        positive = both(positive, pivot > Real(0));
        product.multiply(pivot);
    };
    if constexpr (by_axis)
        each_pivot(half(n), [&](auto i, auto j) { return P.entry[two * j][two * i]; }, P, visit);
    else
        each_pivot(n, [&](auto i, auto j) { return P.entry[j][i]; }, P, visit);
    const Real log_det = Real(by_axis ? 2 : 1) * product.log();
    return select(positive, log_det, Real(std::numeric_limits<double>::quiet_NaN()));
}

/// Where every eigenvalue of W^1/2 P W^1/2 lies below `bound`: bound I - W^1/2 P W^1/2 is positive definite.
template <class Layout, class Real, int capacity>
CREDENCE_FLAT Mask<Real> all_below(Real bound, Symmetric<Real, capacity>& P, const Layout& layout,
                                   const Weights& weights) {
    Mask<Real> below = all_lanes<Real>();
    const auto visit = [&](const Real& pivot) { below = both(below, pivot > Real(0)); };
    if constexpr (Layout::by_axis) {
        const auto entry = [&](auto i, auto j) {
            return fnma(Real(weights.features), P.entry[two * j][two * i], i == j ? bound : Real(0));
        };
        each_pivot(half(layout.size()), entry, P, visit);
    } else {
        const double heading = __builtin_sqrt(weights.heading);  // the other components weigh 1
        const auto root = [&](int i) { return i < Layout::position ? heading : 1.0; };
        const auto entry = [&](auto i, auto j) {
            return fnma(Real(root(i) * root(j)), P.entry[j][i], i == j ? bound : Real(0));
        };
        each_pivot(layout.size(), entry, P, visit);
    }
    return below;
}

/// The largest eigenvalue of W^1/2 P W^1/2 to 2^-52 of it, from above: by bisection between the largest diagonal entry
/// and the trace.
template <class Layout, class Real, int capacity>
Real largest_eigenvalue(Symmetric<Real, capacity>& P, const Layout& layout, const Weights& weights) {
    constexpr int halvings = 60;  // of an interval of at most 131 times the value
    Real low = Real(0), high = weighted_trace(P, layout, weights);
    for (int i = 0; i < layout.size(); ++i) {
        const Real variance = Real(weight_at<Layout>(weights, i)) * P.entry[i][i];
        low = select(variance > low, variance, low);
    }
    for (int i = 0; i < halvings; ++i) {
        const Real middle = Real(0.5) * (low + high);
        const Mask<Real> below = all_below(middle, P, layout, weights);
        high = select(below, middle, high);
        low = select(below, low, middle);
    }
    return high;
}

/// The cost of a covariance. Its entries are not changed; those below the diagonal are workspace.
template <class Layout, class Real, int capacity>
CREDENCE_FLAT Real cost_of(Symmetric<Real, capacity>& P, const ControlParameters& control, const Layout& layout) {
    switch (control.criterion) {
        case Criterion::log_det: return log_determinant<Layout::by_axis>(P, layout.size());
        case Criterion::pose_log_det: return log_determinant<Layout::by_axis>(P, Layout::pose_size);
        case Criterion::max_eigenvalue: return largest_eigenvalue(P, layout, control.weights);
        default: return weighted_trace(P, layout, control.weights);
    }
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
