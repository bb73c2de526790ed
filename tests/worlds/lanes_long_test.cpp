// Users' worlds in lanes beside the same worlds one trial at a time, in every target that this processor runs.

#include "catch.hpp"

#include "../../experiments/own_filter/tracker.hpp"
#include "lane_worlds.hpp"
#include "oracle/own_simulation.hpp"

#include <credence/detail/block.hpp>
#include <credence/ini.hpp>
#include <credence/detail/trajectory.hpp>
#include "worlds/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

namespace credence::test::lanes_long_test {

/// One whose header names it, and which the program has no object for.
struct Forgotten : Tracker {
    static constexpr const char* name = "forgotten";
};

}  // namespace credence::test::lanes_long_test

template <>
inline constexpr bool credence::only_in_lanes<credence::test::lanes_long_test::Forgotten> = true;

namespace credence::test::lanes_long_test {

namespace {

const bool added = [] {
    add_own_world<Tracker>();
    add_own_world<Troubled>();
    add_own_world<WideOf<9>>();
    add_own_world<WideOf<48>>();
    add_own_world<WideOf<132>>();
    add_own_world<Forgotten>();
    return true;
}();

/// The target that runs as long as this lives.
class Forced {
public:
    explicit Forced(const std::string& target) { setenv(force_target_variable, target.c_str(), 1); }
    ~Forced() { unsetenv(force_target_variable); }
    Forced(const Forced&) = delete;
    Forced& operator=(const Forced&) = delete;
};

template <class W>
OwnReport report_of(const typename W::Settings& settings) {
    return {W::columns(settings), W::innovation_rows(settings)};
}

/// The world's function for one trial.
template <class W>
auto one_trial(const typename W::Settings& settings) {
    return [settings](OwnTrial& trial) {
        OwnTrialOf<double> one(trial);
        W::run(settings, one);
    };
}

/// The same trials one at a time: the oracle.
template <class W>
std::unique_ptr<const Simulation> oracle(const Scenario& scenario, const typename W::Settings& settings) {
    return one_at_a_time_simulation(scenario, report_of<W>(settings), one_trial<W>(settings));
}

template <class W>
Block block_of(const Simulation& simulation, const Scenario& scenario, const typename W::Settings& settings,
               int trials) {
    return run_block(simulation, own_columns(scenario, report_of<W>(settings)), scenario.arms.size(), 7, 0, trials);
}
template <class W>
Block one_at_a_time(const Scenario& scenario, const typename W::Settings& settings, int trials) {
    return block_of<W>(*oracle<W>(scenario, settings), scenario, settings, trials);
}
/// As where the world's function is no template: one trial after the other, evaluated in lanes.
template <class W>
Block one_by_one(const Scenario& scenario, const typename W::Settings& settings, const std::string& target,
                 int trials) {
    const Forced forced(target);
    return block_of<W>(*own_simulation(scenario, report_of<W>(settings), one_trial<W>(settings)), scenario, settings,
                       trials);
}

Block in_lanes(const Scenario& scenario, const std::string& target, int trials) {
    const Forced forced(target);
    return BlockRunner(world_of(scenario), scenario).run(7, 0, trials);
}

Scenario of_world(const std::string& world) {
    return read_scenario_text("[scenario]\nworld = " + world + "\nposes = 50\n", "test", "mine");
}

Scenario troubled(const Troubled::Settings& s, int poses) {
    const auto set = [](const char* key, auto value) {
        return std::pair{std::string("state.") + key, std::to_string(value)};
    };
    return read_scenario_text("[scenario]\nworld = troubled\nposes = " + std::to_string(poses) + "\n", "test", "mine",
                              {set("size", s.state), set("rows", s.rows), set("spread", s.spread),
                               set("trouble", s.trouble), set("groups", s.groups), set("mistake", s.mistake)});
}

/// Number of values that differ by more than a tolerance, relative to the larger of their scale and themselves.
template <class Numbers>
int differing(const Numbers& a, const Numbers& b, double tolerance, double scale = 0) {
    if (a.size() != b.size()) return -1;
    int count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double x = a[i], y = b[i];
        const bool equal = x == y || (std::isnan(x) && std::isnan(y)) ||
                           std::abs(x - y) <= tolerance * std::max({std::abs(x), std::abs(y), scale});
        count += !equal;
    }
    return count;
}

/// Sum of one series over its steps.
double sum_of(const std::vector<double>& sums, std::size_t series, std::size_t steps) {
    double sum = 0;
    for (std::size_t k = series * steps; k < (series + 1) * steps && k < sums.size(); ++k) sum += std::abs(sums[k]);
    return sum;
}

/// How the trials ended is the same, and so is every number but for rounding.
void check_same(const Block& lanes, const Block& one, const Scenario& scenario, double tolerance) {
    const std::vector<Column> columns = world_of(scenario).columns(scenario);
    const SimulationShape shape = simulation_of(scenario)->shape();
    const auto trials = static_cast<std::ptrdiff_t>(one.trials);
    const auto status = static_cast<std::ptrdiff_t>(status_column(columns));
    REQUIRE(lanes.arms.size() == one.arms.size());
    for (std::size_t a = 0; a < one.arms.size(); ++a) {
        const ArmBlock &x = lanes.arms[a], &y = one.arms[a];
        REQUIRE(x.counted == y.counted);
        const auto endings = [&](const ArmBlock& arm) {
            return std::vector<double>(arm.columns.begin() + status * trials, arm.columns.end());
        };
        REQUIRE(endings(x) == endings(y));
        if (tolerance > 1e-3) continue;
        CHECK(differing(x.columns, y.columns, tolerance) == 0);
        CHECK(differing(x.sums, y.sums, tolerance, 1) == 0);  // sums of signed numbers may cancel
        CHECK(differing(x.square_sums, y.square_sums, tolerance) == 0);
        CHECK(differing(x.run_square_sums, y.run_square_sums, tolerance, 1) == 0);
        // Of two whitened rows, the product is at most the mean of the squares, whose sum is the NIS.
        const auto groups = static_cast<std::size_t>(shape.group_count),
                   steps = static_cast<std::size_t>(shape.poses - 1);
        const double nis = sum_of(y.sums, groups, steps);
        CHECK(differing(x.product_sums, y.product_sums, tolerance, nis) == 0);
        CHECK(differing(x.product_square_sums, y.product_square_sums, tolerance, nis * nis) == 0);
        CHECK(x.product_counts == y.product_counts);
        CHECK(differing(x.errors, y.errors, 1e-12) == 0);
        CHECK(differing(x.moments, y.moments, tolerance, static_cast<double>(shape.poses)) == 0);
        CHECK(differing(x.nees, y.nees, 1.2e-7 + tolerance) == 0);  // neighbours in single precision
        if (tolerance > 1e-9) continue;  // beyond, a number may come to lie on the other side of a bound
        CHECK(x.covered == y.covered);
        CHECK(x.cells == y.cells);
    }
}

bool same_bits(const Block& a, const Block& b) {
    const auto same = [](const auto& x, const auto& y) {
        return x.size() == y.size() && std::equal(x.begin(), x.end(), y.begin(), [](auto u, auto v) {
                   return u == v || (u != u && v != v);
               });
    };
    bool all = a.arms.size() == b.arms.size();
    for (std::size_t i = 0; all && i < a.arms.size(); ++i) {
        const ArmBlock &x = a.arms[i], &y = b.arms[i];
        all = same(x.columns, y.columns) && same(x.sums, y.sums) && same(x.square_sums, y.square_sums) &&
              same(x.run_square_sums, y.run_square_sums) && x.covered == y.covered && x.cells == y.cells &&
              same(x.diverged.sums, y.diverged.sums) && same(x.diverged.square_sums, y.diverged.square_sums) &&
              same(x.errors, y.errors) && same(x.nees, y.nees) && same(x.moments, y.moments) &&
              same(x.product_sums, y.product_sums) && same(x.product_square_sums, y.product_square_sums) &&
              same(x.product_counts, y.product_counts);
    }
    return all;
}

std::vector<std::string> target_names() {
    std::vector<std::string> names;
    for (const Target& target : runnable_targets()) names.push_back(target.name);
    return names;
}

/// A random scenario; hard ones have covariances that are singular but for rounding, and trouble in many trials.
Troubled::Settings random_settings(std::mt19937& random) {
    const auto from = [&](auto... choices) {
        const std::vector<double> all{static_cast<double>(choices)...};
        return all[random() % all.size()];
    };
    Troubled::Settings s;
    s.state = static_cast<int>(from(1, 2, 3, 4, 5, 6));
    s.rows = static_cast<int>(from(0, 1, 2, 3, 6));
    s.spread = from(0, 0.5, 2, 6, 12, 17, 20, 40);
    s.trouble = from(0, 0, 0.01, 0.1, 0.5, 1);
    s.groups = static_cast<int>(from(0, 1, 2, 3, 4));
    return s;
}

}  // namespace

