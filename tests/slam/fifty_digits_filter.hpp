#pragma once
// The extended Kalman filter of the heading model in 50 digits: the equations of docs/model.md as they stand there,
// Filter, with dense matrices; all rows at once, sightings in the body frame.

#include "fifty_digits.hpp"

#include "filter_samples.hpp"

#include <credence/text.hpp>
#include "slam/condition.hpp"

#include <vector>

namespace credence::test {

/// A scenario in which every noise is `sigma`, so that S is conditioned as P is.
inline DeformableSettings all_noises(const char* process, double sigma) {
    Settings settings{{"model.process", process}, {"features.step", "1"}, {"features.path", "circle"}};
    for (const char* key : {"noise.heading", "noise.odometry", "noise.walk", "noise.deformation", "sensor.sigma"})
        settings.emplace_back(key, to_text(sigma));
    return scenario_with(settings);
}

/// What is measured at a pose.
struct Measured {
    std::vector<Sighting<double>> sightings;  ///< [M], body frame
    std::vector<Vector2<double>> edges;       ///< world frame
};

/// All features are in sight.
struct FiftyFilter {
    const FilterParameters& filter;
    FiftyVector mean;   ///< [n]: theta, r, f_j
    FiftyMatrix P;      ///< [n, n]
    FiftyMatrix H, S;   ///< of the last linearisation
    FiftyVector expected;
    Fifty nis = 0;

    void predict(const Command<double>& command, int k) {
        const FiftyVector move = rotation_matrix() * fifty(command.move);
        FiftyMatrix F = FiftyMatrix::Identity(mean.size(), mean.size());
        F(1, 0) = -move[1], F(2, 0) = move[0];
        mean[0] += command.turn;
        mean.segment<2>(1) += move;
        P = FiftyMatrix(F * P * F.transpose());
        P(0, 0) += filter.variance_heading;
        P(1, 1) += filter.variance_odometry, P(2, 2) += filter.variance_odometry;
        for (int j = 0; j < filter.features; ++j) {
            const Point &t = filter.translation[k - 1], &d = filter.sway_increment_at(k, j);
            mean.segment<2>(place(j)) += fifty({t.x + d.x, t.y + d.y});
            for (int axis = 0; axis < 2; ++axis) P(place(j) + axis, place(j) + axis) += filter.variance_feature;
        }
    }

    /// Fills H, S and z^ at the predicted mean: rows [-J z^_j, -R', R'] and [-I, I].
    void linearise(const std::vector<Sighting<double>>& sightings) {
        const int sighted = 2 * static_cast<int>(sightings.size()), rows = sighted + 2 * filter.edge_count;
        const FiftyMatrix back = rotation_matrix().transpose(), I = FiftyMatrix::Identity(2, 2);
        H = FiftyMatrix::Zero(rows, mean.size());
        expected.resize(rows);
        FiftyVector N = FiftyVector::Constant(rows, filter.variance_edge);
        for (int j = 0; j < static_cast<int>(sightings.size()); ++j) {
            const FiftyVector z = back * (point(j) - mean.segment<2>(1));
            expected.segment<2>(2 * j) = z;
            H(2 * j, 0) = z[1], H(2 * j + 1, 0) = -z[0];
            H.block<2, 2>(2 * j, 1) = -back;
            H.block<2, 2>(2 * j, place(j)) = back;
            N.segment<2>(2 * j).setConstant(believed_variance(filter, sightings[static_cast<std::size_t>(j)].sigma));
        }
        for (int e = 0; e < filter.edge_count; ++e) {
            const Edge& edge = filter.edges[e];
            const int row = sighted + 2 * e;
            expected.segment<2>(row) = point(edge.to) - point(edge.from);
            H.block<2, 2>(row, place(edge.from)) = -I;
            H.block<2, 2>(row, place(edge.to)) = I;
        }
        S = H * P * H.transpose();
        S.diagonal() += N;
    }

    void update(const Measured& measured) {
        FiftyVector nu = -expected;
        int row = 0;
        for (const Sighting<double>& sighting : measured.sightings) nu.segment<2>(row) += fifty(sighting.z), row += 2;
        for (const Vector2<double>& edge : measured.edges) nu.segment<2>(row) += fifty(edge), row += 2;
        const FiftyMatrix W = P * H.transpose();
        const auto factor = S.llt();
        nis = nu.dot(factor.solve(nu));
        mean += W * factor.solve(nu);
        P -= W * factor.solve(FiftyMatrix(W.transpose()));
    }

private:
    static FiftyVector fifty(const Vector2<double>& v) { return FiftyVector{{Fifty(v.x), Fifty(v.y)}}; }
    static int place(int j) { return 3 + 2 * j; }
    FiftyVector point(int j) const { return mean.segment<2>(place(j)); }
    FiftyMatrix rotation_matrix() const {
        const Fifty c = cos(mean[0]), s = sin(mean[0]);
        return FiftyMatrix{{c, -s}, {s, c}};
    }
};

}  // namespace credence::test
