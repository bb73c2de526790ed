// Draws and columns of users' worlds: which keys there are, and what is said of others.

#include "catch.hpp"
#include "own_study.hpp"

#include <credence/detail/draws.hpp>
#include <credence/ini.hpp>
#include <credence/own_world.hpp>

#include <limits>
#include <set>

namespace credence::test::own_draws_test {

using test::run;

namespace {

/// Asks for one draw of each kind, under the key that its settings name.
struct Keyed {
    struct Settings {
        int source = 0, pose = 0, index = 0;
    };
    static constexpr const char* name = "keyed";
    static void keys(OwnKeys<Settings>& keys) {
        constexpr int low = std::numeric_limits<int>::min(), high = std::numeric_limits<int>::max();
        keys.integer("draw.source", &Settings::source, low, high, "of the key");
        keys.integer("draw.pose", &Settings::pose, low, high, "of the key");
        keys.integer("draw.index", &Settings::index, low, high, "of the key");
    }
    static std::vector<Component> components(const Settings&) { return {{"a", "m"}, {"b", "m"}}; }
    static std::vector<ComponentGroup> groups(const Settings&) { return {}; }
    static std::vector<std::string> arms(const Settings&) { return {"normal", "uniform"}; }
    static int innovation_rows(const Settings&) { return 0; }
    static std::vector<Column> columns(const Settings&) { return {{"x", "of the draw", "1", ColumnType::real, -1}}; }
    static void run(const Settings& s, OwnTrial& trial) {
        trial.set(0, trial.arm() == 0 ? trial.normal(s.source, s.pose, s.index).x()
                                      : trial.uniform(s.source, s.pose, s.index));
        for (int k = 1; k < trial.poses(); ++k) trial.step(Eigen::Vector2d::Zero(), Eigen::Matrix2d::Identity());
    }
};

/// Sets a column that it has not declared.
struct Undeclared : Keyed {
    static constexpr const char* name = "undeclared";
    static std::vector<Column> columns(const Settings&) { return {}; }
    static void run(const Settings&, OwnTrial& trial) { trial.set(0, 1); }
};

const bool added = [] {
    add_own_world<Keyed>();
    add_own_world<Undeclared>();
    return true;
}();

/// x of the draws under this key: [arm], normal and uniform.
std::vector<double> keyed(int source, int pose, int index) {
    const auto set = [](const char* key, int value) { return std::pair{std::string(key), std::to_string(value)}; };
    const Study study =
        run(read_scenario_text("[scenario]\nworld = keyed\nposes = 2\n", "test", "mine",
                               {set("draw.source", source), set("draw.pose", pose), set("draw.index", index)}),
            1);
    const ScenarioResults& results = study.scenarios[0];
    return {results.arms[0].columns.in_memory()[1][0], results.arms[1].columns.in_memory()[1][0]};
}

}  // namespace

TEST_CASE("own world: a key of a draw that exceeds the counter is refused with its number") {
    REQUIRE(added);
    const std::string last = "134217727";
    REQUIRE_THROWS_WITH(keyed(16, 1, 0), "world keyed: invalid source of a draw 16 (must be 0 to 15).");
    REQUIRE_THROWS_WITH(keyed(-1, 1, 0), "world keyed: invalid source of a draw -1 (must be 0 to 15).");
    REQUIRE_THROWS_WITH(keyed(0, -1, 0), "world keyed: invalid pose of a draw -1 (must be 0 to 2147483647).");
    REQUIRE_THROWS_WITH(keyed(0, 1, -1), "world keyed: invalid index of a draw -1 (must be 0 to " + last + ").");
    REQUIRE_THROWS_WITH(keyed(0, 1, 134217728),
                        "world keyed: invalid index of a draw 134217728 (must be 0 to " + last + ").");
    const Scenario undeclared = read_scenario_text("[scenario]\nworld = undeclared\n", "test", "mine");
    REQUIRE_THROWS_WITH(run(undeclared, 1), "world undeclared: a column that it does not have is set.");
}

TEST_CASE("own world: keys that differ are draws that differ, and small indices keep theirs") {
    std::set<std::vector<double>> draws;
    std::size_t asked = 0;
    for (const int source : {0, 1, 15})
        for (const int pose : {0, 1, std::numeric_limits<int>::max()})
            for (const int index : {0, 1, 65535, 65536, 65537, 131072, 1 << 20, 1 << 26, largest_wide_index}) {
                draws.insert(keyed(source, pose, index));
                ++asked;
            }
    CHECK(draws.size() == asked);
    const KeyedDraws<double> small(1, 0, std::numeric_limits<double>::infinity());
    for (const int index : {0, 1, 4660, 65535}) {
        CHECK(keyed(7, 3, index)[0] == small.normal(static_cast<Source>(7), 3, index).x);
        CHECK(keyed(7, 3, index)[1] == small.uniform(static_cast<Source>(7), 3, index));
    }
}

}  // namespace credence::test::own_draws_test
