#pragma once
// Room 6: the filter's update [model.md, Filter: Update].
//
//   H  rows of a measurement, N  its noise variance, nu  innovation, W = P H', S = H W + N, K = W S^-1
// Every measurement comes as two rows with isotropic noise:
//   a sighting, rotated into the world by R(theta^), which leaves its noise as it is: rows [-J d, -I, +I] at
//   (theta, r, f_j), d = f_j - r [docs/model.md, Rotated sightings];
//   a contrast, one of the M - 1 combinations of features (or fewer) that say all that the edges do
//   [docs/model.md, Contrasts].
// Updating with two rows after two, each innovation taken about what the rows before it have moved (the running
// correction), is the joint update of model.md, and the parts of nu' S^-1 nu add up to the joint one.

#include <credence/filter.hpp>

namespace credence {
inline namespace CREDENCE_UNIT {

/// Rows of the sighting of feature j. `lever` = (d_y, -d_x), what the heading moves: used where there is a heading.
template <class Layout, class Real, class Index>
struct SightingRows {
    Index j;
    Vector2<Real> lever;

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

    template <class Column>
    Vector2<Real> operator()(const Column& column) const {
        const auto start = Layout::feature(first);
        Vector2<Real> sum{column(start), column(start + one)};
        each(first + one, layout.features(), [&](auto j) {
            const auto f = Layout::feature(j);
            if (coefficient[j] != 0)
                sum = add_scaled(sum, Real(coefficient[j]), Vector2<Real>{column(f), column(f + one)});
        });
        return sum;
    }
};

/// What an update has come to: the correction K nu so far, nis = nu' S^-1 nu over `rows` rows.
template <class Real, int capacity>
struct Update {
    Real correction[capacity];
    Real nis{}, rows{}, unseen{};
    Mask<Real> positive_definite{};  ///< every S was
};

/// Conditions P on two rows of noise variance N: P <- P - W S^-1 W'. Masked lanes keep theirs. `gained(i, K_i)` is told
/// the gain, row by row. Returns S^-1, zero where masked.
template <class Layout, class Rows, class Real, int capacity, class Gained>
Inverse2<Real> condition(Symmetric<Real, capacity>& P, const Layout& layout, const Rows& rows, Real N, Mask<Real> used,
                         Gained&& gained) {
    const auto n = layout.size();
    Vector2<Real> W[capacity];
    each(zero, n, [&](auto i) { W[i] = rows([&](auto s) { return P.at(i, s); }); });
    const Vector2<Real> HWx = rows([&](auto s) { return W[s].x; });
    const Vector2<Real> HWy = rows([&](auto s) { return W[s].y; });
    const Inverse2<Real> S_inverse = inverse(HWx.x + N, HWx.y, HWy.y + N, used);
    reload_memory();
    each(zero, n, [&](auto i) {
        const Vector2<Real> K = times(S_inverse, W[i]);
        gained(i, K);
        each(i, n, [&](auto j) { P.entry[i][j] = fnma(K.y, W[j].y, fnma(K.x, W[j].x, P.entry[i][j])); });
    });
    return S_inverse;
}

/// The same for a covariance alone: what a planner asks.
template <class Layout, class Rows, class Real, int capacity>
void condition(Symmetric<Real, capacity>& P, const Layout& layout, const Rows& rows, Real N, Mask<Real> used) {
    condition(P, layout, rows, N, used, [](auto, const Vector2<Real>&) {});
}

/// Conditions P on two rows whose innovation about the predicted mean is nu: adds K (nu - H correction) to the running
/// correction and nu' S^-1 nu of these rows to the NIS.
template <class Layout, class Rows, class Real, int capacity>
void take_in(Symmetric<Real, capacity>& P, const Layout& layout, const Rows& rows, Real N, Mask<Real> used,
             const Vector2<Real>& nu, Update<Real, capacity>& update) {
    const Vector2<Real> fresh = nu - rows([&](auto s) { return update.correction[s]; });
    const auto correct = [&](auto i, const Vector2<Real>& K) {
        update.correction[i] = fma(K.y, fresh.y, fma(K.x, fresh.x, update.correction[i]));
    };
    const Inverse2<Real> S_inverse = condition(P, layout, rows, N, used, correct);
    update.nis = update.nis + between(fresh, S_inverse, fresh);
    update.positive_definite = both(update.positive_definite, S_inverse.positive_definite);
}

template <class Real>
Vector2<Real> point_at(const Real* mean, int index) {
    return {mean[index], mean[index + 1]};
}

/// d = f_j - r at the mean x, world frame: what a sighting rotated into the world is expected to be.
template <class Layout, class Real>
Vector2<Real> predicted_difference(const Real* mean, int j) {
    return point_at(mean, Layout::feature(j)) - point_at(mean, Layout::position);
}

/// Rows of a sighting of feature j, in the world frame, at the mean x.
template <class Layout, class Real, class Index>
SightingRows<Layout, Real, Index> sighting_rows(const Real* mean, Index j) {
    const Vector2<Real> d = predicted_difference<Layout>(mean, j);
    return {j, {d.y, -d.x}};
}

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

/// Takes the edges in, as contrasts. The measured differences z_e, about the predicted mean, become the contrasts'
/// innovations by a forward substitution; what no state can explain of them, the residual of the graph's cycles, adds
/// to the NIS [docs/model.md, Contrasts]. `edge_measurement(e)` gives z_e, world frame.
template <class Layout, class Real, int capacity, class EdgeMeasurement>
void take_in_edges(Belief<Real, capacity>& belief, const FilterParameters& filter, const Layout& layout,
                   const EdgeMeasurement& edge_measurement, Update<Real, capacity>& update) {
    Vector2<Real> pull[Layout::feature_capacity];  // B' nu: what the edges say of each feature
    Real unexplained = Real(0);
    each(zero, layout.features(), [&](auto j) { pull[j] = {Real(0), Real(0)}; });
    for (int e = 0; e < filter.edge_count; ++e) {
        const Edge& edge = filter.edges[e];
        const Vector2<Real> expected = point_at(belief.mean, Layout::feature(edge.to)) -
                                       point_at(belief.mean, Layout::feature(edge.from));
        const Vector2<Real> nu = edge_measurement(e) - expected;
        pull[edge.from] = pull[edge.from] - nu;
        pull[edge.to] = pull[edge.to] + nu;
        unexplained = unexplained + squared_norm(nu);
    }
    each(zero, layout.features() - one, [&](auto c) {
        const Contrast& contrast = filter.contrasts[c];
        if (contrast.scale == 0) return;
        const Vector2<Real> w = pull[c];
        const Vector2<Real> nu{Real(contrast.scale) * w.x, Real(contrast.scale) * w.y};
        each(c + one, layout.features(), [&](auto j) {
            pull[j] = add_scaled(pull[j], Real(-contrast.coefficient[j]), w);
        });
        unexplained = fnma(w.y, nu.y, fnma(w.x, nu.x, unexplained));
        take_in(belief.covariance, layout, contrast_rows<Real>(filter, layout, c),
                Real(contrast.scale * filter.variance_edge), all_lanes<Real>(), nu, update);
    });
    if (filter.edge_count > 0) update.nis = fma(unexplained, Real(1 / filter.variance_edge), update.nis);
}

/// Updates a predicted belief with what was seen and with every edge: x <- x + K nu, P <- P - K S K'.
/// `sightings` [M]; `edge_measurement(e)` gives the difference measured on edge e, world frame.
template <class Layout, class Real, int capacity, class EdgeMeasurement>
CREDENCE_FLAT void update_belief(Belief<Real, capacity>& belief, const FilterParameters& filter, const Layout& layout,
                                 const Sighting<Real>* sightings, const EdgeMeasurement& edge_measurement,
                                 Update<Real, capacity>& update) {
    const auto n = layout.size();
    update.nis = update.unseen = Real(0);
    update.rows = Real(2 * filter.edge_count);
    update.positive_definite = all_lanes<Real>();
    each(zero, n, [&](auto i) { update.correction[i] = Real(0); });
    Rotation<Real> heading{};
    if constexpr (Layout::has_heading) heading = rotation(belief.mean[Layout::heading]);

    each(zero, layout.features(), [&](auto j) {
        const Sighting<Real>& sighting = sightings[j];
        update.rows = update.rows + select(sighting.seen, Real(2), Real(0));
        update.unseen = update.unseen + select(sighting.seen, Real(0), Real(1));
        if (!any(sighting.seen)) return;
        const Vector2<Real> z = Layout::has_heading ? rotate(heading, sighting.z) : sighting.z;
        take_in(belief.covariance, layout, sighting_rows<Layout>(belief.mean, j),
                believed_variance(filter, sighting.sigma), sighting.seen,
                z - predicted_difference<Layout>(belief.mean, j), update);
    });
    take_in_edges(belief, filter, layout, edge_measurement, update);
    each(zero, n, [&](auto i) { belief.mean[i] = belief.mean[i] + update.correction[i]; });
}

}  // namespace CREDENCE_UNIT
}  // namespace credence
