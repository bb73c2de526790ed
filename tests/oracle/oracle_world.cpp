// World of the oracle: truth and sensor. Nomenclature: oracle.hpp.

#include "oracle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace credence::oracle {

int number_of_features(const DeformableSettings& scenario) {
    const FeatureSettings& features = scenario.features;
    return features.placement == Placement::given ? static_cast<int>(features.positions.size()) : *features.count;
}

int pose_dimension(const DeformableSettings& scenario) { return scenario.process == Process::heading ? 3 : 2; }

int state_dimension(const DeformableSettings& scenario) {
    return pose_dimension(scenario) + 2 * number_of_features(scenario);
}

int row_of_position(const DeformableSettings& scenario) { return scenario.process == Process::heading ? 1 : 0; }

int row_of_feature(const DeformableSettings& scenario, int j) { return pose_dimension(scenario) + 2 * j; }

/// Edges in graph order: `all` takes every pair a < b, a outer; `chain` takes (j, j+1) [docs/model.md, Filter, Edges].
std::vector<Edge> graph(const DeformableSettings& scenario) {
    const int M = number_of_features(scenario);
    std::vector<Edge> edges;
    switch (scenario.edges.graph) {
        case EdgeGraph::all:
            for (int a = 0; a < M; ++a)
                for (int b = a + 1; b < M; ++b) edges.push_back({a, b});
            break;
        case EdgeGraph::chain:
            for (int j = 0; j + 1 < M; ++j) edges.push_back({j, j + 1});
            break;
        case EdgeGraph::none: break;
        case EdgeGraph::list: edges = scenario.edges.list; break;
    }
    return edges;
}

/// R(theta) = [cos, -sin; sin, cos], from the body's frame to the world's [docs/model.md, Two process models].
Eigen::Matrix2d rotation(double theta) {
    Eigen::Matrix2d R;
    R << std::cos(theta), -std::sin(theta),
         std::sin(theta),  std::cos(theta);
    return R;
}

/// J = [0, -1; 1, 0], so that dR/dtheta = R J = J R [docs/model.md, Two process models].
Eigen::Matrix2d quarter_turn() {
    Eigen::Matrix2d J;
    J << 0, -1,
         1,  0;
    return J;
}

/// Translation t_k (2, world, length) of every feature from pose k to k+1: straight (d, 0); circle
/// d (cos phi_k, sin phi_k), phi_k = delta/2 + k delta; still 0 [docs/model.md, Truth].
Eigen::Vector2d translation(const DeformableSettings& scenario, int k) {
    const double d = scenario.features.step, delta = scenario.features.turn;
    const double phi = delta / 2 + k * delta;
    switch (scenario.features.path) {
        case Path::straight: return {d, 0};
        case Path::circle: return {d * std::cos(phi), d * std::sin(phi)};
        case Path::still: break;
    }
    return {0, 0};
}

/// Known local deformation o_{k,j} (2, world, length) = A (sin psi, cos psi) - A (sin psi_0, cos psi_0),
/// psi = 2 pi k/T + 2 pi j/M [docs/model.md, Truth].
Eigen::Vector2d local_deformation(const DeformableSettings& scenario, int k, int j) {
    const double A = scenario.features.sway_amplitude, T = scenario.features.sway_period;
    const double psi_0 = 2 * std::numbers::pi * j / number_of_features(scenario);
    const double psi = 2 * std::numbers::pi * k / T + psi_0;
    return {A * std::sin(psi) - A * std::sin(psi_0), A * std::cos(psi) - A * std::cos(psi_0)};
}

namespace {

/// Deformed features p (2 x M, world) at pose k: c + o + sigma_def eps^def for jitter; c + o for walk, whose
/// deformation is already in the centres [docs/model.md, Truth; Truth against filter].
Eigen::Matrix2Xd deformed(const DeformableSettings& scenario, const Eigen::Matrix2Xd& c, int k, const Noise& noise) {
    Eigen::Matrix2Xd p = c;
    for (int j = 0; j < number_of_features(scenario); ++j) {
        p.col(j) += local_deformation(scenario, k, j);
        if (scenario.truth.deformation == Deformation::jitter)
            p.col(j) += scenario.noise.deformation * noise.normal(Source::deformation, k, j);
    }
    return p;
}

/// f_0 of a feature (2, world): given, or uniform in a box or ring about the first of features.positions
/// [docs/model.md, Truth].
Eigen::Vector2d first_place(const DeformableSettings& scenario, int j, const Noise& noise) {
    const FeatureSettings& features = scenario.features;
    const auto given = [&](int i) {
        const Point point = features.positions[static_cast<std::size_t>(i)];
        return Eigen::Vector2d(point.x, point.y);
    };
    if (features.placement == Placement::given) return given(j);
    const double u = noise.uniform(Source::placement, 0, 2 * j), v = noise.uniform(Source::placement, 0, 2 * j + 1);
    if (features.placement == Placement::box) return given(0) + features.extent * Eigen::Vector2d(u - 0.5, v - 0.5);
    const double r = features.radius_min, R = features.radius_max;  // equal areas for equal intervals of u
    return given(0) + std::sqrt(r * r + u * (R * R - r * r)) * (rotation(2 * std::numbers::pi * v).col(0));
}

}  // namespace

