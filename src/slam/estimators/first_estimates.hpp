#pragma once
// The first-estimates-Jacobian filter [Huang, Mourikis, Roumeliotis 2010]: every Jacobian is evaluated at the first
// estimate of each variable, so that unobservable directions stay unobservable.

#include "slam/estimators/estimator.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// Linearises sightings at the predicted pose and the features' first estimates.
template <class Layout, class Real>
struct AtFirstEstimates {
    const Real* mean;
    const Vector2<Real>* first;  ///< [M]
    Rotation<Real> frame;

    AtFirstEstimates(const Real* x, const Vector2<Real>* first_estimates)
        : mean(x), first(first_estimates), frame(rotation(x[Layout::heading])) {}

    template <class Index>
    Linearised<Layout, Real, Index> operator()(Index j, const Sighting<Real>& sighting) const {
        return {sighting_rows_at<Layout>(first[j] - point_at(mean, Layout::position), j),
                rotate(frame, sighting.z) - predicted_difference<Layout>(mean, j)};
    }
};

/// F[r, theta] = J (r^-_k - r^-_{k-1}), from the predicted positions of both poses. A feature that does not walk is one
/// variable: its first estimate is the one with which it was initialised, moved along its known motion. A feature that
/// walks is a new variable at every pose, whose first estimate is the predicted one.
template <class Layout, class Real>
struct FirstEstimatesFilter : KalmanFilter<Layout, Real> {
    using typename KalmanFilter<Layout, Real>::State;
    using typename KalmanFilter<Layout, Real>::World;

    void start(const Layout& layout, const State& belief, const World&) {
        position_ = point_at(belief.mean, Layout::position);
        for (int j = 0; j < layout.features(); ++j) first_[j] = point_at(belief.mean, Layout::feature(j));
    }

    void predict(State& belief, const FilterParameters& filter, const Layout& layout, const Command<Real>& command,
                 const World&, int k) {
        const Vector2<Real> before = position_, updated = point_at(belief.mean, Layout::position);
        predict_robot(belief, filter, layout, command, [&](const Vector2<Real>& move) {
            position_ = updated + move;
            return position_ - before;
        });
        predict_features(belief, filter, layout, k);
        for (int j = 0; j < layout.features(); ++j) {
            const Point &t = filter.translation[k - 1], &d = filter.sway_increment_at(k, j);
            first_[j] = filter.variance_feature > 0 ? point_at(belief.mean, Layout::feature(j))
                                                    : first_[j] + Vector2<Real>{Real(t.x + d.x), Real(t.y + d.y)};
        }
    }

    AtFirstEstimates<Layout, Real> linearised(const State& predicted, const Layout&, const World&) const {
        return {predicted.mean, first_};
    }

    void initialise(State& belief, const FilterParameters& filter, const Layout& layout, int j,
                    const Sighting<Real>& sighting, const World&) {
        initialise_feature(belief, filter, layout, j, sighting, [&](const Vector2<Real>& place) {
            first_[j] = {select(sighting.seen, place.x, first_[j].x), select(sighting.seen, place.y, first_[j].y)};
            return place - position_;
        });
    }

private:
    Vector2<Real> position_{};                       ///< r^-, predicted, of the last pose that was predicted
    Vector2<Real> first_[Layout::feature_capacity];  ///< first estimates of the features, of this pose
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
