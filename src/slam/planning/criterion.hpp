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
template <class Real, int capacity, class Entry, class Visit>
void each_pivot(int n, const Entry& entry, Symmetric<Real, capacity>& room, const Visit& visit) {
    auto& LD = room.entry;
    Real inverse[capacity], row[capacity];
    for (int j = 0; j < n; ++j) {
        Real pivot = entry(j, j);
        for (int k = 0; k < j; ++k) {
            row[k] = LD[j][k] * inverse[k];
            pivot = fnma(LD[j][k], row[k], pivot);
        }
        visit(pivot);
        inverse[j] = Real(1) / pivot;
        for (int i = j + 1; i < n; ++i) {
            Real sum = entry(i, j);
            for (int k = 0; k < j; ++k) sum = fnma(LD[i][k], row[k], sum);
            LD[i][j] = sum;
        }
    }
}

/// log det of the first n components' part of P; NaN where that is not positive definite.
template <class Real, int capacity>
Real log_determinant(Symmetric<Real, capacity>& P, int n) {
    Real sum = Real(0);
    each_pivot(n, [&](int i, int j) { return P.entry[j][i]; }, P, [&](Real pivot) { sum = sum + log(pivot); });
    return sum;
}

/// Where every eigenvalue of W^1/2 P W^1/2 lies below `bound`: bound I - W^1/2 P W^1/2 is positive definite.
template <class Layout, class Real, int capacity>
Mask<Real> all_below(Real bound, Symmetric<Real, capacity>& P, const Layout& layout, const Weights& weights) {
    Real root[capacity];
    for (int i = 0; i < layout.size(); ++i) root[i] = Real(__builtin_sqrt(weight_at<Layout>(weights, i)));
    const auto entry = [&](int i, int j) {
        return fnma(root[i] * root[j], P.entry[j][i], i == j ? bound : Real(0));
    };
    Mask<Real> below = all_lanes<Real>();
    each_pivot(layout.size(), entry, P, [&](Real pivot) { below = both(below, pivot > Real(0)); });
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
Real cost_of(Symmetric<Real, capacity>& P, const ControlParameters& control, const Layout& layout) {
    switch (control.criterion) {
        case Criterion::log_det: return log_determinant(P, layout.size());
        case Criterion::pose_log_det: return log_determinant(P, Layout::pose_size);
        case Criterion::max_eigenvalue: return largest_eigenvalue(P, layout, control.weights);
        default: return weighted_trace(P, layout, control.weights);
    }
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
