#pragma once
// Room 6: the iterated extended Kalman filter [Bell, Cathey 1993]: the update is linearised anew where it led, until it
// is the best point of the measurements and the prediction together.

#include <credence/estimator.hpp>

namespace credence {
inline namespace CREDENCE_UNIT {

/// Passes of an update. For a heading noise up to 0.05 the last one changes the mean by less than 3e-4 in the document's
/// world.
inline constexpr int iterated_passes = 8;

/// Linearises sightings at x^- + delta. The innovation is z - h(x^- + delta) + H delta, about the predicted mean.
template <class Layout, class Real>
struct AtIterate {
    const Real *mean, *delta;
    Rotation<Real> frame;

    AtIterate(const Real* x, const Real* correction)
        : mean(x), delta(correction), frame(rotation(x[Layout::heading] + correction[Layout::heading])) {}

    template <class Index>
    Linearised<Layout, Real, Index> operator()(Index j, const Sighting<Real>& sighting) const {
        const Vector2<Real> d = predicted_difference<Layout>(mean, j) + predicted_difference<Layout>(delta, j);
        const auto rows = sighting_rows_at<Layout>(d, j);
        return {rows, rotate(frame, sighting.z) - d + rows([&](auto i) { return delta[i]; })};
    }
};

/// The covariance is that of the last pass, the NIS that of the first: innovations are about what was predicted.
template <class Layout, class Real, int passes>
struct FilterOfPasses : KalmanFilter<Layout, Real> {
    using typename KalmanFilter<Layout, Real>::State;

    template <class EdgeMeasurement, class Linearisation>
    void update(State& belief, const FilterParameters& filter, const Layout& layout, const Sighting<Real>* sightings,
                const EdgeMeasurement& edge_measurement, const Linearisation& linearised,
                Update<Real, Layout::capacity>& update) {
        const int n = layout.size();
        copy(belief.covariance, n, predicted_);
        condition_belief(belief, filter, layout, sightings, edge_measurement, linearised, update);
        const Real nis = update.nis, nis_features = update.nis_features;
        for (int pass = 1; pass < passes; ++pass) {
            for (int i = 0; i < n; ++i) delta_[i] = update.correction[i];
            copy(predicted_, n, belief.covariance);
            condition_belief(belief, filter, layout, sightings, edge_measurement,
                             AtIterate<Layout, Real>(belief.mean, delta_), update);
        }
        for (int i = 0; i < n; ++i) belief.mean[i] = belief.mean[i] + update.correction[i];
        update.nis = nis;
        update.nis_features = nis_features;
    }

private:
    Symmetric<Real, Layout::capacity> predicted_;  ///< P^-
    Real delta_[Layout::capacity];
};

template <class Layout, class Real>
struct IteratedFilter : FilterOfPasses<Layout, Real, iterated_passes> {};

}  // namespace CREDENCE_UNIT
}  // namespace credence
