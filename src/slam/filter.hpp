#pragma once
// The filter's start and prediction, for both process models [docs/model.md, Filter]. Its update: update.hpp.
//
//   x  mean [n], P  covariance [n, n] (upper triangle), Q  process noise, F  transition
//   omega  turn, v  move; R(theta) = [cos, -sin; sin, cos], J = [0, -1; 1, 0]; theta, r, f as in world.hpp, estimated
// Lengths in length units, angles in rad.

#include "slam/belief.hpp"
#include "slam/sensor.hpp"

#include <limits>

namespace credence {

/// One column of the factored Laplacian B'B = C D C' of the edge graph: the combination sum_j coefficient[j] f_j, which
/// the edges together measure with noise scale * sigma_edge^2 [docs/theory/model.md, Contrasts].
struct Contrast {
    const double* coefficient = nullptr;     ///< [M]; 0 before the contrast's own feature, 1 at it
    double scale = 0;                        ///< 1/D; 0 where the graph has no such contrast
};

/// The filter's model: the noises that it assumes (sigma times the scenario's factors, squared), and the parts of the
/// world that it knows.
struct FilterParameters {
    int features = 0;
    const Point* translation = nullptr;      ///< [K - 1] t_k
    const Point* sway_increment = nullptr;   ///< [K, M] d_{k,j} = o_{k,j} - o_{k-1,j}, row 0 unused
    const Edge* edges = nullptr;
    int edge_count = 0;
    const Contrast* contrasts = nullptr;     ///< [M - 1]
    double laplacian_bound = 0;              ///< not below any eigenvalue of the edge graph's Laplacian
    double variance_heading = 0, variance_odometry = 0, variance_feature = 0, variance_edge = 0;
    double variance_initial_heading = 0, variance_initial_position = 0;
    double measurement_factor = 1;           ///< on sigma_feat
    double covariance_factor = 1;            ///< on the reported P
    double log_covariance_factor = 0;
    double gate = std::numeric_limits<double>::infinity();  ///< largest squared normalised innovation of a sighting

    const Point& sway_increment_at(int k, int j) const { return sway_increment[k * features + j]; }
};

inline namespace CREDENCE_TARGET {

/// The filter's start: the robot at 0 with the initial covariance (zero by default), features at their first estimates.
template <class Layout, class Real, int capacity>
void start_belief(Belief<Real, capacity>& belief, const FilterParameters& filter, const Layout& layout,
                  const Sighting<Real>* first_sights) {
    const int n = layout.size();
    for (int i = 0; i < n; ++i) {
        belief.mean[i] = Real(0);
        for (int j = i; j < n; ++j) belief.covariance.entry[i][j] = Real(0);
    }
    auto& P = belief.covariance.entry;
    if constexpr (Layout::has_heading) P[Layout::heading][Layout::heading] = Real(filter.variance_initial_heading);
    for (int axis = 0; axis < 2; ++axis)
        P[Layout::position + axis][Layout::position + axis] = Real(filter.variance_initial_position);
    for (int j = 0; j < layout.features(); ++j) {
        const int f = Layout::feature(j);
        belief.mean[f] = first_sights[j].z.x;
        belief.mean[f + 1] = first_sights[j].z.y;
        const Real sigma = Real(filter.measurement_factor) * first_sights[j].sigma;
        P[f][f] = P[f + 1][f + 1] = sigma * sigma;
    }
}

/// Predicts the features to pose k: f <- f + t_{k-1} + d_{k,j}, P_ff <- P_ff + sigma_f^2 I.
template <class Layout, class Real, int capacity>
void predict_features(Belief<Real, capacity>& belief, const FilterParameters& filter, const Layout& layout, int k) {
    each(zero, layout.features(), [&](auto j) {
        const auto f = Layout::feature(j);
        const Point &t = filter.translation[k - 1], &d = filter.sway_increment_at(k, j);
        belief.mean[f] = belief.mean[f] + Real(t.x + d.x);
        belief.mean[f + one] = belief.mean[f + one] + Real(t.y + d.y);
        each(f, f + two, [&](auto i) {
            belief.covariance.entry[i][i] = belief.covariance.entry[i][i] + Real(filter.variance_feature);
        });
    });
}

/// F P F' for F = I but F[r, theta] = a: rows r_x and r_y of P gain a times the heading's row.
template <class Layout, class Real, int capacity>
void turn_position(Symmetric<Real, capacity>& P, const Layout& layout, const Vector2<Real>& a) {
    constexpr auto t = Layout::heading;
    constexpr auto x = Layout::position;
    constexpr auto y = x + one;
    auto& e = P.entry;
    const Real old_tx = e[t][x], old_ty = e[t][y];
    e[t][x] = fma(a.x, e[t][t], old_tx);
    e[t][y] = fma(a.y, e[t][t], old_ty);
    e[x][x] = fma(a.x, old_tx + e[t][x], e[x][x]);
    e[x][y] = fma(a.y, e[t][x], fma(a.x, old_ty, e[x][y]));
    e[y][y] = fma(a.y, old_ty + e[t][y], e[y][y]);
    each(Layout::pose_size, layout.size(), [&](auto j) {
        e[x][j] = fma(a.x, e[t][j], e[x][j]);
        e[y][j] = fma(a.y, e[t][j], e[y][j]);
    });
}

/// Predicts the robot under a command: theta <- theta + omega, r <- r + R(theta) v, P <- F P F' + Q, F[r, theta] = J u.
/// `turned(R(theta) v)` gives u, the displacement that an error of the heading rotates: R(theta) v itself, except for
/// estimators that linearise elsewhere.
template <class Layout, class Real, int capacity, class Turned>
void predict_robot(Belief<Real, capacity>& belief, const FilterParameters& filter, const Layout& layout,
                   const Command<Real>& command, const Turned& turned) {
    constexpr auto x = Layout::position;
    constexpr auto y = x + one;
    auto& P = belief.covariance;
    Vector2<Real> move = command.move;
    if constexpr (Layout::has_heading) {
        constexpr auto t = Layout::heading;
        move = rotate(rotation(belief.mean[t]), command.move);
        belief.mean[t] = belief.mean[t] + command.turn;
        const Vector2<Real> u = turned(move);
        turn_position(P, layout, {-u.y, u.x});
        P.entry[t][t] = P.entry[t][t] + Real(filter.variance_heading);
    }
    belief.mean[x] = belief.mean[x] + move.x;
    belief.mean[y] = belief.mean[y] + move.y;
    P.entry[x][x] = P.entry[x][x] + Real(filter.variance_odometry);
    P.entry[y][y] = P.entry[y][y] + Real(filter.variance_odometry);
}

template <class Layout, class Real, int capacity>
void predict_robot(Belief<Real, capacity>& belief, const FilterParameters& filter, const Layout& layout,
                   const Command<Real>& command) {
    predict_robot(belief, filter, layout, command, [](const Vector2<Real>& move) { return move; });
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
