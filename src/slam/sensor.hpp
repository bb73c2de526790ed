#pragma once
// The sensor: which features are in sight, how large the noise is, and what is measured [docs/model.md, Filter: See,
// Edges].
//
//   q  range to a feature, length units; z  measurement, relative position of a feature in the body frame

#include "slam/world.hpp"

namespace credence {

struct SensorParameters {
    double range_min = 0, range_max = 0;
    /// r_min <= sqrt(s) <= r_max exactly where these bound s: no square root is needed.
    double squared_range_min = 0, squared_range_max = 0;
    RangeNoise noise = RangeNoise::constant;
    double sigma = 0;                 ///< constant noise
    double sigma_near = 0;            ///< ranged: at range_min
    double sigma_slope = 0;           ///< ranged: (sigma_far - sigma_near) / (range_max - range_min)
    double detection = 1;
    double sigma_edge = 0;            ///< of the edge measurement itself; 0 where the true edges have no noise
};

inline namespace CREDENCE_TARGET {

template <class Real>
Real squared_range(const Vector2<Real>& from, const Vector2<Real>& to) {
    return squared_norm(to - from);
}

/// r_min <= q <= r_max, both ends included, of a squared range.
template <class Real>
Mask<Real> in_range(const SensorParameters& sensor, Real squared) {
    return within(squared, Real(sensor.squared_range_min), Real(sensor.squared_range_max));
}

/// Noise that grows linearly from range_min on, not clamped above.
template <class Real>
Real ranged_sigma(const SensorParameters& sensor, Real q) {
    const Real beyond = q - Real(sensor.range_min);
    const Real clamped = select(beyond > Real(0), beyond, Real(0));
    return fma(Real(sensor.sigma_slope), clamped, Real(sensor.sigma_near));
}

/// sigma_feat(q) of a squared range.
template <class Real>
Real sigma_at(const SensorParameters& sensor, Real squared) {
    return sensor.noise == RangeNoise::constant ? Real(sensor.sigma) : ranged_sigma(sensor, sqrt(squared));
}

/// One sighting of one feature. Where it is not seen, z and sigma are those it would have had.
template <class Real>
struct Sighting {
    Mask<Real> seen{};
    Vector2<Real> z{};  ///< body frame
    Real sigma{};     ///< true standard deviation of each axis
};

/// z_j = R(theta)' (p_j - r) + sigma_feat(q) eps^meas for every feature, in sight or not. `measurement` [M] are the
/// draws; `sightings` [M].
template <class Layout, class Real, int capacity, class Noise>
CREDENCE_FLAT void look(const Truth<Real, capacity>& truth, const SensorParameters& sensor, const Layout& layout, int k,
                        const Vector2<Real>* measurement, const Noise& noise, Sighting<Real>* sightings) {
    each(zero, layout.features(), [&](auto j) {
        const Real squared = squared_range(truth.position, truth.feature[j]);
        Sighting<Real>& sighting = sightings[j];
        sighting.seen = in_range(sensor, squared);
        if (sensor.detection < 1)
            sighting.seen =
                both(sighting.seen, noise.uniform(Source::detection, k, j) < Real(sensor.detection));
        sighting.sigma = sigma_at(sensor, squared);
        sighting.z = truth.feature[j] - truth.position;
        if constexpr (Layout::has_heading) sighting.z = rotate_back(truth.rotation, sighting.z);
        sighting.z = add_scaled(sighting.z, sighting.sigma, measurement[j]);
    });
}

/// The first estimate of every feature, in the world frame, made whatever its range: p_{0,j} + sigma_feat(q_{0,j})
/// eps^meas_{0,j}; `measurement` [M] are the draws. `sightings` [M].
template <class Real, int capacity, class Count>
void look_first(const Truth<Real, capacity>& truth, const SensorParameters& sensor, Count features,
                const Vector2<Real>* measurement, Sighting<Real>* sightings) {
    each(zero, features, [&](auto j) {
        const Real sigma = sigma_at(sensor, squared_range(truth.position, truth.feature[j]));
        sightings[j] = {Mask<Real>{}, add_scaled(truth.feature[j], sigma, measurement[j]), sigma};
    });
}

/// Edge measurement z = p_b - p_a, world frame, with a noise of its own where the truth has one.
template <class Real, int capacity, class Noise>
Vector2<Real> measure_edge(const Truth<Real, capacity>& truth, const SensorParameters& sensor, const Edge& edge,
                           int k, int index, const Noise& noise) {
    const Vector2<Real> difference = truth.feature[edge.to] - truth.feature[edge.from];
    if (sensor.sigma_edge > 0)
        return add_scaled(difference, Real(sensor.sigma_edge), noise.normal(Source::edge, k, index));
    return difference;
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
