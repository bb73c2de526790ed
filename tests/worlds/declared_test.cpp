// What a user's own world declares is checked before any work: what could not be stored, read back or judged is
// refused.

#include "catch.hpp"
#include "lane_worlds.hpp"
#include "own_study.hpp"
#include "support.hpp"
#include "temporary_folder.hpp"

#include <credence/error.hpp>
#include <credence/ini.hpp>
#include <credence/own_world.hpp>
#include "files/stored_run.hpp"

#include <cmath>
#include <limits>

namespace credence::test::declared_test {

using Catch::Contains;

namespace {

/// What the world below declares: a test changes it.
struct Declaration {
    std::string name = "declared";
    std::vector<std::string> keys{"point.sigma"}, words{"near", "far"}, arms{"one", "two"};
    std::vector<Component> components{{"a", "m"}, {"b", "m"}};
    std::vector<ComponentGroup> groups{{"first", 0, 1}};
    std::vector<Column> columns{{"count", "measurements", "1", ColumnType::integer, -1}};
    int rows = 2;
    double sigma = 1;
    int word = 0;
};
Declaration declared;

struct Declared {
    enum class Word { near, far };
    struct Settings {
        double sigma = declared.sigma;
        Word word = static_cast<Word>(declared.word);
    };
    static inline const std::string& name = declared.name;
    static void keys(OwnKeys<Settings>& keys) {
        for (const std::string& key : declared.keys) keys.real(key, &Settings::sigma, 0, 10, "sigma (m)");
        keys.choice("point.word", &Settings::word, declared.words, "which");
    }
    static std::vector<Component> components(const Settings&) { return declared.components; }
    static std::vector<ComponentGroup> groups(const Settings&) { return declared.groups; }
    static std::vector<std::string> arms(const Settings&) { return declared.arms; }
    static int innovation_rows(const Settings&) { return declared.rows; }
    static std::vector<Column> columns(const Settings&) { return declared.columns; }
    static void run(const Settings&, OwnTrial&) {}
};

/// The refusal of a declaration that `change` spoils; empty where it is taken.
std::string refused(const std::function<void(Declaration&)>& change) {
    declared = {};
    change(declared);
    return test::refusal([] { WorldOf<OwnWorld<Declared>>().draft()->declare(); });
}

const std::string start = "cannot use world declared (";

}  // namespace

TEST_CASE("own world: a declaration that no file could hold is refused with a sentence") {
    CHECK(refused([](Declaration&) {}) == "");
    CHECK(refused([](Declaration& d) { d.name = "a/b"; }) ==
          "cannot use world a/b (its name is none of letters, digits, _ and -). Give it another name.");
    CHECK_THAT(refused([](Declaration& d) { d.name = "<b>"; }), Contains("its name is none of"));
    CHECK_THAT(refused([](Declaration& d) { d.name = ""; }), Contains("its name is none of"));
    CHECK(refused([](Declaration& d) {
              d.arms = {"one", "two", "one"};
          }) == start + "one is there twice among its arms). Give its arms other names.");
    CHECK(refused([](Declaration& d) { d.arms = {}; }) == start + "it has no arms). Name one or more.");
    CHECK_THAT(refused([](Declaration& d) { d.arms = {"a b"}; }), Contains("'a b' among its arms is no name"));
    CHECK_THAT(refused([](Declaration& d) { d.components = {}; }), Contains("it has no components"));
    CHECK_THAT(refused([](Declaration& d) { d.components[1].name = "a"; }),
               Contains("a is there twice among its components"));
    CHECK_THAT(refused([](Declaration& d) { d.components[1].name = ""; }),
               Contains("'' among its components is no name"));
    CHECK_THAT(refused([](Declaration& d) { d.components[1].unit = "m s"; }),
               Contains("the unit 'm s' of b is no word"));
    CHECK_THAT(refused([](Declaration& d) {
                   d.components.clear();
                   for (int j = 0; j < 1001; ++j) d.components.push_back({"x" + std::to_string(j), "m"});
               }),
               Contains("its state has 1001 components). Give at most 1000."));
    CHECK_THAT(refused([](Declaration& d) { d.groups[0].name = "all"; }),
               Contains("all is there twice among its groups"));
    CHECK_THAT(refused([](Declaration& d) { d.groups[0].count = 3; }),
               Contains("group first is not in the state of 2"));
    CHECK_THAT(refused([](Declaration& d) { d.groups[0].count = -1; }), Contains("group first is not in the state"));
    CHECK_THAT(refused([](Declaration& d) { d.rows = -1; }), Contains("its innovations have -1 rows). Give 0 to 2000"));
    CHECK_THAT(refused([](Declaration& d) { d.rows = 2'000'000'000; }),
               Contains("its innovations have 2000000000 rows"));
    CHECK(refused([](Declaration& d) { d.rows = 2000; }) == "");
}

TEST_CASE("own world: keys that clash, or whose values no file could be read back with, are refused") {
    CHECK(refused([](Declaration& d) { d.keys = {"scenario.poses"}; }) ==
          start + "scenario.poses is there twice among its keys). Give its keys other names.");
    CHECK_THAT(refused([](Declaration& d) { d.keys = {"scenario.world"}; }), Contains("scenario.world is there twice"));
    CHECK_THAT(refused([](Declaration& d) { d.keys = {"a.b", "a.b"}; }), Contains("a.b is there twice"));
    CHECK(refused([](Declaration& d) { d.keys = {"sweep.of"}; }) ==
          start + "sweep.of means something else in every world). Give the key another section.");
    CHECK_THAT(refused([](Declaration& d) { d.keys = {"published.trace_P"}; }), Contains("published.trace_P means"));
    for (const char* key : {"sigma", "point.", ".sigma", "point.si gma", "point.sigma=", "[point].sigma", ""})
        CHECK_THAT(refused([&](Declaration& d) { d.keys = {key}; }), Contains("among its keys is no name"));
    CHECK(refused([](Declaration& d) { d.keys = {"point.of.sigma"}; }) == "");
    CHECK_THAT(refused([](Declaration& d) { d.words[0] = "# 1"; }),
               Contains("point.word=# 1 cannot be read back from a file"));
    CHECK(refused([](Declaration& d) { d.sigma = 11; }) ==
          "invalid point.sigma=11 (must be at least 0 and at most 10). Give a number in that range.");
    CHECK_THAT(refused([](Declaration& d) { d.sigma = std::nan(""); }), Contains("invalid point.sigma=nan"));
    CHECK_THAT(refused([](Declaration& d) { d.word = 7; }), Contains("invalid point.word=7 (not one of its choices)"));
}

TEST_CASE("own world: columns that clash, or that no file could hold, are refused") {
    const auto with = [](const Column& column) { return refused([&](Declaration& d) { d.columns = {column}; }); };
    CHECK(with({"trace_P", "", "1"}) ==
          start + "trace_P is there twice among its columns). Give its columns other names.");
    CHECK_THAT(with({"a b", "", "1"}), Contains("'a b' among its columns is no name"));
    CHECK_THAT(with({"end", "", "1", ColumnType::status}),
               Contains("column end has the type status). Make it an integer."));
    CHECK_THAT(with({"count", "", "1", ColumnType::integer, std::nan("")}),
               Contains("column count is filled with nan"));
    CHECK_THAT(with({"count", "", "1", ColumnType::integer, 1e18}), Contains("column count is filled with 1e+18"));
    CHECK_THAT(with({"size", "", "m, m"}), Contains("the unit 'm, m' of column size is no word"));
    CHECK_THAT(with({"size", "", ""}), Contains("is no word"));
}

namespace {

/// Two arms that set its column of whole numbers to something else in every third trial, and one that does not.
struct Counting {
    struct Settings {};
    static constexpr const char* name = "counting";
    static void keys(OwnKeys<Settings>&) {}
    static std::vector<Component> components(const Settings&) { return {{"a", "m"}, {"b", "m"}}; }
    static std::vector<ComponentGroup> groups(const Settings&) { return {}; }
    static std::vector<std::string> arms(const Settings&) { return {"whole", "half", "large", "nan"}; }
    static int innovation_rows(const Settings&) { return 0; }
    static std::vector<Column> columns(const Settings&) {
        return {{"size", "any number", "1"}, {"count", "a whole number", "1", ColumnType::integer, -1}};
    }
    static void run(const Settings&, OwnTrial& trial) {
        constexpr double values[] = {-2147483647, 0.5, 1e18, std::numeric_limits<double>::quiet_NaN()};
        for (int k = 1; k < trial.poses(); ++k) trial.step(trial.normal(0, k), Eigen::Matrix2d::Identity());
        trial.set(0, 0.5);
        trial.set(1, trial.uniform(1, 0) < 1.0 / 3 ? values[trial.arm()] : 7);
    }
};
/// The same, evaluated one trial at a time.
struct CountingPlainly : Counting {
    static constexpr const char* name = "counting_plainly";
    static std::vector<ComponentGroup> groups(const Settings&) { return {{"turned", 1, 2, {1, 0}}}; }
};
/// Its columns, groups and components have names of their own, and two of their datasets have not.
struct Clashing : Counting {
    static constexpr const char* name = "clashing";
    static std::vector<ComponentGroup> groups(const Settings&) { return {{"square", 0, 1}}; }
};
struct Twin : Counting {
    static constexpr const char* name = "twin";
};

const bool added = [] {
    add_own_world<Counting>();
    add_own_world<CountingPlainly>();
    add_own_world<Clashing>();
    add_own_world<Twin>();
    add_own_world<Twin>();
    return true;
}();

Scenario scenario_of(const std::string& world) {
    return read_scenario_text("[scenario]\nworld = " + world + "\nposes = 4\n", "test", "mine");
}

}  // namespace

TEST_CASE("own world: a trial whose whole number is none of 32 bits has failed at its last pose") {
    REQUIRE(added);
    for (const char* world : {"counting", "counting_plainly"}) {
        CAPTURE(world);
        const Study study = test::run(scenario_of(world), 50);
        const ScenarioResults& results = study.scenarios[0];
        const std::size_t count = 2, status = status_column(results.columns);
        REQUIRE(results.columns[count].name == "count");
        const std::vector<double>& whole = results.arms[0].columns.in_memory()[count];
        CHECK(results.arms[0].totals.trials.counted() == 50);
        const auto marked = std::ranges::count(whole, -2147483647.0);
        CHECK(marked > 5);
        for (std::size_t a = 1; a < results.arms.size(); ++a) {
            CAPTURE(results.arms[a].name);
            CHECK(results.arms[a].totals.trials.counted() == 50 - marked);
            for (std::size_t trial = 0; trial < whole.size(); ++trial) {
                const auto value = [&](std::size_t c) { return results.arms[a].columns.in_memory()[c][trial]; };
                const bool failed = whole[trial] != 7;
                CHECK(value(count) == (failed ? -1 : 7));
                CHECK(value(status) == (failed ? static_cast<double>(Status::non_finite) : 0));
                CHECK(value(status + 1) == (failed ? 3 : -1));
            }
        }
    }
}

TEST_CASE("own world: names of which two datasets would be one are refused before a file is made") {
    const test::TemporaryFolder folder;
    const std::string said = test::refusal([&] {
        StoredRun(folder / "mine.h5", new_study(std::vector<Scenario>{scenario_of("clashing")}, 1), Start::fresh);
    });
    CHECK(said ==
          "cannot store scenario mine (its world clashing names columns, groups or components so that two datasets "
          "would be nees_square_total). Rename one of them in the world.");
    CHECK(folder.entries() == 0);
}

TEST_CASE("own world: of two worlds of one name neither is taken") {
    CHECK(test::refusal([] { scenario_of("twin"); }) ==
          "test:2: invalid scenario.world=twin (this program has two worlds of that name). Give the one that was added "
          "another name.");
}

}  // namespace credence::test::declared_test
