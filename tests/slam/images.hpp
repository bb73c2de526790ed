#pragma once
// Images of a trial: its scenario and noise in a world whose difference the equations do not know.

#include "hard_planning.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

namespace credence::test {

/// A scenario and its noise in the other world, and what becomes of the state: x' = map x.
struct Image {
    DeformableSettings scenario;
    AnyNoise noise;
    Eigen::MatrixXd map;
    std::vector<int> feature;  ///< [M] by its number in the image, its number before

    Image(const DeformableSettings& of, const AnyNoise& with)
        : scenario(of), noise(with), map(Eigen::MatrixXd::Identity(state_size(of), state_size(of))),
          feature(static_cast<std::size_t>(feature_count(of))) {
        std::iota(feature.begin(), feature.end(), 0);
    }
    Eigen::Index place(std::size_t j) const { return pose_size(scenario) + 2 * static_cast<Eigen::Index>(j); }
};

/// In a unit of length that is 1/factor of the other. The unit of the heading stays the radian.
inline Image in_unit(const DeformableSettings& scenario, const AnyNoise& noise, double factor) {
    Image image(scenario, noise);
    DeformableSettings& s = image.scenario;
    for (Point& position : s.features.positions) position = {position.x * factor, position.y * factor};
    for (double* length : {&s.features.step, &s.sensor.range_min, &s.sensor.range_max, &s.sensor.sigma,
                           &s.sensor.sigma_near, &s.sensor.sigma_far, &s.noise.odometry, &s.noise.walk,
                           &s.noise.deformation, &s.noise.initial_position})
        *length *= factor;
    s.planner.heading_weight *= factor * factor;
    image.map *= factor;
    if (s.process == Process::heading) image.map(0, 0) = 1;
    return image;
}

/// y for -y, left turns for right turns.
inline Image mirrored(const DeformableSettings& scenario, const AnyNoise& noise) {
    Image image(scenario, noise);
    for (Point& position : image.scenario.features.positions) position.y = -position.y;
    image.scenario.features.turn = -scenario.features.turn;
    image.noise.normal_draw = [noise](Source source, int pose, int index) {
        const Vector2<double> draw = noise.normal(source, pose, index);
        return Vector2<double>{source == Source::odometry_heading ? -draw.x : draw.x, -draw.y};
    };
    const bool heading = scenario.process == Process::heading;
    if (heading) image.map(0, 0) = -1;
    for (Eigen::Index y = heading ? 2 : 1; y < image.map.rows(); y += 2) image.map(y, y) = -1;
    return image;
}

/// An edge of the image: its number before, and -1 where it runs the other way now.
struct MovedEdge {
    Edge edge;
    int before;
    double sign;
};

inline std::vector<MovedEdge> moved_edges(const DeformableSettings& scenario, const std::vector<int>& feature) {
    std::vector<int> now(feature.size());
    for (std::size_t j = 0; j < feature.size(); ++j) now[static_cast<std::size_t>(feature[j])] = static_cast<int>(j);
    std::vector<MovedEdge> moved;
    for (const Edge& edge : edge_list(scenario)) {
        const int from = now[static_cast<std::size_t>(edge.from)], to = now[static_cast<std::size_t>(edge.to)];
        moved.push_back(
            {{std::min(from, to), std::max(from, to)}, static_cast<int>(moved.size()), from < to ? 1.0 : -1.0});
    }
    std::sort(moved.begin(), moved.end(), [](const MovedEdge& a, const MovedEdge& b) {
        return std::pair(a.edge.from, a.edge.to) < std::pair(b.edge.from, b.edge.to);
    });
    return moved;
}

/// The features in another order, each with its own noise and edges.
inline Image permuted(const DeformableSettings& scenario, const AnyNoise& noise, unsigned seed) {
    Image image(scenario, noise);
    std::shuffle(image.feature.begin(), image.feature.end(), std::mt19937(seed));
    image.map.rightCols(image.map.cols() - image.place(0)).setZero();
    for (std::size_t j = 0; j < image.feature.size(); ++j) {
        const auto before = static_cast<std::size_t>(image.feature[j]);
        image.scenario.features.positions[j] = scenario.features.positions[before];
        image.map.block<2, 2>(image.place(j), image.place(before)).setIdentity();
    }
    const std::vector<MovedEdge> moved = moved_edges(scenario, image.feature);
    image.scenario.edges = {moved.empty() ? EdgeGraph::none : EdgeGraph::list, {}};
    for (const MovedEdge& edge : moved) image.scenario.edges.list.push_back(edge.edge);
    const auto before = [feature = image.feature](int j) { return feature[static_cast<std::size_t>(j)]; };
    image.noise.normal_draw = [=](Source source, int pose, int index) {
        if (source == Source::edge) {
            const MovedEdge& edge = moved[static_cast<std::size_t>(index)];
            const Vector2<double> draw = noise.normal(source, pose, edge.before);
            return Vector2<double>{edge.sign * draw.x, edge.sign * draw.y};
        }
        const bool of_feature =
            source == Source::walk || source == Source::deformation || source == Source::measurement;
        return noise.normal(source, pose, of_feature ? before(index) : index);
    };
    image.noise.uniform_draw = [=](Source source, int pose, int index) {
        return noise.uniform(source, pose, before(index));
    };
    return image;
}

}  // namespace credence::test
