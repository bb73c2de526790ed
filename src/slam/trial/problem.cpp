#include "slam/trial/problem.hpp"

#include <credence/detail/functions.hpp>
#include <credence/detail/planner_batch.hpp>
#include "scenario/state_series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace credence {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The least s >= 0 with sqrt(s) >= range, in floating point; sqrt rounds correctly and never decreases.
double least_square(double range) {
    double s = range * range;
    while (s > 0 && std::sqrt(std::nextafter(s, 0)) >= range) s = std::nextafter(s, 0);
    while (std::sqrt(s) < range) s = std::nextafter(s, infinity);
    return s;
}

/// The greatest s with sqrt(s) <= range.
double greatest_square(double range) {
    double s = range * range;
    while (std::sqrt(s) > range) s = std::nextafter(s, 0);
    while (s < infinity && std::sqrt(std::nextafter(s, infinity)) <= range) s = std::nextafter(s, infinity);
    return s;
}

double squared(double x) { return x * x; }

/// phi_k = delta/2 + k delta, the direction in which the features leave pose k on the circle.
double circle_direction(const DeformableSettings& s, int k) { return s.features.turn / 2 + k * s.features.turn; }

Point sway_offset(const DeformableSettings& s, int k, int j) {
    if (s.features.sway_amplitude == 0) return {};
    const double M = feature_count(s);
    const double start = 2 * pi * j / M;
    const Point now = polar(s.features.sway_amplitude, 2 * pi * k / s.features.sway_period + start);
    const Point first = polar(s.features.sway_amplitude, start);
    return {now.y - first.y, now.x - first.x};  // A (sin psi, cos psi) - A (sin psi_0, cos psi_0)
}

Control fixed_control(const DeformableSettings& s, int k) {
    const double d = s.features.step, delta = s.features.turn;
    const bool heading = s.process == Process::heading;
    switch (robot_path(s)) {
        case Path::straight: return {0, {d, 0}};
        case Path::circle:
            return heading ? Control{delta, polar(d, delta)} : Control{0, polar(d, circle_direction(s, k) + delta)};
        case Path::still: break;
    }
    return {};
}

}  // namespace

Point polar(double s, double angle) {
    const Rotation<double> r = rotation(angle);
    return {s * r.cosine, s * r.sine};
}

std::vector<Point> feature_translations(const DeformableSettings& s) {
    std::vector<Point> translations;
    for (int k = 0; k + 1 < s.poses; ++k) switch (s.features.path) {
            case Path::straight: translations.push_back({s.features.step, 0}); break;
            case Path::circle: translations.push_back(polar(s.features.step, circle_direction(s, k))); break;
            case Path::still: translations.push_back({0, 0}); break;
        }
    return translations;
}

std::vector<Point> sway_offsets(const DeformableSettings& s) {
    const int features = feature_count(s);
    std::vector<Point> offsets;
    for (int k = 0; k < s.poses; ++k)
        for (int j = 0; j < features; ++j) offsets.push_back(sway_offset(s, k, j));
    return offsets;
}

std::vector<Control> fixed_controls(const DeformableSettings& s) {
    std::vector<Control> controls;
    for (int k = 0; k + 1 < s.poses; ++k) controls.push_back(fixed_control(s, k));
    return controls;
}

std::vector<Control> planner_candidates(const DeformableSettings& s) {
    const int half_width = *s.planner.speeds;
    const auto speed = [&](int i) { return i / 5.0 * s.features.step; };
    std::vector<Control> candidates;
    if (s.process == Process::heading) {
        for (const double turn : *s.planner.turns)
            for (int i = -half_width; i <= half_width; ++i) candidates.push_back({turn, polar(speed(i), turn)});
    } else if (robot_path(s) == Path::straight) {
        for (int i = -half_width; i <= half_width; ++i) candidates.push_back({0, {speed(i), 0}});
    } else {
        for (int a = -half_width; a <= half_width; ++a)
            for (int b = -half_width; b <= half_width; ++b) candidates.push_back({0, {speed(a), speed(b)}});
    }
    return candidates;
}

