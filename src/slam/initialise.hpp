#pragma once
// The initialisation of a feature that is seen for the first time [docs/estimators.md, First sight].
//
//   z  the sighting, body frame; sigma^2 its assumed variance; c = J d, the displacement of the feature by an error of
//   the heading: d = f^ - r^, except for estimators that linearise elsewhere

#include "slam/condition.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// P[f,:] = P[r,:] + c P[theta,:], applied once more for P[f,f], plus the sighting's noise, in the lanes `used`.
template <class Layout, class Real, int capacity>
void initialise_covariance(Symmetric<Real, capacity>& P, const Layout& layout, int j, const Vector2<Real>& c,
                           Real variance, Mask<Real> used) {
    constexpr int t = Layout::heading, x = Layout::position, y = x + 1;
    const int f = Layout::feature(j), n = layout.size();
    const auto row = [&](int i) { return add_scaled(Vector2<Real>{P.at(x, i), P.at(y, i)}, P.at(t, i), c); };
    for (int i = 0; i < n; ++i) {
        if (i == f || i == f + 1) continue;
        const Vector2<Real> with_i = row(i);
        P.at(f, i) = select(used, with_i.x, P.at(f, i));
        P.at(f + 1, i) = select(used, with_i.y, P.at(f + 1, i));
    }
    const Vector2<Real> with_x = row(f), with_y = row(f + 1);
    P.entry[f][f] = select(used, with_x.x + variance, P.entry[f][f]);
    P.entry[f][f + 1] = select(used, with_y.x, P.entry[f][f + 1]);
    P.entry[f + 1][f + 1] = select(used, with_y.y + variance, P.entry[f + 1][f + 1]);
}

/// Initialises feature j where it is seen, after the update with the features that were known before, replacing its
/// earlier estimate: f^ = r^ + R(theta^) z, P[f,:] = P[r,:] + c P[theta,:], P[f,f] = [c I] P_pose [c I]' + sigma^2 I.
/// `turned(f^)` gives d.
template <class Layout, class Real, int capacity, class Turned>
void initialise_feature(Belief<Real, capacity>& belief, const FilterParameters& filter, const Layout& layout, int j,
                        const Sighting<Real>& sighting, const Turned& turned) {
    static_assert(Layout::has_heading, "without a heading nothing is turned");
    const int f = Layout::feature(j);
    const Vector2<Real> place = point_at(belief.mean, Layout::position) +
                                rotate(rotation(belief.mean[Layout::heading]), sighting.z);
    belief.mean[f] = select(sighting.seen, place.x, belief.mean[f]);
    belief.mean[f + 1] = select(sighting.seen, place.y, belief.mean[f + 1]);
    const Vector2<Real> d = turned(place);
    initialise_covariance(belief.covariance, layout, j, Vector2<Real>{-d.y, d.x},
                          believed_variance(filter, sighting.sigma), sighting.seen);
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
