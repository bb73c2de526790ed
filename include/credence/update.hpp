#pragma once
// Room 6: the filter's update [model.md, Filter: Update].
//
//   H  rows of a measurement, N  its noise variance, nu  innovation, W = P H', S = H W + N, K = W S^-1
// Every measurement comes as two rows with isotropic noise. A sighting is rotated into the world by R(theta^), which
// leaves its noise as it is: its rows are [-J d, -I, +I] at (theta, r, f_j), d = f_j - r; an edge's are [-I, +I] at
// (f_a, f_b). Updating with two rows after two, each innovation taken about what the rows before it have moved (the
// running correction), is the joint update of model.md, and the parts of nu' S^-1 nu add up to the joint one.

#include <credence/filter.hpp>

namespace credence {
inline namespace CREDENCE_UNIT {

/// Two rows of H: the difference of the points at state indices `to` and `from`, and its lever -J d on the heading.
template <class Real>
struct Rows {
    int from = 0, to = 0;
    bool turns = false;   ///< whether the heading enters
    Vector2<Real> lever;  ///< (d_y, -d_x), only where the heading enters
};

/// What two rows do to a belief: W = P H', K = W S^-1, and S^-1 (zero where the rows are masked).
template <class Real, int capacity>
struct Gain {
    Vector2<Real> W[capacity];
    Vector2<Real> K[capacity];
    Real S_inverse_xx{}, S_inverse_xy{}, S_inverse_yy{};
    Mask<Real> positive_definite{};
};

/// Outcome of an update: the state's correction is in the belief; nis = nu' S^-1 nu over `rows` rows.
template <class Real>
struct UpdateResult {
    Real nis{}, rows{}, unseen{};
    Mask<Real> positive_definite{};  ///< every S was
};

/// H_j or H_ab applied to a state-sized column.
template <class Layout, class Real>
Vector2<Real> apply_rows(const Rows<Real>& rows, const Real* column) {
    Vector2<Real> difference{column[rows.to] - column[rows.from], column[rows.to + 1] - column[rows.from + 1]};
    if constexpr (Layout::has_heading)
        if (rows.turns) difference = add_scaled(difference, column[Layout::heading], rows.lever);
    return difference;
}

/// W = P H': one point's columns of P minus the other's, plus the lever times the heading's.
template <class Layout, class Real, int capacity>
void project(const Symmetric<Real, capacity>& P, int n, const Rows<Real>& rows, Vector2<Real>* W) {
    for (int i = 0; i < n; ++i) {
        W[i] = {P.at(i, rows.to) - P.at(i, rows.from), P.at(i, rows.to + 1) - P.at(i, rows.from + 1)};
        if constexpr (Layout::has_heading)
            if (rows.turns) W[i] = add_scaled(W[i], P.at(i, Layout::heading), rows.lever);
    }
}

/// Conditions P on two rows of noise variance N: P <- P - W S^-1 W'. Masked lanes keep theirs.
template <class Layout, class Real, int capacity>
void condition(Symmetric<Real, capacity>& P, int n, const Rows<Real>& rows, Real N, Mask<Real> used,
               Gain<Real, capacity>& gain) {
    project<Layout>(P, n, rows, gain.W);
    Real column_x[capacity], column_y[capacity];
    for (int i = 0; i < n; ++i) column_x[i] = gain.W[i].x, column_y[i] = gain.W[i].y;
    const Vector2<Real> HWx = apply_rows<Layout>(rows, column_x), HWy = apply_rows<Layout>(rows, column_y);
    const Real S_xx = HWx.x + N, S_xy = HWx.y, S_yy = HWy.y + N;
    const Real determinant = fnma(S_xy, S_xy, S_xx * S_yy);
    gain.positive_definite = either(both(S_xx > Real(0), determinant > Real(0)), negated(used));
    const Real weight = select(used, Real(1) / determinant, Real(0));
    gain.S_inverse_xx = S_yy * weight;
    gain.S_inverse_xy = -(S_xy * weight);
    gain.S_inverse_yy = S_xx * weight;
    for (int i = 0; i < n; ++i)
        gain.K[i] = {fma(gain.W[i].y, gain.S_inverse_xy, gain.W[i].x * gain.S_inverse_xx),
                     fma(gain.W[i].y, gain.S_inverse_yy, gain.W[i].x * gain.S_inverse_xy)};
    for (int i = 0; i < n; ++i)
        for (int j = i; j < n; ++j)
            P.entry[i][j] =
                fnma(gain.K[i].y, gain.W[j].y, fnma(gain.K[i].x, gain.W[j].x, P.entry[i][j]));
}

/// Adds K (nu - H correction) to the running correction, and nu' S^-1 nu of these two rows to the NIS.
template <class Layout, class Real, int capacity>
void correct(const Gain<Real, capacity>& gain, int n, const Rows<Real>& rows, const Vector2<Real>& nu,
             Real* correction, UpdateResult<Real>& result) {
    const Vector2<Real> fresh = nu - apply_rows<Layout>(rows, correction);
    for (int i = 0; i < n; ++i)
        correction[i] = fma(gain.K[i].y, fresh.y, fma(gain.K[i].x, fresh.x, correction[i]));
    const Real weighted_x = fma(gain.S_inverse_xy, fresh.y, gain.S_inverse_xx * fresh.x);
    const Real weighted_y = fma(gain.S_inverse_yy, fresh.y, gain.S_inverse_xy * fresh.x);
    result.nis = result.nis + fma(weighted_y, fresh.y, weighted_x * fresh.x);
    result.positive_definite = both(result.positive_definite, gain.positive_definite);
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
template <class Layout, class Real>
Rows<Real> sighting_rows(const Real* mean, int j) {
    const Vector2<Real> d = predicted_difference<Layout>(mean, j);
    return {Layout::position, Layout::feature(j), Layout::has_heading, {d.y, -d.x}};
}

template <class Layout, class Real>
Rows<Real> edge_rows(const Edge& edge) {
    return {Layout::feature(edge.from), Layout::feature(edge.to), false, {}};
}

/// Believed noise variance of a sighting with true standard deviation sigma.
template <class Real>
Real believed_variance(const FilterParameters& filter, Real sigma) {
    const Real believed = Real(filter.measurement_factor) * sigma;
    return believed * believed;
}

/// Updates a predicted belief with what was seen and with every edge: x <- x + K nu, P <- P - K S K'.
/// `sightings` [M]; `edge_measurement(e)` gives the difference measured on edge e, world frame.
template <class Layout, class Real, int capacity, class EdgeMeasurement>
UpdateResult<Real> update(Belief<Real, capacity>& belief, const FilterParameters& filter, const Layout& layout,
                          const Sighting<Real>* sightings, const EdgeMeasurement& edge_measurement) {
    const int n = layout.size();
    UpdateResult<Real> result{Real(0), Real(2 * filter.edge_count), Real(0), all_lanes<Real>()};
    Gain<Real, capacity> gain;
    Real correction[capacity];
    for (int i = 0; i < n; ++i) correction[i] = Real(0);
    Rotation<Real> heading{};
    if constexpr (Layout::has_heading) heading = rotation(belief.mean[Layout::heading]);

    for (int j = 0; j < layout.features(); ++j) {
        const Sighting<Real>& sighting = sightings[j];
        result.rows = result.rows + select(sighting.seen, Real(2), Real(0));
        result.unseen = result.unseen + select(sighting.seen, Real(0), Real(1));
        if (!any(sighting.seen)) continue;
        const Rows<Real> rows = sighting_rows<Layout>(belief.mean, j);
        condition<Layout>(belief.covariance, n, rows, believed_variance(filter, sighting.sigma), sighting.seen, gain);
        const Vector2<Real> z = Layout::has_heading ? rotate(heading, sighting.z) : sighting.z;
        correct<Layout>(gain, n, rows, z - predicted_difference<Layout>(belief.mean, j), correction, result);
    }
    for (int e = 0; e < filter.edge_count; ++e) {
        const Rows<Real> rows = edge_rows<Layout, Real>(filter.edges[e]);
        condition<Layout>(belief.covariance, n, rows, Real(filter.variance_edge), all_lanes<Real>(), gain);
        correct<Layout>(gain, n, rows, edge_measurement(e) - apply_rows<Layout>(rows, belief.mean), correction, result);
    }
    for (int i = 0; i < n; ++i) belief.mean[i] = belief.mean[i] + correction[i];
    return result;
}

}  // namespace CREDENCE_UNIT
}  // namespace credence