void set_budget(CommonView& view, const BudgetSettings& budget) {
    view.other = budget.other;
    view.keeps_variances = budget.keeps_variances();
    for (const int step : kept_steps(budget.errors, view.poses - 1)) view.kept_steps[view.kept_count++] = step;
}

Problem::Problem(const DeformableSettings& resolved_scenario)
    : scenario_(resolved_scenario),
      translation_(feature_translations(scenario_)),
      sway_(sway_offsets(scenario_)),
      sway_increment_(sway_.size()),
      edges_(edge_list(scenario_)),
      fixed_(fixed_controls(scenario_)),
      waypoints_(waypoint_controls(scenario_)),
      candidates_(planner_candidates(scenario_)) {
    const std::size_t features = static_cast<std::size_t>(feature_count(scenario_));
    for (std::size_t i = features; i < sway_.size(); ++i)
        sway_increment_[i] = {sway_[i].x - sway_[i - features].x, sway_[i].y - sway_[i - features].y};
    factor_edges();
    planners_ = planners_of(scenario_);
    for (const auto& planner : planners_) planner_list_.push_back(planner.get());
    view_.planners = planner_list_.data();
    view_.process = scenario_.process;
    view_.poses = scenario_.poses;
    view_.features = static_cast<int>(features);
    view_.state_size = state_size(scenario_);
    const std::vector<ComponentGroup> groups = state_groups(scenario_);
    view_.group_count = static_cast<int>(groups.size());
    coverage_bounds_ = coverage_bounds(groups);
    view_.coverage_bounds = coverage_bounds_.data();
    view_.series_count = static_cast<int>(step_series(scenario_).size());
    view_.charts = charts_of(scenario_);
    set_budget(view_, scenario_.budget);
    fill_world();
    fill_filter();
    fill_control();
}

/// C D C' = B'B by outer products, B the edges' incidence matrix. Its pivots are 0 at the last feature of each
/// connected component of the graph; the smallest other pivot is at least 1/largest_feature_count.
void Problem::factor_edges() {
    const std::size_t M = static_cast<std::size_t>(feature_count(scenario_));
    std::vector<double> laplacian(M * M);
    for (const Edge& edge : edges_) {
        const std::size_t a = static_cast<std::size_t>(edge.from), b = static_cast<std::size_t>(edge.to);
        laplacian[a * M + a] += 1;
        laplacian[b * M + b] += 1;
        laplacian[a * M + b] -= 1;
        laplacian[b * M + a] -= 1;
    }
    // No eigenvalue of a simple graph's Laplacian exceeds M, nor twice its greatest degree.
    double greatest_degree = 0;
    for (std::size_t j = 0; j < M; ++j) greatest_degree = std::max(greatest_degree, laplacian[j * M + j]);
    view_.filter.laplacian_bound = std::min(static_cast<double>(M), 2 * greatest_degree);
    contrast_coefficients_.assign(M * M, 0);
    for (std::size_t c = 0; c + 1 < M; ++c) {
        const double pivot = laplacian[c * M + c];
        const bool says_something = pivot > 1e-9;
        if (says_something) {
            for (std::size_t j = c; j < M; ++j) contrast_coefficients_[c * M + j] = laplacian[c * M + j] / pivot;
            for (std::size_t i = c + 1; i < M; ++i)
                for (std::size_t j = c + 1; j < M; ++j)
                    laplacian[i * M + j] -= contrast_coefficients_[c * M + i] * laplacian[c * M + j];
        }
        contrasts_.push_back({contrast_coefficients_.data() + c * M, says_something ? 1 / pivot : 0});
    }
}

