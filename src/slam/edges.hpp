#pragma once
// What the edges measure, as contrasts of features [docs/theory/model.md, Contrasts]. Letters as in condition.hpp.

#include "slam/condition.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// The edge measurements as innovations of the contrasts, about the predicted mean. `unexplained` is the part of them
/// that no state can explain, the residual of the graph's cycles; it enters the NIS alone [docs/theory/model.md,
/// Contrasts].
template <class Layout, class Real>
struct ContrastInnovations {
    Vector2<Real> nu[Layout::feature_capacity];  ///< [M - 1]
    Real unexplained = Real(0);                  ///< over sigma_edge^2
};

/// Computes the contrasts' innovations by a forward substitution. `edge_measurement(e)` gives z_e, world frame.
template <class Layout, class Real, int capacity, class EdgeMeasurement>
void contrast_innovations(const Belief<Real, capacity>& belief, const FilterParameters& filter, const Layout& layout,
                          const EdgeMeasurement& edge_measurement, ContrastInnovations<Layout, Real>& innovations) {
    Vector2<Real>* pull = innovations.nu;  // B' nu, summed by feature; then, in place, nu of the contrasts
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
        each(c + one, layout.features(),
             [&](auto j) { pull[j] = add_scaled(pull[j], Real(-contrast.coefficient[j]), w); });
        unexplained = fnma(w.y, nu.y, fnma(w.x, nu.x, unexplained));
        pull[c] = nu;
    });
    innovations.unexplained = filter.edge_count > 0 ? unexplained * Real(1 / filter.variance_edge) : Real(0);
}

/// nu' S^-1 nu of the edges alone. P must still be the predicted covariance.
template <class Layout, class Real, int capacity>
Real nis_of_edges(const Symmetric<Real, capacity>& P, const FilterParameters& filter, const Layout& layout,
                  const ContrastInnovations<Layout, Real>& innovations, Elimination<Real, capacity>& work) {
    auto& S = work.A.entry;
    const auto contrasts = layout.features() - one;
    each(zero, contrasts, [&](auto c) {
        const Contrast& contrast = filter.contrasts[c];
        const auto row = two * c;
        const bool idle = contrast.scale == 0;  // the graph lacks this contrast: a row of its own, with innovation 0
        const auto rows = contrast_rows<Real>(filter, layout, c);
        Vector2<Real> W[capacity];  // columns of P H'
        each(Layout::pose_size, layout.size(), [&](auto i) { W[i] = rows([&](auto s) { return P.at(i, s); }); });
        each(c, contrasts, [&](auto d) {
            const auto other = contrast_rows<Real>(filter, layout, d);
            const Vector2<Real> x = other([&](auto s) { return W[s].x; }), y = other([&](auto s) { return W[s].y; });
            const Real noise = Real(c == d ? contrast.scale * filter.variance_edge : 0);
            const auto column = two * d;
            S[row][column] = x.x + noise;
            S[row][column + one] = x.y;
            if (c != d) S[row + one][column] = y.x;
            S[row + one][column + one] = y.y + noise;
            if (idle || filter.contrasts[d].scale == 0) {
                S[row][column] = S[row + one][column + one] = Real(c == d);
                S[row][column + one] = Real(0);
                if (c != d) S[row + one][column] = Real(0);
            }
        });
        work.e[row] = idle ? Real(0) : innovations.nu[c].x;
        work.e[row + one] = idle ? Real(0) : innovations.nu[c].y;
    });
    Real nis = innovations.unexplained;
    each(zero, contrasts,
         [&](auto c) { nis = nis + eliminate_pair<Layout::by_axis>(work, zero, two * (contrasts - one - c)).value; });
    return nis;
}

/// Updates with the edges, as contrasts, and adds their contribution to the NIS.
template <class Layout, class Real, int capacity, class Updating>
void take_in_edges(Belief<Real, capacity>& belief, const FilterParameters& filter, const Layout& layout,
                   const ContrastInnovations<Layout, Real>& innovations, Updating& update) {
    each(zero, layout.features() - one, [&](auto c) {
        const Contrast& contrast = filter.contrasts[c];
        if (contrast.scale == 0) return;
        take_in(belief.covariance, layout, contrast_rows<Real>(filter, layout, c),
                Real(contrast.scale * filter.variance_edge), all_lanes<Real>(), innovations.nu[c], update);
    });
    update.nis = update.nis + innovations.unexplained;
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