/// World at pose 0: c_0 = f_0; the robot at 0, or drawn about it with the initial sigmas [docs/model.md,
/// Truth].
World first_world(const DeformableSettings& scenario, const Noise& noise) {
    World world;
    if (scenario.process == Process::heading)
        world.theta = scenario.noise.initial_heading * noise.normal(Source::odometry_heading, 0, 0)[0];
    world.r = scenario.noise.initial_position * noise.normal(Source::odometry_position, 0, 0);
    world.bias = scenario.noise.odometry_bias * noise.normal(Source::odometry_bias, 0, 0);
    world.c.resize(2, number_of_features(scenario));
    for (int j = 0; j < number_of_features(scenario); ++j) {
        world.c.col(j) = first_place(scenario, j, noise);
    }
    world.p = deformed(scenario, world.c, 0, noise);
    return world;
}

/// World at pose k from that at pose k-1 and the control between them: the robot turns and moves by its heading of
/// before; centres translate and walk, and with deformation = walk gain the deformation too [docs/model.md, Truth;
/// Truth against filter].
World next_world(const DeformableSettings& scenario, const World& world, const Control& control, int k,
                 const Noise& noise) {
    const Eigen::Vector2d v(control.move.x, control.move.y);
    World next;
    next.theta = 0;
    if (scenario.process == Process::heading)
        next.theta = world.theta + control.turn +
                     scenario.noise.heading * noise.normal(Source::odometry_heading, k, 0)[0];
    next.bias = world.bias;
    next.r = world.r + rotation(world.theta) * (v + world.bias) +
             scenario.noise.odometry * noise.normal(Source::odometry_position, k, 0);
    next.c = world.c;
    for (int j = 0; j < number_of_features(scenario); ++j) {
        next.c.col(j) += translation(scenario, k - 1);
        next.c.col(j) += scenario.noise.walk * noise.normal(Source::walk, k - 1, j);
        if (scenario.truth.deformation == Deformation::walk)
            next.c.col(j) += scenario.noise.deformation * noise.normal(Source::deformation, k, j);
    }
    next.p = deformed(scenario, next.c, k, noise);
    return next;
}

/// True state (n) in the order of the filter's x, with the deformed features [docs/model.md, Two process models].
Eigen::VectorXd true_state(const DeformableSettings& scenario, const World& world) {
    Eigen::VectorXd x(state_dimension(scenario));
    if (scenario.process == Process::heading) x[0] = world.theta;
    x.segment<2>(row_of_position(scenario)) = world.r;
    for (int j = 0; j < number_of_features(scenario); ++j) x.segment<2>(row_of_feature(scenario, j)) = world.p.col(j);
    return x;
}

/// Whether a feature at range q is in the sensor's range, both ends included [docs/model.md, Filter, See].
bool in_range(const DeformableSettings& scenario, double q) {
    return scenario.sensor.range_min <= q && q <= scenario.sensor.range_max;
}

/// True sigma_feat(q) (length): constant, or sigma_near + (sigma_far - sigma_near) max(0, q - r_min)/(r_max - r_min),
/// not clamped above [docs/model.md, Units].
double measurement_sigma(const DeformableSettings& scenario, double q) {
    const SensorSettings& sensor = scenario.sensor;
    if (sensor.noise == RangeNoise::constant) return sensor.sigma;
    return sensor.sigma_near + (sensor.sigma_far - sensor.sigma_near) * std::max(0.0, q - sensor.range_min) /
                                   (sensor.range_max - sensor.range_min);
}

/// The noise of a measurement over its sigma (2): normal; Student's t with the variance 1, a normal pair of length s
/// stretched to sqrt(nu (e^(s^2/nu) - 1)) sqrt((nu - 2)/nu); or normal with outliers [docs/model.md, Filter, See].
Eigen::Vector2d measurement_noise(const DeformableSettings& scenario, int k, int j, const Noise& noise) {
    const NoiseSettings& settings = scenario.noise;
    const Eigen::Vector2d normal = noise.normal(Source::measurement, k, j);
    const double nu = settings.degrees_of_freedom, length = normal.norm();
    switch (settings.measurement_tails) {
        case Tails::normal: break;
        case Tails::student:
            return normal.normalized() * std::sqrt(nu * std::expm1(length * length / nu)) * std::sqrt((nu - 2) / nu);
        case Tails::contaminated:
            return noise.uniform(Source::outlier, k, j) < settings.outlier_share ? settings.outlier_scale * normal
                                                                                 : normal;
    }
    return normal;
}

/// Measurement z_j (2, body frame) = R(theta)' (p_j - r) + sigma_feat(q) eps^meas at pose k [docs/model.md, Filter,
/// See].
Eigen::Vector2d measured_feature(const DeformableSettings& scenario, const World& world, int k, int j,
                                 const Noise& noise) {
    const Eigen::Vector2d offset = world.p.col(j) - world.r;
    return rotation(world.theta).transpose() * offset +
           measurement_sigma(scenario, offset.norm()) * measurement_noise(scenario, k, j, noise);
}

/// Construction measurement z (2, world frame) = p_b - p_a of edge e in graph order at pose k, plus sigma_def eps^edge
/// with independent edge noise [docs/model.md, Filter, Edges; Truth against filter].
Eigen::Vector2d measured_edge(const DeformableSettings& scenario, const World& world, int k, int e,
                              const Noise& noise) {
    const Edge edge = graph(scenario)[static_cast<std::size_t>(e)];
    Eigen::Vector2d z = world.p.col(edge.to) - world.p.col(edge.from);
    if (scenario.truth.edge_noise == EdgeNoise::independent)
        z += scenario.noise.deformation * noise.normal(Source::edge, k, e);
    return z;
}

}  // namespace credence::oracle
