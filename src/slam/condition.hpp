#pragma once
// Conditioning a belief on two rows of a measurement [docs/model.md, Filter: Update].
//
//   H  rows of a measurement, N  its noise variance, nu  innovation, W = P H', S = H W + N, K = W S^-1
// Every measurement comes as two rows with isotropic noise:
//   a sighting, rotated into the world by R(theta^), which leaves its noise as it is: rows [-J d, -I, +I] at
//   (theta, r, f_j), d = f_j - r [docs/theory/model.md, Rotated sightings];
//   a contrast, one of the M - 1 combinations of features (or fewer) that say all that the edges do
//   [docs/theory/model.md, Contrasts].
// Updating with the rows two by two, each innovation corrected for the change of the mean by the rows before it (the
// running correction), gives the joint update of model.md, and the contributions to nu' S^-1 nu add up to the joint
// one.

#include "slam/filter.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// Where rows of H can differ from 0: at the pose, if `pose`, and at the features' components [first, last).
template <bool pose, class First, class Last>
struct Entries {
    First first;
    Last last;
};

template <bool pose, class First, class Last>
Entries<pose, First, Last> entries_at(First first, Last last) { return {first, last}; }

/// use(i) for the components of the state where H has entries.
template <class Layout, bool pose, class First, class Last, class Use>
CREDENCE_INLINE void each_entry(const Layout&, const Entries<pose, First, Last>& entries, const Use& use) {
    if constexpr (pose) each(zero, Layout::pose_size, use);
    each(entries.first, entries.last, use);
}

/// use(i) for all others.
template <class Layout, bool pose, class First, class Last, class Use>
CREDENCE_INLINE void each_other(const Layout& layout, const Entries<pose, First, Last>& entries, const Use& use) {
    if constexpr (!pose) each(zero, Layout::pose_size, use);
    each(Layout::pose_size, entries.first, use);
    each(entries.last, layout.size(), use);
}

/// Rows of the sighting of feature j. `lever` = (d_y, -d_x), what the heading moves: used where there is a heading.
template <class Layout, class Real, class Index>
struct SightingRows {
    Index j;
    Vector2<Real> lever;

    auto entries() const {
        const auto f = Layout::feature(j);
        return entries_at<true>(f, f + two);
    }

    /// H applied to a state-sized column, given as column(i).
    template <class Column>
    Vector2<Real> operator()(const Column& column) const {
        constexpr auto r = Layout::position;
        const auto f = Layout::feature(j);
        const Vector2<Real> difference{column(f) - column(r), column(f + one) - column(r + one)};
        if constexpr (Layout::has_heading)
            return add_scaled(difference, column(Layout::heading), lever);
        else
            return difference;
    }
};

/// Rows of a contrast: the sum over the features j >= first of coefficient[j] f_j.
template <class Layout, class Real, class First>
struct ContrastRows {
    Layout layout;
    First first;                ///< feature of the first coefficient that is not 0: it is 1
    const double* coefficient;  ///< [M]

    auto entries() const { return entries_at<false>(Layout::feature(first), layout.size()); }

    template <class Column>
    Vector2<Real> operator()(const Column& column) const {
        const auto start = Layout::feature(first);
        Vector2<Real> sum{column(start), column(start + one)};
        each(first + one, layout.features(), [&](auto j) {
            const auto f = Layout::feature(j);
            // Where loops are written out, a product with 0 costs less than a test of the coefficient; finite sums are
            // the same.
            if (Layout::written_out || coefficient[j] != 0)
                sum = add_scaled(sum, Real(coefficient[j]), Vector2<Real>{column(f), column(f + one)});
        });
        return sum;
    }
};

/// The accumulated result of an update: the correction K nu, and nis = nu' S^-1 nu over `rows` rows; the same for the
/// features' rows alone and for the edges' rows alone, each with its own part of S.
template <class Real, int capacity>
struct Update {
    Real correction[capacity];
    Real nis{}, nis_features{}, nis_edges{}, rows{}, unseen{};
    Real unsettled{};                ///< 1 where an iterated update has not converged, else 0
    Mask<Real> positive_definite{};  ///< every S was
    Elimination<Real, capacity> alone;  ///< workspace for nis_edges