void Problem::fill_world() {
    const NoiseSettings& noise = scenario_.noise;
    WorldParameters& world = view_.world;
    world.poses = view_.poses;
    world.features = view_.features;
    world.edges = static_cast<int>(edges_.size());
    world.first_position = scenario_.features.positions.data();
    world.translation = translation_.data();
    world.sway = sway_.data();
    world.sigma_heading = noise.heading;
    world.sigma_odometry = noise.odometry;
    world.sigma_walk = noise.walk;
    world.sigma_deformation = noise.deformation;
    world.sigma_initial_heading = noise.initial_heading;
    world.sigma_initial_position = noise.initial_position;
    world.sigma_odometry_bias = noise.odometry_bias;
    const FeatureSettings& features = scenario_.features;
    world.placement = features.placement;
    world.extent = features.extent;
    world.radius_min = features.radius_min;
    world.radius_max = features.radius_max;
    world.deformation = scenario_.truth.deformation;
    world.truncate = noise.truncate.value_or(std::numeric_limits<double>::infinity());

    const SensorSettings& settings = scenario_.sensor;
    SensorParameters& sensor = view_.sensor;
    sensor.range_min = settings.range_min;
    sensor.range_max = settings.range_max;
    sensor.squared_range_min = least_square(settings.range_min);
    sensor.squared_range_max = greatest_square(settings.range_max);
    sensor.noise = settings.noise;
    sensor.sigma = settings.sigma;
    sensor.sigma_near = settings.sigma_near;
    sensor.sigma_slope = (settings.sigma_far - settings.sigma_near) / (settings.range_max - settings.range_min);
    sensor.detection = settings.detection;
    sensor.every = settings.every;
    sensor.tails = noise.measurement_tails;
    sensor.degrees_of_freedom = noise.degrees_of_freedom;
    sensor.outlier_share = noise.outlier_share;
    sensor.outlier_scale = noise.outlier_scale;
    sensor.sigma_edge = scenario_.truth.edge_noise == EdgeNoise::independent ? noise.deformation : 0;
}

void Problem::fill_filter() {
    const NoiseSettings& noise = scenario_.noise;
    const FilterSettings& factors = scenario_.filter;
    FilterParameters& filter = view_.filter;
    filter.features = view_.features;
    filter.translation = translation_.data();
    filter.sway_increment = sway_increment_.data();
    filter.edges = edges_.data();
    filter.contrasts = contrasts_.data();
    filter.edge_count = static_cast<int>(edges_.size());
    filter.variance_heading = squared(factors.heading * noise.heading);
    filter.variance_odometry = squared(factors.odometry * noise.odometry);
    filter.variance_feature = squared(factors.features * noise.walk) + squared(factors.features * noise.deformation);
    filter.variance_edge = squared(factors.edges * noise.deformation);
    filter.variance_initial_heading = squared(noise.initial_heading);
    filter.variance_initial_position = squared(noise.initial_position);
    filter.measurement_factor = factors.measurement;
    filter.covariance_factor = factors.covariance;
    filter.log_covariance_factor = log(factors.covariance);
    filter.gate = -2 * log(1 - factors.gate);  // the quantile of chi-square with two degrees of freedom
}

void Problem::fill_control() {
    view_.control.fixed = fixed_.data();
    view_.control.waypoints = waypoints_.data();
    view_.control.candidates = candidates_.data();
    view_.control.candidate_count = static_cast<int>(candidates_.size());
    repeated_ = std::make_unique<bool[]>(candidates_.size());
    for (std::size_t i = 0; i < candidates_.size(); ++i)
        repeated_[i] = std::any_of(candidates_.begin() + static_cast<std::ptrdiff_t>(i) + 1, candidates_.end(),
                                   [&](const Control& later) { return later.move == candidates_[i].move; });
    view_.control.repeated = repeated_.get();
    for (const Control& candidate : candidates_)
        view_.control.squared_reach =
            std::max(view_.control.squared_reach, squared(candidate.move.x) + squared(candidate.move.y));
    view_.control.horizon = *scenario_.planner.horizon;
    view_.control.criterion = scenario_.planner.criterion;
    view_.control.weights = weights_of(scenario_.planner.criterion, scenario_.planner.heading_weight);
}

}  // namespace credence