TEST_CASE("lanes: random scenarios have the trials, statuses and statistics of one trial at a time") {
    REQUIRE(added);
    std::mt19937 random(1);
    const std::vector<std::string> targets = target_names();
    for (int sample = 0; sample < 1500; ++sample) {
        const Troubled::Settings s = random_settings(random);
        const int poses = 2 + static_cast<int>(random() % 13), trials = 1 + static_cast<int>(random() % 40);
        const std::string& target = targets[random() % targets.size()];
        CAPTURE(sample, s.state, s.rows, s.spread, s.trouble, s.groups, poses, trials, target);
        const Scenario scenario = troubled(s, poses);
        // A NEES is as well conditioned as its covariance, whose columns shrink by up to e^-spread.
        const double tolerance = 1e-12 * std::exp(2 * s.spread);
        const Block expected = one_at_a_time<Troubled>(scenario, s, trials);
        check_same(in_lanes(scenario, target, trials), expected, scenario, tolerance);
        check_same(one_by_one<Troubled>(scenario, s, target, trials), expected, scenario, tolerance);
    }
}

TEST_CASE("lanes: a world that is no template has the same bits in every target") {
    std::mt19937 random(3);
    const std::vector<std::string> targets = target_names();
    for (int sample = 0; sample < 50; ++sample) {
        const Troubled::Settings s = random_settings(random);
        const Scenario scenario = troubled(s, 9);
        const int trials = 1 + static_cast<int>(random() % 40);
        const Block first = one_by_one<Troubled>(scenario, s, targets.front(), trials);
        for (const std::string& target : targets)
            CHECK(same_bits(first, one_by_one<Troubled>(scenario, s, target, trials)));
    }
}