    // A class derived from this one hears by these what the update does to P [estimators/attributed.hpp].
    void begun() {}                                ///< it begins, from the predicted P
    template <class... What>
    void gained(const What&...) {}                 ///< (S, i, K): the gain of component i for the decorrelated rows
    template <class... What>
    void taken(const What&...) {}                  ///< (layout, rows, N): P was conditioned with these gains
    template <class... What>
    void turned(const What&...) {}                 ///< (layout, shift): turn_covariance
};

/// Conditions P on two rows of noise variance N: P <- P - W S^-1 W'. Masked lanes stay unchanged. `gained(S, i, gain)`
/// receives the gain of each component for the decorrelated rows. Returns S.
template <class Layout, class Rows, class Real, int capacity, class Gained>
Decorrelation<Real> condition_both_axes(Symmetric<Real, capacity>& P, const Layout& layout, const Rows& rows, Real N,
                                        Mask<Real> used, Gained&& gained) {
    const auto n = layout.size();
    const auto entries = rows.entries();
    Vector2<Real> W[capacity];
    const auto make_row = [&](auto i) CREDENCE_INLINE_LAMBDA { W[i] = rows([&](auto s) { return P.at(i, s); }); };
    // The entries that S needs come first: the others are computed while S is being factored.
    each_entry(layout, entries, make_row);
    const Vector2<Real> HWx = rows([&](auto s) { return W[s].x; });
    const Vector2<Real> HWy = rows([&](auto s) { return W[s].y; });
    const Decorrelation<Real> S = decorrelation(HWx.x + N, HWx.y, HWy.y + N, used);
    each_other(layout, entries, make_row);
    each(zero, n, [&](auto i) CREDENCE_INLINE_LAMBDA { W[i] = S(W[i]); });
    auto& entry = read_anew(P).entry;
    const auto update_row = [&](auto i) CREDENCE_INLINE_LAMBDA {
        const Vector2<Real> K = S.weighted(W[i]);
        gained(S, i, K);
        each(i, n, [&](auto j) { entry[i][j] = fnma(K.y, W[j].y, fnma(K.x, W[j].x, entry[i][j])); });
    };
    // Likewise, the next measurement's S needs the pose and the next feature first.
    const auto next = entries.first + two;
    each(zero, Layout::pose_size, update_row);
    each(next, n, update_row);
    each(Layout::pose_size, next, update_row);
    return S;
}

/// The same where P = P_1 (x) I_2, computed on the x axis: `gained(S, i, k)` receives the gain k of each x component i,
/// which is that of component i + 1 as well.
template <class Layout, class Rows, class Real, int capacity, class Gained>
Decorrelation<Real> condition_by_axis(Symmetric<Real, capacity>& P, const Layout& layout, const Rows& rows, Real N,
                                      Mask<Real> used, Gained&& gained) {
    const auto points = half(layout.size());
    const auto entries = rows.entries();
    Real W[capacity];
    const auto make_row = [&](auto i)
                              CREDENCE_INLINE_LAMBDA { W[i] = rows([&](auto s) { return P.at(i - i % 2, s); }).x; };
    each_entry(layout, entries, make_row);
    const Real xx = rows([&](auto s) { return W[s]; }).x + N;
    const Decorrelation<Real> S = decorrelation_by_axis(xx, used);
    each_other(layout, entries, make_row);
    auto& entry = read_anew(P).entry;
    each(zero, points, [&](auto c) CREDENCE_INLINE_LAMBDA {
        const auto i = two * c;
        const Real K = S.precision.x * W[i];
        gained(S, i, K);
        each(c, points, [&](auto d) {
            const auto j = two * d;
            entry[i][j] = entry[i + one][j + one] = fnma(K, W[j], entry[i][j]);
        });
    });
    return S;
}

template <class Layout, class Rows, class Real, int capacity, class Gained>
Decorrelation<Real> condition(Symmetric<Real, capacity>& P, const Layout& layout, const Rows& rows, Real N,
                              Mask<Real> used, Gained&& gained) {
    if constexpr (Layout::by_axis)
        return condition_by_axis(P, layout, rows, N, used, gained);
    else
        return condition_both_axes(P, layout, rows, N, used, gained);
}

