#pragma once
// What the tests of the core share: scenarios by their keys, noise sources made of functions, and one trial of the
// production code with everything that happened in it.

#include "oracle/oracle.hpp"

#include "worlds/deformable/deformable.hpp"
#include <credence/text.hpp>

#include <credence/detail/draws.hpp>
#include "slam/world.hpp"

#include <Eigen/Dense>

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace credence::test {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Values by key, set in order.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// The seed's scenario with some keys set, resolved and validated.
DeformableSettings scenario_with(const Settings& settings);
/// The same, on top of another scenario; what depends on other keys is resolved anew where `base` was not resolved.
DeformableSettings scenario_with(DeformableSettings base, const Settings& settings);

/// The eight cells of the document, {heading, translation} x {straight, circle} x {constant, ranged}, as settings.
std::vector<Settings> seed_cells();

/// Settings as one line, for messages.
std::string described(const Settings& settings);

/// The world in which the filter's beliefs are the truth [docs/model.md, Truth against filter], as settings.
Settings matched_world();

/// A noise source made of functions, with the interface of KeyedDraws.
struct AnyNoise {
    std::function<Vector2<double>(Source, int pose, int index)> normal_draw;
    std::function<double(Source, int pose, int index)> uniform_draw;

    Vector2<double> normal(Source source, int pose, int index) const { return normal_draw(source, pose, index); }
    double uniform(Source source, int pose, int index) const { return uniform_draw(source, pose, index); }
};

/// Keyed draws of one trial, as a scenario has them.
AnyNoise keyed_noise(const DeformableSettings& scenario, std::uint64_t root_seed, std::uint64_t trial);
/// No noise at all: every normal draw is 0, every uniform too.
AnyNoise silent_noise();
/// Another noise in which one draw is changed.
AnyNoise with_draw(AnyNoise noise, Source source, int pose, int index, Vector2<double> draw);
oracle::Noise for_oracle(const AnyNoise& noise);
/// The draws of three features and their robot at a pose.
template <class Layout, class Noise>
WorldDraws<Layout, double> draws_at(const Noise& noise, int pose) {
    WorldDraws<Layout, double> draws(Layout(3));
    draws.draw(noise, pose);
    return draws;
}

/// The quantities at one pose. At pose 0 only truth, mean and covariance are set.
struct RunStep {
    Eigen::VectorXd truth, prior_mean, mean;
    Eigen::MatrixXd prior_covariance, covariance;  ///< as the filter holds them
    Control control;
    std::vector<bool> seen;
    Eigen::VectorXd sigma;                         ///< [M] true sigma of each sighting
    Eigen::MatrixXd sighting, edge;                ///< [M, 2] body frame, [edges, 2] world frame
    std::vector<double> candidate_cost;            ///< planned only
};

/// One trial of one arm by the production code.
struct Run {
    std::vector<double> columns;    ///< [column_count], not filled
    Eigen::MatrixXd figures;        ///< [series_count, K - 1]
    std::vector<std::string> names; ///< of the series
    std::vector<RunStep> steps;     ///< [K]

    /// The value of the series of this name at pose k = 1 ... K - 1.
    double figure(const std::string& name, int k) const;
    Eigen::VectorXd series(const std::string& name) const;
};

/// Which compiled form of the equations: the one that the engine picks, or always that for any number of features.
enum class Form { engine, any_number };

/// Every criterion, with weights of the heading below and above 1.
inline std::vector<Settings> criteria() {
    return {{{"planner.criterion", "trace"}, {"planner.heading_weight", "30"}},
            {{"planner.criterion", "log_det"}},
            {{"planner.criterion", "max_eigenvalue"}, {"planner.heading_weight", "0.2"}},
            {{"planner.criterion", "pose_trace"}, {"planner.heading_weight", "4"}},
            {{"planner.criterion", "pose_log_det"}},
            {{"planner.criterion", "features_trace"}}};
}

Run run_arm(const DeformableSettings& scenario, const Arm& arm, const AnyNoise& noise, Form form = Form::engine);
/// The same with the process model's own estimator.
Run run_arm(const DeformableSettings& scenario, Controller controller, const AnyNoise& noise, Form form = Form::engine);

/// Greatest differences of a production trial from the oracle's, over its poses.
struct Difference {
    bool same_sight = true, same_control = true;
    double mean = 0, covariance = 0;                ///< 2-norm and Frobenius norm, over that of the oracle's
    double prior_mean = 0, prior_covariance = 0;
    double nees = 0, nis = 0, trace_P = 0;          ///< relative
    double cost = 0;                                ///< relative, over all candidates
    double pose_error = 0, nees_ratio = 0, nis_ratio = 0;
    double log_score = 0;                           ///< in nats a component
    double path_length = 0;
    bool same_unseen = true, same_rows = true;
    double condition = 0;                           ///< greatest condition of S, which the tolerances rest on
};
Difference difference(const Run& ours, const oracle::Trial& oracle);

/// |a - b| / |b|; 0 where both are the same, infinite or NaN included.
double relative(double a, double b);

/// Same bits, so that a NaN equals itself and 0 differs from -0.
bool same_bits(double a, double b);
bool same_bits(const std::vector<double>& a, const std::vector<double>& b);
bool same_bits(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// The columns of three trials of a block, in lanes and of every target and arm, that have other bits than one trial at a
/// time.
std::vector<std::string> other_bits_in_lanes(const Problem& problem);

/// Smallest eigenvalue of a symmetric matrix.
double smallest_eigenvalue(const Eigen::MatrixXd& symmetric);

/// The message with which `action` refuses; empty where it does not.
std::string refusal(const std::function<void()>& action);

}  // namespace credence::test