TEMPLATE_TEST_CASE("lanes: a state that is too large for Eigen's stack is judged as any other", "", WideOf<48>,
                   WideOf<132>) {
    const Scenario scenario =
        read_scenario_text("[scenario]\nworld = " + std::string(TestType::name) + "\nposes = 3\n", "test", "mine");
    const Block one = one_at_a_time<TestType>(scenario, {}, 9);
    for (const std::string& target : target_names()) {
        CAPTURE(target);
        check_same(in_lanes(scenario, target, 9), one, scenario, 1e-12);
    }
}

TEMPLATE_TEST_CASE("lanes: a filter is that of one trial at a time, to 1e-12", "", Tracker, WideOf<9>) {
    const Scenario scenario = of_world(TestType::name);
    const Block one = one_at_a_time<TestType>(scenario, {}, 256);
    for (const std::string& target : target_names())
        check_same(in_lanes(scenario, target, 256), one, scenario, 1e-12);
    check_same(one_by_one<TestType>(scenario, {}, target_names().front(), 256), one, scenario, 1e-12);
}

TEST_CASE("lanes: every target gives the same bits") {
    const std::vector<std::string> targets = target_names();
    const auto all_same = [&](const Scenario& scenario, int trials) {
        const Block first = in_lanes(scenario, targets.front(), trials);
        for (const std::string& target : targets) CHECK(same_bits(first, in_lanes(scenario, target, trials)));
    };
    for (const char* world : {"tracker", "wide"}) all_same(of_world(world), 256);
    std::mt19937 random(2);
    for (int sample = 0; sample < 100; ++sample) {
        const Troubled::Settings s = random_settings(random);
        CAPTURE(sample, s.state, s.rows, s.spread, s.trouble, s.groups);
        all_same(troubled(s, 9), 1 + static_cast<int>(random() % 40));
    }
}

