#pragma once
// The ideal extended Kalman filter: Jacobians at the true state [Huang, Mourikis, Roumeliotis 2010]. It uses the truth,
// so it cannot be implemented on a robot. Where the measurement is nonlinear over the range of the errors it is not
// optimal either: the extended Kalman filter linearises at one end of the error, this one at the other
// [docs/estimators.md].

#include "slam/estimators/estimator.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// Linearises sightings at the true state x: rows in the frame of the true heading, innovation about the mean.
template <class Layout, class Real>
struct AtTruth {
    using World = Truth<Real, Layout::feature_capacity>;
    const Real* mean;
    const World* truth;
    Rotation<Real> frame, estimated;

    AtTruth(const Real* x, const World& world)
        : mean(x), truth(&world), frame(world.rotation), estimated(rotation(x[Layout::heading])) {}

    template <class Index>
    Linearised<Layout, Real, Index> operator()(Index j, const Sighting<Real>& sighting) const {
        const Vector2<Real> expected = rotate_back(estimated, predicted_difference<Layout>(mean, j));
        return {sighting_rows_at<Layout>(truth->feature[j] - truth->position, j), rotate(frame, sighting.z - expected)};
    }
};

/// F[r, theta] = J (r_k - r_{k-1}) with the true displacement, its noise included. With R(theta) v in its place, the
/// filter would gain information in unobservable directions.
template <class Layout, class Real>
struct IdealFilter : KalmanFilter<Layout, Real> {
    using typename KalmanFilter<Layout, Real>::State;
    using typename KalmanFilter<Layout, Real>::World;

    void start(const Layout&, const State&, const World& truth) { position_ = truth.position; }

    void predict(State& belief, const FilterParameters& filter, const Layout& layout, const Command<Real>& command,
                 const World& truth, int k) {
        const Vector2<Real> displacement = truth.position - position_;
        predict_robot(belief, filter, layout, command, [&](const Vector2<Real>&) { return displacement; });
        predict_features(belief, filter, layout, k);
        position_ = truth.position;
    }

    AtTruth<Layout, Real> linearised(const State& predicted, const Layout&, const World& truth) const {
        return {predicted.mean, truth};
    }

    void initialise(State& belief, const FilterParameters& filter, const Layout& layout, int j,
                    const Sighting<Real>& sighting, const World& truth) {
        initialise_feature(belief, filter, layout, j, sighting,
                           [&](const Vector2<Real>&) { return truth.feature[j] - truth.position; });
    }

private:
    Vector2<Real> position_{};  ///< true position at the previous pose
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
