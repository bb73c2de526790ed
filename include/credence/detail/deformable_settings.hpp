#pragma once
// Module slam: the settings of a scenario of the deformable world. One plain struct per concern; the defaults are those
// of the reference study (heading model, straight path, constant noise). Keys, ranges and texts:
// src/worlds/deformable/.
//
// Units: lengths in `length_unit` (dm in the reference study), angles in radians; sigma is a standard deviation.

#include <credence/columns.hpp>
#include <credence/detail/estimator_list.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// A point or displacement in the world frame, in length units.
struct Point {
    double x = 0;
    double y = 0;
    friend bool operator==(const Point&, const Point&) = default;
};

/// A control: turn (rad), and a displacement (length units), in the body frame for the heading model and in the
/// world frame for the translation model.
struct Control {
    double turn = 0;
    Point move;
    friend bool operator==(const Control&, const Control&) = default;
};

/// A constraint edge between two features, from < to.
struct Edge {
    int from = 0;
    int to = 0;
    friend bool operator==(const Edge&, const Edge&) = default;
};

/// State of the process model: heading is [theta, r_x, r_y, f...], translation is [r_x, r_y, f...] with theta = 0.
enum class Process { heading, translation };
enum class Path { straight, circle, still };
enum class FixedPath { as_features, straight, circle };
enum class RangeNoise { constant, ranged };
/// jitter: deformation is white noise about the feature's centre (as in the document); walk: it accumulates, as the
/// filter assumes.
enum class Deformation { jitter, walk };
enum class EdgeNoise { none, independent };
/// Where the features start: at features.positions, or drawn in each trial about the first of them.
enum class Placement { given, box, ring };
/// The distribution of the measurement noise: normal; Student's t of the same standard deviation; normal, but now and
/// then several times as large.
enum class Tails { normal, student, contaminated };
enum class EdgeGraph { all, chain, none, list };
/// greedy: the control whose next cost is least; horizon: the one whose sum over several steps is least; random: any
/// candidate; nearest: towards the feature least well known; follow: to the centre of the features; waypoints: along
/// control.waypoints. In the order of controller_names.
enum class Controller { fixed, greedy, horizon, random, nearest, follow, waypoints };
/// What the planners minimise [docs/model.md, Criteria].
enum class Criterion { trace, log_det, max_eigenvalue, pose_trace, pose_log_det, features_trace };
/// How the state is estimated, in the order of estimator_list.hpp.
enum class Estimator {
#define CREDENCE_ESTIMATOR(name, process, Type) name,
    CREDENCE_ESTIMATORS(CREDENCE_ESTIMATOR)
#undef CREDENCE_ESTIMATOR
};

struct FeatureSettings {
    std::vector<Point> positions{{0.5, 0.5}, {0.9, 0.8}, {0.3, 0.4}};  ///< f_0, 1 to 64 of them
    std::optional<int> count;                     ///< M; none: as many as there are positions
    Placement placement = Placement::given;
    double extent = 2;                            ///< side of the box
    double radius_min = 0, radius_max = 2;        ///< of the ring
    Path path = Path::straight;
    double step = 2;                              ///< d, length the features and the robot move a step
    double turn = 0.31415926535897931;            ///< delta, turn per step on the circle (pi/10)
    double sway_amplitude = 0;                    ///< A of the known local deformation
    double sway_period = 20;                      ///< T, in poses
};

struct SensorSettings {
    double range_min = 0.1;
    double range_max = 2;                         ///< may be infinite
    RangeNoise noise = RangeNoise::constant;
    double sigma = 0.05;                          ///< constant noise
    double sigma_near = 0.01, sigma_far = 0.09;   ///< ranged noise at range_min and range_max
    double detection = 1;                         ///< probability that a feature in range is seen
    int every = 1;                                ///< steps from one measurement to the next
};

struct NoiseSettings {
    double heading = 0.001;
    double odometry = 0.02;
    double walk = 0.3;
    double deformation = 0.2;
    double initial_heading = 0;
    double initial_position = 0;
    double odometry_bias = 0;                     ///< of a step, body frame, constant in a trial
    Tails measurement_tails = Tails::normal;
    double degrees_of_freedom = 5;                ///< of Student's t
    double outlier_share = 0.1, outlier_scale = 3;
    std::optional<double> truncate;               ///< redraw beyond this multiple of sigma; none: never
};

struct TruthSettings {
    Deformation deformation = Deformation::jitter;
    EdgeNoise edge_noise = EdgeNoise::none;
};

struct EdgeSettings {
    EdgeGraph graph = EdgeGraph::all;
    std::vector<Edge> list;                       ///< only with graph = list
};