TEST_CASE("lanes: what P counts has the same bits in every target, and is to 1e-12 that of one trial at a time") {
    const Scenario scenario = read_scenario_text(
        "[scenario]\nworld = tracker\nposes = 12\n[draws]\nerrors = mean\n", "test", "mine");
    OwnReport report = report_of<Tracker>({});
    report.budget.errors = KeptErrors::mean;
    report.sources.assign(std::begin(Tracker::sources), std::end(Tracker::sources));
    for (std::size_t arm = 0; arm < 2; ++arm) {
        const CountedVariances one = own_simulation(scenario, report, one_trial<Tracker>({}))->counted(arm, 1, 20);
        CHECK(one.trials == 20);
        std::vector<std::vector<double>> first;
        for (const std::string& target : target_names()) {
            const Forced forced(target);
            const CountedVariances counted = simulation_of(scenario)->counted(arm, 1, 20);
            CHECK(counted.sources == one.sources);
            if (first.empty()) first = counted.variance;
            CHECK(counted.variance == first);
            for (std::size_t s = 0; s < first.size(); ++s)
                for (std::size_t j = 0; j < 4; ++j)
                    CHECK(counted.variance[s][j] == Approx(one.variance[s][j]).epsilon(1e-12).margin(1e-12));
        }
    }
}

TEST_CASE("lanes: trouble of every kind occurs among the random scenarios, as does a pack of which all trials fail") {
    Troubled::Settings s;
    s.trouble = 0.3;
    const Scenario scenario = troubled(s, 9);
    const std::size_t status = status_column(own_columns(scenario, report_of<Troubled>(s)));
    const ArmBlock arm = in_lanes(scenario, target_names().front(), 256).arms[0];
    std::vector<int> endings(4);
    for (std::size_t trial = 0; trial < 256; ++trial)
        ++endings[static_cast<std::size_t>(arm.columns[status * 256 + trial])];
    for (const int count : endings) CHECK(count > 5);
    s.trouble = 1;
    CHECK(in_lanes(troubled(s, 12), target_names().front(), 256).arms[0].counted < 16);
}

TEST_CASE("lanes: a trial that is run again has the bits of its batch, and the trajectory of one trial at a time") {
    Troubled::Settings s;
    s.trouble = 0.2;
    const Scenario scenario = troubled(s, 9);
    const auto one = oracle<Troubled>(scenario, s);
    for (const std::string& target : target_names()) {
        const Block block = in_lanes(scenario, target, 40);
        const Forced forced(target);
        for (std::size_t trial = 0; trial < 40; ++trial) {
            CAPTURE(target, trial);
            const Trajectory lane = replay_trial(scenario, 1, 7, static_cast<std::int64_t>(trial));
            const Trajectory expected = one->replay(scenario, 1, 7, static_cast<std::int64_t>(trial));
            for (std::size_t c = 0; c < lane.columns.size(); ++c) {
                const double in_block = block.arms[1].columns[c * 40 + trial], again = lane.column_values[c];
                CHECK((again == in_block || (std::isnan(again) && std::isnan(in_block))));
            }
            REQUIRE(lane.variables.size() == expected.variables.size());
            for (std::size_t v = 0; v < lane.variables.size(); ++v) {
                CAPTURE(lane.variables[v].name);
                CHECK(lane.variables[v].name == expected.variables[v].name);
                CHECK(differing(lane.variables[v].values, expected.variables[v].values, 1e-11) == 0);
            }
        }
    }
}

TEST_CASE("lanes: a world that the program has no objects for is refused where it could only run in lanes") {
    CHECK_THROWS_WITH(simulation_of(of_world("forgotten")),
                      "world forgotten: credence_add_world was not given its header");
}

TEST_CASE("lanes: what a world does wrong is said in the same words as of one trial at a time") {
    const auto message = [](const auto& run) {
        try {
            run();
        } catch (const std::logic_error& error) {
            return std::string(error.what());
        }
        return std::string("nothing");
    };
    for (int mistake = 1; mistake <= 8; ++mistake) {
        Troubled::Settings s;
        s.mistake = mistake;
        const Scenario scenario = troubled(s, 9);
        const std::string expected = message([&] { one_at_a_time<Troubled>(scenario, s, 5); });
        CHECK_THAT(expected, Catch::StartsWith("world troubled: "));
        for (const std::string& target : target_names())
            CHECK(message([&] { in_lanes(scenario, target, 5); }) == expected);
        for (const std::string& target : target_names())
            CHECK(message([&] { one_by_one<Troubled>(scenario, s, target, 5); }) == expected);
    }
}

}  // namespace credence::test::lanes_long_test
