#pragma once
// The filter's update [docs/model.md, Filter: Update]. Letters as in condition.hpp.

#include "slam/edges.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// Rejects the sightings whose nu' S^-1 nu about the predicted belief exceeds the gate, each with its own S [Bar-Shalom
/// 2001, 3.6.2]: they are not seen.
template <class Layout, class Real, int capacity, class Linearisation>
void gate_sightings(const Belief<Real, capacity>& belief, const FilterParameters& filter, const Layout& layout,
                    const Linearisation& linearised, Sighting<Real>* sightings) {
    if (filter.gate == std::numeric_limits<double>::infinity()) return;
    each(zero, layout.features(), [&](auto j) {
        const auto expected = linearised(j, sightings[j]);
        const auto& rows = expected.rows;
        const auto W = [&](auto s) { return rows([&](auto t) { return belief.covariance.at(s, t); }); };
        const Vector2<Real> x = rows([&](auto s) { return W(s).x; }), y = rows([&](auto s) { return W(s).y; });
        const Real N = believed_variance(filter, sightings[j].sigma);
        const Decorrelation<Real> S = decorrelation(x.x + N, x.y, y.y + N, all_lanes<Real>());
        const Real distance = S.squared(S(expected.innovation));
        sightings[j].seen = both(sightings[j].seen, distance <= Real(filter.gate));
    });
}

/// Conditions a predicted belief on the sightings and on every edge: P <- P - K S K', the correction K nu in `update`;
/// the mean is not changed. `sightings` [M]; `edge_measurement(e)` gives the difference measured on edge e, world
/// frame; `linearised(j, sighting)` its rows and innovation.
template <class Layout, class Real, int capacity, class EdgeMeasurement, class Linearisation, class Updating>
void condition_belief(Belief<Real, capacity>& belief, const FilterParameters& filter, const Layout& layout,
                      const Sighting<Real>* sightings, const EdgeMeasurement& edge_measurement,
                      const Linearisation& linearised, Updating& update) {
    const auto n = layout.size();
    update.begun();
    update.nis = update.nis_edges = update.unsettled = Real(0);
    Real rows = Real(2 * filter.edge_count), unseen = Real(0);
    each(zero, layout.features(), [&](auto j) {
        rows = rows + select(sightings[j].seen, Real(2), Real(0));
        unseen = unseen + select(sightings[j].seen, Real(0), Real(1));
    });
    update.rows = rows;
    update.unseen = unseen;
    update.positive_definite = all_lanes<Real>();
    each(zero, n, [&](auto i) { update.correction[i] = Real(0); });
    ContrastInnovations<Layout, Real> contrasts;
    if (filter.edge_count > 0) {
        contrast_innovations(belief, filter, layout, edge_measurement, contrasts);
        update.nis_edges = near_at_hand(layout, update.alone, [&](auto& work) CREDENCE_INLINE_LAMBDA {
            return nis_of_edges(belief.covariance, filter, layout, contrasts, work);
        });
    }

    each(zero, layout.features(), [&](auto j) {
        const Sighting<Real>& sighting = sightings[j];
        if (!any(sighting.seen)) return;
        const auto [rows, innovation] = linearised(j, sighting);
        take_in(belief.covariance, layout, rows, believed_variance(filter, sighting.sigma), sighting.seen, innovation,
                update);
    });
    update.nis_features = update.nis;
    if (filter.edge_count > 0) take_in_edges(belief, filter, layout, contrasts, update);
}

/// Updates a predicted belief: x <- x + K nu, P <- P - K S K'.
template <class Layout, class Real, int capacity, class EdgeMeasurement, class Linearisation, class Updating>
CREDENCE_FLAT void update_belief(Belief<Real, capacity>& belief, const FilterParameters& filter, const Layout& layout,
                                 const Sighting<Real>* sightings, const EdgeMeasurement& edge_measurement,
                                 const Linearisation& linearised, Updating& update) {
    condition_belief(belief, filter, layout, sightings, edge_measurement, linearised, update);
    each(zero, layout.size(), [&](auto i) { belief.mean[i] = belief.mean[i] + update.correction[i]; });
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
