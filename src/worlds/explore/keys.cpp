#include "worlds/explore/explore.hpp"

#include "worlds/values.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

/// The keys of the deformable world that mean the same here, in the order in which they are shown.
const std::vector<std::string>& shared_keys() {
    static const std::vector<std::string> names{
        "features.positions", "features.count", "features.placement", "features.extent", "features.radius_min",
        "features.radius_max", "sensor.range_min", "sensor.range_max", "sensor.noise", "sensor.sigma",
        "sensor.sigma_near", "sensor.sigma_far", "sensor.detection", "sensor.every", "noise.heading",
        "noise.odometry", "noise.initial_heading", "noise.initial_position", "noise.measurement_tails",
        "noise.degrees_of_freedom", "noise.outlier_share", "noise.outlier_scale", "noise.truncate", "filter.heading",
        "filter.odometry", "filter.measurement", "filter.covariance", "filter.gate", "control.waypoints",
        "planner.criterion", "planner.horizon", "planner.heading_weight", "planner.speeds", "planner.turns",
        "arms.estimators", "arms.planners"};
    return names;
}

/// A key of the deformable world as it is here.
ExploreKey shared_key(const DeformableKey& key) {
    ExploreKey shared{key.name, key.help, key.set, key.get, key.choices, false, key.sigma_unit, key.hidden};
    if (key.name == "control.waypoints")
        shared.help = "path of the controller fixed as `x y, x y`, from 0 0 on (length)";
    if (key.name == "arms.estimators") {
        shared.choices = estimators_for(Process::heading);
        shared.help = "any of " + joined(shared.choices) + "; default: ekf";
    }
    return shared;
}

/// `x y x y, x y x y`: the ends of each segment.
std::vector<WallSegment> parse_walls(const std::string& value) {
    std::vector<WallSegment> walls;
    if (value == "none") return walls;
    for (const std::string& segment : split_list(value)) {
        std::vector<double> ends;
        for (const std::string& number : split_list(segment, ' '))
            if (!number.empty())
                ends.push_back(parse_real("walls.segments", number, between(-largest_value, largest_value)));
        if (ends.size() != 4)
            throw invalid_value("walls.segments", value, "'" + segment + "' is not a segment",
                                "Write its ends as `x y x y`, and segments separated by commas, such as "
                                "`0 1 4 1, 4 1 4 5`");
        walls.push_back({{ends[0], ends[1]}, {ends[2], ends[3]}});
    }
    if (walls.empty() || walls.size() > largest_wall_count)
        throw invalid_value("walls.segments", value, std::to_string(walls.size()) + " segments",
                            "Give none, or 1 to " + std::to_string(largest_wall_count));
    return walls;
}

std::string walls_text(const std::vector<WallSegment>& walls) {
    std::vector<std::string> parts;
    for (const auto& [from, to] : walls) parts.push_back(positions_text({from}) + " " + positions_text({to}));
    return parts.empty() ? "none" : joined(parts);
}

/// The keys that only this world has.
std::vector<ExploreKey> own_keys() {
    const auto real = [](const char* name, const char* help, const ValueRange& range, auto field) {
        return real_key<ExploreSettings>(name, help, range, field);
    };
    return {
        {"walls.segments", "none, or the ends of each as `x y x y, x y x y` (length)",
         [](ExploreSettings& s, const std::string& v) { s.walls = parse_walls(v); },
         [](const ExploreSettings& s) { return walls_text(s.walls); }, {"none"}},
        real("robot.radius", "what the robot's centre keeps from a wall (length)", above(0),
             [](auto& s) -> auto& { return s.radius; }),
        real("robot.step", "d, what the robot moves a step along its path (length)", above(0),
             [](auto& s) -> auto& { return s.features.step; }),
        real_key<ExploreSettings>("robot.turn", "delta, turn per step on the circle", between(-3.2, 3.2),
                                  [](auto& s) -> auto& { return s.features.turn; }, "rad"),
        choice_key<LandmarkMap, ExploreSettings>("landmarks.map", {"none", "prior", "known"},
                                                 [](auto& s) -> auto& { return s.map; }),
        real("landmarks.prior", "sigma of each axis of a landmark before it is seen (length)", above(0),
             [](auto& s) -> auto& { return s.prior; }),
        real("sensor.view", "full angle of the view, about the heading (rad); 2 pi or more for all round",
             {0, 7, false, false}, [](auto& s) -> auto& { return s.view; }),
        choice_key<MotionNoise, ExploreSettings>("noise.of", {"motion", "report"},
                                                 [](auto& s) -> auto& { return s.motion_noise; }),
        {"map.box", "the grid's lower left and upper right corner as `x y, x y` (length)",
         [](ExploreSettings& s, const std::string& v) {
             s.box = parse_points("map.box", v, 2);
             if (s.box.size() != 2 || !(s.box[0].x < s.box[1].x && s.box[0].y < s.box[1].y))
                 throw invalid_value("map.box", v, "it is no box",
                                     "Give its lower left and upper right corner, such as `-10 -10, 10 10`");
         },
         [](const ExploreSettings& s) { return positions_text(s.box); }},
        real("map.cell", "side of a cell of the grid (length)", above(0), [](auto& s) -> auto& { return s.cell; }),
        real("planner.coverage", "what a cell that comes into view is worth, in units of the cost", from(0),
             [](auto& s) -> auto& { return s.coverage; }),
        choice_key<FixedPath, ExploreSettings>("control.path", {"waypoints", "straight", "circle"},
                                               [](auto& s) -> auto& { return s.fixed_path; }),
        {"arms.controllers", "any of " + joined(explorer_names()),
         [](ExploreSettings& s, const std::string& v) {
             s.explorers = parse_names<Explorer>("arms.controllers", v, explorer_names());
         },
         [](const ExploreSettings& s) { return names_text(s.explorers, explorer_names()); }, explorer_names()}};
}

