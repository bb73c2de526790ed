#pragma once
// The sensor: which features are in sight, how large the noise is, and what is measured [docs/model.md, Filter: See,
// Edges].
//
//   q  range to a feature, length units; z  measurement, relative position of a feature in the body frame

#include <credence/detail/functions.hpp>
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
    int every = 1;                    ///< steps from one measurement to the next
    Tails tails = Tails::normal;
    double degrees_of_freedom = 0, outlier_share = 0, outlier_scale = 1;
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

/// A pair of Student's t, each of variance 1, from a standard-normal pair [Bailey 1994: Polar generation of random
/// variates with the t-distribution]: of the normal pair's squared length s, which has the uniform e^(-s/2), the t pair
/// in the same direction has nu (e^(s/nu) - 1); t has the variance nu/(nu - 2).
template <class Real>
Vector2<Real> student_pair(const Vector2<Real>& normal, double nu) {
    const Real power = exp(squared_norm(normal) * Real(1 / nu));
    // (e^x - 1)/x without cancellation [Higham 2002, 1.14.1].
    const Real ratio = select(power == Real(1), Real(1), (power - Real(1)) / log(power));
    return scaled(sqrt(Real((nu - 2) / nu) * ratio), normal);
}

/// Gives the measurement noise of pose k its distribution. `measurement` [M]: standard-normal pairs.
template <class Real, class Count, class Noise>
void shape_tails(const SensorParameters& sensor, Count features, int k, const Noise& noise,
                 Vector2<Real>* measurement) {
    if (sensor.tails == Tails::normal) return;
    for (int j = 0; j < features; ++j) {
        if (sensor.tails == Tails::student) {
            measurement[j] = student_pair(measurement[j], sensor.degrees_of_freedom);
            continue;
        }
        const Mask<Real> outlier = noise.uniform(Source::outlier, k, j) < Real(sensor.outlier_share);
        measurement[j] = scaled(select(outlier, Real(sensor.outlier_scale), Real(1)), measurement[j]);
    }
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
    const bool measures = sensor.every == 1 || k % sensor.every == 0;
    each(zero, layout.features(), [&](auto j) {
        const Real squared = squared_range(truth.position, truth.feature[j]);
        Sighting<Real>& sighting = sightings[j];
        sighting.seen = in_range(sensor, squared);
        if (sensor.detection < 1)
            sighting.seen = both(sighting.seen, noise.uniform(Source::detection, k, j) < Real(sensor.detection));
        if (!measures) sighting.seen = negated(all_lanes<Real>());
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