/// What the filter believes, as factors on the true standard deviations; `covariance` scales the reported P only. A
/// sighting whose squared normalised innovation exceeds the quantile `gate` of chi-square is rejected.
struct FilterSettings {
    double heading = 1, odometry = 1, features = 1, measurement = 1, edges = 1, covariance = 1;
    double gate = 1;
};

struct PlannerSettings {
    Criterion criterion = Criterion::trace;
    double heading_weight = 1;                    ///< length units^2 per rad^2
    std::optional<int> speeds;                    ///< half-width of the grid in steps of d/5; none: the process's own
    std::optional<std::vector<double>> turns;     ///< rad; none: the path's own
    std::optional<int> horizon;                   ///< steps; none: 2 where an arm plans by a horizon, else 1
    std::map<std::string, std::string> own;       ///< values of the keys of planners of one's own, by their names
};

/// A planner of one's own, by its name; the version tells apart those that bear it in turn.
struct OwnPlanner {
    std::string name, version;
};

struct ArmSettings {
    std::vector<Controller> controllers{Controller::fixed, Controller::greedy};
    std::vector<OwnPlanner> planners;
    std::optional<std::vector<Estimator>> estimators;  ///< none: the process's own
};

struct PublishedSettings {
    std::vector<PublishedNumber> trace_P, unseen, pose_error;
};

struct DeformableSettings {
    std::string name = "scenario";
    std::string title;
    std::string length_unit = "dm";
    int poses = 20;                               ///< K, the first included
    BudgetSettings budget;
    Process process = Process::heading;
    FeatureSettings features;
    SensorSettings sensor;
    NoiseSettings noise;
    TruthSettings truth;
    EdgeSettings edges;
    FilterSettings filter;
    FixedPath fixed_path = FixedPath::as_features;
    std::vector<Point> waypoints;                 ///< of the controller of that name, from (0, 0) on
    PlannerSettings planner;
    ArmSettings arms;
    PublishedSettings published;
};

/// One arm of a study: a controller and an estimator.
struct Arm {
    Controller controller = Controller::fixed;
    Estimator estimator = Estimator::ekf;
    int planner = -1;                             ///< of ArmSettings::planners, in place of the controller; -1: none
    friend bool operator==(const Arm&, const Arm&) = default;
};

inline constexpr int largest_feature_count = 64;
inline constexpr int largest_pose_count = 100000;
inline constexpr int largest_waypoint_count = 1000;
inline constexpr int largest_horizon = 8;
/// The largest number of sequences of candidates that a horizon may have: each step of each trial evaluates all of
/// them.
inline constexpr double largest_sequence_count = 1e7;

/// The scenario with every default that depends on another key filled in: the planner's grid, the estimators, the edge
/// list. Scenarios are shown, hashed and stored in this form.
DeformableSettings resolved(DeformableSettings scenario);

/// Throws InputError naming the key where keys contradict each other or make S or P singular [docs/model.md, What is
/// refused].
/// Ranges of single keys are checked when they are set.
void validate(const DeformableSettings& scenario);

/// Whether a key is one of a planner of one's own: planner.NAME.key [credence/planner.hpp].
bool is_planner_key(const std::string& key);
/// The value of such a key as a scenario keeps it. Throws InputError where the planner is there and has no such key, or
/// the value is out of its range.
std::string planner_value(const std::string& key, const std::string& value);

/// Whether the scenario has an arm of this controller.
bool has_arm(const DeformableSettings& scenario, Controller controller);

/// Arms of a resolved scenario, controllers and then planners outer, estimators inner.
std::vector<Arm> arms_of(const DeformableSettings& scenario);

/// `controller.estimator`, such as `greedy.ekf`, of an arm of the scenario.
std::string arm_name(const DeformableSettings& scenario, const Arm& arm);

/// The number of features, M.
int feature_count(const DeformableSettings& scenario);

/// The edge list of a scenario in graph order: for `all`, a outer and b inner, a < b.
std::vector<Edge> edge_list(const DeformableSettings& scenario);

/// The planners' candidates at each pose, of a resolved scenario [docs/model.md, Controllers].
int candidate_count(const DeformableSettings& scenario);

/// Whether a controller plans: whether it evaluates the planners' candidates.
constexpr bool plans(Controller controller) {
    return controller == Controller::greedy || controller == Controller::horizon;
}

/// The path along which the robot is steered: control.path, or the features' own.
Path robot_path(const DeformableSettings& scenario);

/// Dimension of the robot's pose (3 or 2) and of the state, pose + 2M.
int pose_size(const DeformableSettings& scenario);
int state_size(const DeformableSettings& scenario);

}  // namespace credence