/// Sections in the order in which they are shown.
int rank(const ExploreKey& key) {
    static const std::vector<std::string> sections{"scenario", "walls", "robot",  "features", "landmarks", "sensor",
                                                   "noise",    "map",   "filter", "control",  "planner",   "arms"};
    const auto found = std::ranges::find(sections, key.name.substr(0, key.name.find('.')));
    return static_cast<int>(found - sections.begin());
}

std::vector<ExploreKey> all_keys() {
    std::vector<ExploreKey> keys;
    add_common_keys(keys);
    for (const std::string& name : shared_keys())
        keys.push_back(shared_key(*std::ranges::find(scenario_keys(), name, &DeformableKey::name)));
    for (ExploreKey& key : own_keys()) keys.push_back(std::move(key));
    std::ranges::stable_sort(keys, {}, rank);
    add_budget_keys(keys, slam_sources());
    return keys;
}

/// M where landmarks are drawn.
constexpr int default_count = 20;

bool has(const ExploreSettings& s, Explorer explorer) { return std::ranges::count(s.explorers, explorer) > 0; }

void check_walls(const ExploreSettings& s) {
    for (const WallSegment& wall : s.walls) {
        if (wall.from == wall.to)
            throw invalid_value("walls.segments", walls_text(s.walls), "'" + walls_text({wall}) + "' has no length",
                                "Give two ends that differ");
        if (distance(line_of(wall), {}) < s.radius)
            throw invalid_value("robot.radius", to_text(s.radius),
                                "the robot starts at 0 0, nearer to the wall '" + walls_text({wall}) + "'",
                                "Give a smaller radius, or move the wall");
    }
}

void check_grid(const ExploreSettings& s) {
    const CellGrid grid = grid_of(s);
    if (const std::int64_t cells = std::int64_t{grid.columns} * grid.rows; cells > largest_cell_count)
        throw invalid_value("map.cell", to_text(s.cell), "map.box has " + std::to_string(cells) + " such cells",
                            "Give a larger cell, for at most " + std::to_string(largest_cell_count));
}

}  // namespace

ExploreSettings::ExploreSettings() {
    length_unit = "m";
    poses = 101;
    features.placement = Placement::box;
    features.positions = {{0, 0}};
    features.extent = 20;
    features.path = Path::still;
    features.step = 0.5;
    features.turn = 0;
    sensor.range_min = 0;
    sensor.range_max = 5;
    sensor.sigma = 0.1;
    sensor.sigma_near = 0.02;
    sensor.sigma_far = 0.2;
    noise.heading = 0.01;
    noise.odometry = 0.02;
    noise.walk = noise.deformation = 0;
    edges.graph = EdgeGraph::none;
    waypoints = {{5, 0}, {5, 5}, {-5, 5}, {-5, -5}, {5, -5}, {5, 0}};
    planner.speeds = 5;
    planner.turns = std::vector<double>{-0.8, 0, 0.8};
}

const std::vector<std::string>& explorer_names() {
    static const std::vector<std::string> names{"fixed", "random", "frontier", "greedy", "horizon", "informed"};
    return names;
}

const std::vector<ExploreKey>& explore_keys() {
    static const std::vector<ExploreKey> keys = all_keys();
    return keys;
}

ExploreSettings resolved(const ExploreSettings& settings) {
    if (has(settings, Explorer::fixed) && settings.fixed_path == FixedPath::as_features && settings.waypoints.empty())
        throw invalid_value("arms.controllers", names_text(settings.explorers, explorer_names()),
                            "there are no waypoints for fixed", "Give control.waypoints or another control.path");
    if (!has_variance(settings.prior))
        throw invalid_value("landmarks.prior", to_text(settings.prior), "its square is 0 and P singular",
                            "Give a standard deviation " + above_least);
    for (const Estimator estimator : settings.arms.estimators.value_or(std::vector<Estimator>{}))
        if (process_of(estimator) != Process::heading)
            throw invalid_value("arms.estimators", names_text(*settings.arms.estimators, estimator_names()),
                                estimator_names()[static_cast<std::size_t>(estimator)] + " has no heading",
                                "Give some of " + joined(estimators_for(Process::heading)));
    check_walls(settings);
    check_grid(settings);
    DeformableSettings shared = settings;
    if (shared.features.placement != Placement::given && !shared.features.count) shared.features.count = default_count;
    shared.arms.controllers = {has(settings, Explorer::horizon) ? Controller::horizon : Controller::fixed};
    shared.waypoints.clear();
    validate(shared);
    ExploreSettings resolved = settings;
    static_cast<DeformableSettings&>(resolved) = credence::resolved(shared);
    resolved.waypoints = settings.waypoints;
    return resolved;
}

}  // namespace credence
