// The world `explore`: its scenario, its walls, its trials on every target, and the deformable world within it. Its
// equations are written a second time in tests/oracle/explore_oracle.py.

#include <credence/detail/block.hpp>
#include <credence/error.hpp>
#include <credence/ini.hpp>
#include "slam/estimators/estimators.hpp"
#include "worlds/deformable/deformable.hpp"
#include "worlds/explore/explore.hpp"
#include "worlds/explore/single_workspace.hpp"

#include "catch.hpp"
#include "support.hpp"

#include <random>

namespace credence::test::explore_test {

using Catch::Contains;

namespace {

Scenario explore(const std::string& lines) {
    return read_scenario_text("[scenario]\nworld = explore\n" + lines, "test", "test");
}

std::string refusal_of(const std::string& lines) {
    return refusal([&] { explore(lines); });
}

/// Rooms with a narrow view, in which everything happens.
ExploreSettings rooms() {
    ExploreSettings s;
    s.poses = 21;
    s.walls = {{{-2, 1}, {2, 1}}, {{2, 1}, {2, -3}}, {{-2, -1.5}, {0.5, -1.5}}};
    s.features.extent = 8;
    s.features.count = 9;
    s.sensor.range_max = 3;
    s.sensor.detection = 0.8;
    s.view = 2.5;
    s.noise.odometry = 0.1;
    s.box = {{-4, -4}, {4, 4}};
    s.coverage = 0.05;
    s.features.step = 1;
    s.explorers = {Explorer::fixed,  Explorer::random,  Explorer::frontier,
                   Explorer::greedy, Explorer::horizon, Explorer::informed};
    s.arms.estimators = std::vector{Estimator::ekf, Estimator::fej, Estimator::riekf};
    return resolved(s);
}

/// Watches nothing.
struct Unobserved {
    void started(const auto&...) {}
    void priced(const auto&...) {}
    void predicted(const auto&...) {}
    void updated(const auto&...) {}
    void explored(const auto&...) {}
};

}  // namespace

TEST_CASE("explore: a scenario names its world, and its text reads back as the same") {
    const std::string lines = "[walls]\nsegments = 1 1 2 1, 2 1 2 3\n[robot]\nradius = 0.3\n[landmarks]\nmap = prior\n"
                              "[sensor]\nview = 2\n[noise]\nof = report\n[map]\nbox = -1 -1, 3 2\ncell = 0.5\n"
                              "[planner]\ncoverage = 0.1\n[arms]\ncontrollers = informed, frontier, greedy\n";
    const Scenario declared = explore(lines);
    CHECK(declared.arms == std::vector<std::string>{"informed.ekf", "frontier.ekf", "greedy.ekf"});
    CHECK(declared.baselines == std::vector<std::string>{"greedy.ekf", "", ""});
    CHECK(declared.components.size() == 3 + 2 * 20);
    CHECK(declared.groups.size() == 5 + 20);
    const Scenario again = read_scenario_text(scenario_text(declared), "test", "other");
    CHECK(again.settings == declared.settings);
    CHECK(again.arms == declared.arms);
    CHECK(explore("").groups.size() == 5);  // landmarks that may be absent are judged together alone
    for (const DescribedKey& key : find_world("explore")->keys()) CHECK(!key.help.empty());
}

TEST_CASE("explore: nonsense is refused with its line") {
    CHECK_THAT(refusal_of("[features]\npath = circle\n"), Contains("unknown key features.path"));
    CHECK_THAT(refusal_of("[walls]\nsegments = 1 1 2\n"), Contains("test:4: invalid walls.segments=1 1 2 ('1 1 2' is"));
    CHECK_THAT(refusal_of("[walls]\nsegments = 1 1 1 1\n"), Contains("has no length"));
    CHECK_THAT(refusal_of("[walls]\nsegments = 0 -1 0.1 1\n"), Contains("the robot starts at 0 0, nearer to the wall"));
    CHECK_THAT(refusal_of("[robot]\nradius = 0\n"), Contains("must be above 0"));
    CHECK_THAT(refusal_of("[map]\nbox = 1 1, 0 2\n"), Contains("it is no box"));
    CHECK_THAT(refusal_of("[map]\ncell = 1e-3\n"), Contains("such cells"));
    CHECK_THAT(refusal_of("[sensor]\nview = 0\n"), Contains("must be above 0"));
    CHECK_THAT(refusal_of("[control]\nwaypoints = none\n"), Contains("there are no waypoints for fixed"));
    CHECK(refusal_of("[control]\npath = circle\nwaypoints = none\n").empty());
    CHECK_THAT(refusal_of("[arms]\ncontrollers = greedy, greedy\n"), Contains("greedy is given twice"));
    CHECK_THAT(refusal_of("[arms]\ncontrollers = nearest\n"), Contains("not one of its choices"));
    CHECK_THAT(refusal_of("[arms]\nestimators = kf\n"), Contains("kf has no heading"));
    CHECK_THAT(refusal_of("[landmarks]\nprior = 1e-150\n"), Contains("singular"));
    CHECK(refusal_of("[arms]\ncontrollers = greedy\n[control]\nwaypoints = none\n").empty());
}

TEST_CASE("explore: a motion ends where the radius meets the wall, and not before") {
    std::mt19937_64 rng(5);
    std::uniform_real_distribution<double> number(-2, 2);
    int stopped = 0;
    for (int i = 0; i < 20000; ++i) {
        const WallLine wall = line_of({{number(rng), number(rng)}, {number(rng), number(rng)}});
        const Vector2<double> place{number(rng), number(rng)}, move{2 * number(rng), 2 * number(rng)};
        const double radius = 0.05 + absolute(number(rng)) / 4, start = distance(wall, {place.x, place.y});
        const double share = free_share(wall, radius, place, move);
        const auto after = [&](double part) {
            return distance(wall, {place.x + part * move.x, place.y + part * move.y});
        };
        stopped += share < 1;
        if (start < radius) {  // a start that is too near: never nearer
            CHECK((share == 0 || after(1e-6) >= start));
            continue;
        }
        for (int part = 0; part <= 20; ++part) CHECK(after(share * part / 20) >= radius - 1e-12);
        if (share < 1) CHECK(after(share) <= radius + 1e-9 * squared_norm(move));  // where it grazes: a root of rounding
        CHECK_FALSE((share < 1 && hides(wall, place, scaled(share, move))));
    }
    CHECK(stopped > 4000);
}

TEST_CASE("explore: what a wall hides is behind it") {
    const WallLine wall = line_of({{1, -1}, {1, 1}});
    const Vector2<double> eye{0, 0};
    CHECK(hides<double>(wall, eye, {2, 0}));
    CHECK(hides<double>(wall, eye, {1 + 1e-6, 1 + 1e-6}));  // by its end
    CHECK_FALSE(hides<double>(wall, eye, {2, 2.01}));
    CHECK_FALSE(hides<double>(wall, eye, {0.9, 0}));
    CHECK_FALSE(hides<double>(wall, eye, {-2, 0}));
    CHECK_FALSE(hides<double>(wall, eye, {1, 0.5}));  // on it
    CHECK_FALSE(hides<double>(wall, {1, -3}, {0, 6}));  // along it
}

TEST_CASE("explore: a block is its trials one by one, on every target") {
    const ExploreSettings settings = rooms();
    const Scenario scenario = scenario_of(settings);
    const std::vector<Column> columns = find_world("explore")->columns(scenario);
    REQUIRE(columns.size() == explore_column_count);
    const ExploreProblem problem(settings);
    const ExploreView& view = problem.view();
    CHECK(find_world("explore")->all_series(scenario).size() == static_cast<std::size_t>(view.series_count));
    constexpr int trials = 11;
    for (const Target& target : runnable_targets()) {
        CAPTURE(target.name);
        const Block block =
            run_block(ExploreSimulation(settings, target), columns, scenario.arms.size(), 5, 1, trials);
        for (std::size_t a = 0; a < scenario.arms.size(); ++a)
            with_estimator<Process::heading>(arms_of(settings)[a].estimator, [&](auto tag) {
                CAPTURE(scenario.arms[a]);
                using Estimating = typename decltype(tag)::template type<ExploreLayout, double>;
                const auto work = std::make_unique<SingleWorkspace<Estimating>>(view);
                Unobserved nothing;
                for (int trial = 0; trial < trials; ++trial) {
                    double own[explore_column_count];
                    std::vector<double> figures(static_cast<std::size_t>(view.series_count * (view.poses - 1)));
                    run_trial(view, arms_of(settings)[a].controller,
                              KeyedDraws<double>(5, static_cast<std::uint64_t>(block_size + trial), infinity), nothing,
                              *work, own, figures.data());
                    for (std::size_t c = 0; c < explore_column_count; ++c)
                        CHECK(same_bits(own[c], block.arms[a].columns[c * trials + static_cast<std::size_t>(trial)]));
                }
            });
    }
}

TEST_CASE("explore: without walls and with landmarks that are known it is the deformable world") {
    DeformableSettings static_case;
    static_case.features.path = Path::still;
    static_case.features.placement = Placement::ring;
    static_case.features.count = 4;
    static_case.noise.walk = static_case.noise.deformation = 0;
    static_case.noise.heading = 0.02;
    static_case.noise.initial_position = 0.1;
    static_case.edges.graph = EdgeGraph::none;
    static_case.sensor.noise = RangeNoise::ranged;
    static_case.filter.covariance = 1.5;
    static_case.waypoints = {{3, 0}, {3, 3}};
    static_case.planner.turns = std::vector{-0.7, 0.0, 0.7};
    static_case.arms.estimators = std::vector{Estimator::ekf, Estimator::fej};
    const Criterion criterion = GENERATE(Criterion::trace, Criterion::log_det, Criterion::pose_trace);
    CAPTURE(static_cast<int>(criterion));
    static_case.planner.criterion = criterion;
    ExploreSettings settings;
    static_cast<DeformableSettings&>(settings) = static_case;
    settings.map = LandmarkMap::known;
    settings.explorers = {Explorer::fixed, Explorer::random, Explorer::greedy};
    static_case.arms.controllers = {Controller::waypoints, Controller::random, Controller::greedy};
    validate(static_case);
    static_case = resolved(static_case);
    settings = resolved(settings);
    constexpr int trials = 20;
    const Problem problem(static_case);
    const Block expected = run_block(problem, 3, 0, trials);
    const Block found =
        run_block(ExploreSimulation(settings), find_world("explore")->columns(scenario_of(settings)), 6, 3, 0, trials);
    for (std::size_t a = 0; a < 6; ++a)
        for (std::size_t c = 0; c < column_status; ++c)
            for (std::size_t trial = 0; trial < trials; ++trial) {
                CAPTURE(a, c, trial);
                const std::size_t at = c * trials + trial;
                CHECK(same_bits(found.arms[a].columns[at], expected.arms[a].columns[at]));
            }
}

TEST_CASE("explore: NEES of a state that grows are those of what is there", "[long]") {
    // With exact motion and next to no heading noise the filter is nearly linear: NEES/d is 1 at every step, however
    // few landmarks are in the state, and coverage is that of d; a false alarm in 10^4.
    ExploreSettings settings;
    settings.poses = 31;
    settings.noise.heading = 1e-4;
    settings.features.extent = 12;
    settings.explorers = {Explorer::fixed};
    settings = resolved(settings);
    const Scenario scenario = scenario_of(settings);
    const ExploreProblem problem(settings);
    constexpr int trials = 256, blocks = 8, steps = 30;
    const ExploreSimulation simulation(settings);
    const std::vector<Column> columns = find_world("explore")->columns(scenario);
    double ratio = 0, squared = 0, covered = 0, discovered = 0;
    for (int index = 0; index < blocks; ++index) {
        const ArmBlock arm = run_block(simulation, columns, 1, 7, index, trials).arms.front();
        for (std::size_t trial = 0; trial < trials; ++trial) {
            const double own = arm.columns[column_nees_ratio * trials + trial];
            ratio += own, squared += own * own;
            discovered += arm.columns[column_discovered * trials + trial];
        }
        for (std::size_t k = 0; k < steps; ++k) covered += arm.covered[k * coverage_level_count];  // below the median
        // Those that have found all 20 are in the distribution of the whole state.
        CHECK(std::ranges::count(arm.cells, no_cell) > steps * trials / 2);
    }
    const double count = trials * blocks, mean = ratio / count;
    CHECK(absolute(mean - 1) < 4 * std::sqrt((squared / count - mean * mean) / count));
    CHECK(discovered / count > 5);
    CHECK(discovered / count < 18);
    // Steps of a trial depend on each other: as if it had two of its own.
    CHECK(absolute(covered / count / steps - 0.5) < 4 * std::sqrt(0.25 / (2 * count)));
}

TEST_CASE("explore: the control chosen is the least of the costs, at hard parameters", "[long]") {
    /// Plans again after each step, and compares the choice with every candidate's cost by the update itself.
    struct Watcher : Unobserved {
        const ExploreView& view;
        int planned = 0;

        void explored(int k, ExploreWorkspace<double, KalmanFilter<ExploreLayout, double>>& work) {
            if (k + 1 >= view.poses) return;
            const ExploreLayout layout(view.features, view.group_count);
            const bool informed = k % 2 == 0;
            ExplorePlanner planner(view, informed, work.belief, work.truth, layout, k + 1, work);
            double least = infinity, most = 0, taken = infinity;
            std::vector<std::pair<Control, double>> priced;
            planner.choose_plainly(0, [&](int i, double cost, bool allowed) {
                if (!allowed) return;
                least = std::fmin(least, cost), most = std::fmax(most, absolute(cost));
                priced.push_back({view.control.candidates[i], cost});
            });
            const Command<double> command = planner.choose([](auto&&...) {});
            for (const auto& [candidate, cost] : priced)
                if (candidate == Control{command.turn, {command.move.x, command.move.y}}) taken = cost;
            if (priced.empty()) {
                CHECK((command.turn == 0 && command.move.x == 0 && command.move.y == 0));
                return;
            }
            ++planned;
            CHECK(taken - least <= 1e-8 * (view.coverage > 0 ? most : absolute(least)));
        }
    };
    int planned = 0;
    for (const double heading : {1e-3, 0.05, 0.3})
        for (const double sigma : {1e-4, 0.1, 10.0})
            for (const auto& [coverage, criterion] : {std::pair{0.0, Criterion::trace}, {0.01, Criterion::trace},
                                                      {0.0, Criterion::log_det}, {0.5, Criterion::log_det}}) {
                CAPTURE(heading, sigma, coverage, static_cast<int>(criterion));
                ExploreSettings settings = rooms();
                settings.planner.criterion = criterion;
                settings.noise.heading = heading;
                settings.sensor.sigma = sigma;
                settings.coverage = coverage;
                settings.poses = 60;
                const ExploreProblem problem(settings);
                const ExploreView& view = problem.view();
                const auto work = std::make_unique<SingleWorkspace<KalmanFilter<ExploreLayout, double>>>(view);
                Watcher watcher{{}, view};
                double columns[explore_column_count];
                std::vector<double> figures(static_cast<std::size_t>(view.series_count * (view.poses - 1)));
                for (std::uint64_t trial = 0; trial < 50; ++trial)
                    run_trial(view, Explorer::greedy, KeyedDraws<double>(3, trial, infinity), watcher, *work, columns,
                              figures.data());
                planned += watcher.planned;
            }
    CHECK(planned > 100000);
}

}  // namespace credence::test::explore_test