/// The same for a covariance alone, as planners need it.
template <class Layout, class Rows, class Real, int capacity>
void condition(Symmetric<Real, capacity>& P, const Layout& layout, const Rows& rows, Real N, Mask<Real> used) {
    condition(P, layout, rows, N, used, [](const auto&, auto, const auto&) {});
}

/// Conditions P on two rows whose innovation about the predicted mean is nu: adds K (nu - H correction) to the running
/// correction and nu' S^-1 nu of these rows to the NIS.
template <class Layout, class Rows, class Real, int capacity, class Updating>
void take_in(Symmetric<Real, capacity>& P, const Layout& layout, const Rows& rows, Real N, Mask<Real> used,
             const Vector2<Real>& nu, Updating& update) {
    const Vector2<Real> fresh = nu - rows([&](auto s) { return update.correction[s]; });
    const auto correct = [&](const auto& S, auto i, const auto& K) {
        if constexpr (Layout::by_axis) {
            update.correction[i] = fma(K, fresh.x, update.correction[i]);
            update.correction[i + one] = fma(K, fresh.y, update.correction[i + one]);
        } else {
            const Vector2<Real> nu_S = S(fresh);
            update.correction[i] = fma(K.y, nu_S.y, fma(K.x, nu_S.x, update.correction[i]));
            update.gained(S, i, K);
        }
    };
    const Decorrelation<Real> S = condition(P, layout, rows, N, used, correct);
    update.nis = update.nis + S.squared(Layout::by_axis ? fresh : S(fresh));
    update.positive_definite = both(update.positive_definite, S.positive_definite);
    update.taken(layout, rows, N);
}

template <class Real>
Vector2<Real> point_at(const Real* mean, int index) {
    return {mean[index], mean[index + 1]};
}

/// d = f_j - r at the mean x, world frame: the expected sighting, rotated into the world.
template <class Layout, class Real>
Vector2<Real> predicted_difference(const Real* mean, int j) {
    return point_at(mean, Layout::feature(j)) - point_at(mean, Layout::position);
}

/// Rows of a sighting of feature j, linearised where d = f_j - r.
template <class Layout, class Real, class Index>
SightingRows<Layout, Real, Index> sighting_rows_at(const Vector2<Real>& d, Index j) {
    return {j, {d.y, -d.x}};
}

/// Rows of a sighting of feature j, in the world frame, at the mean x.
template <class Layout, class Real, class Index>
SightingRows<Layout, Real, Index> sighting_rows(const Real* mean, Index j) {
    return sighting_rows_at<Layout>(predicted_difference<Layout>(mean, j), j);
}

/// A linearised sighting: its rows of H and its innovation, both rotated by the estimator's `frame`.
template <class Layout, class Real, class Index>
struct Linearised {
    SightingRows<Layout, Real, Index> rows;
    Vector2<Real> innovation;
};

/// Linearises sightings at the mean x, turned into the world by R(theta^): the extended Kalman filter's way.
template <class Layout, class Real>
struct AtMean {
    const Real* mean;
    Rotation<Real> frame{Real(1), Real(0)};

    explicit AtMean(const Real* x) : mean(x) {
        if constexpr (Layout::has_heading) frame = rotation(x[Layout::heading]);
    }

    template <class Index>
    Linearised<Layout, Real, Index> operator()(Index j, const Sighting<Real>& sighting) const {
        const Vector2<Real> z = Layout::has_heading ? rotate(frame, sighting.z) : sighting.z;
        return {sighting_rows<Layout>(mean, j), z - predicted_difference<Layout>(mean, j)};
    }
};

/// Believed noise variance of a sighting with true standard deviation sigma.
template <class Real>
Real believed_variance(const FilterParameters& filter, Real sigma) {
    const Real believed = Real(filter.measurement_factor) * sigma;
    return believed * believed;
}

template <class Real, class Layout, class Index>
ContrastRows<Layout, Real, Index> contrast_rows(const FilterParameters& filter, const Layout& layout, Index c) {
    return {layout, c, filter.contrasts[c].coefficient};
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
