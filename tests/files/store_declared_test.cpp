// Results of worlds that this program does not have: the file says enough of itself, or is refused.
// Kind: foreign files.

#include "store_damage.hpp"
#include "study_support.hpp"

#include "../../experiments/own_filter/tracker.hpp"


namespace credence::test::store_declared_test {

namespace {

/// A study of the tracker, as if of an unknown world.
Study unknown_world() {
    const WorldOf<OwnWorld<Tracker>> world;
    const std::unique_ptr<Draft> draft = world.draft();
    draft->set("scenario.poses", "5");
    Scenario scenario = draft->declare();
    if (find_world("tracker") == nullptr) add_own_world<Tracker>();
    Study study = new_study(std::vector<Scenario>{scenario}, 1);
    RunOptions options;
    options.trials = 6;
    options.threads = 1;
    run_study(study, options);
    Scenario& renamed = study.scenarios.front().scenario;
    renamed.world = renamed.settings.front().value = "elsewhere";
    renamed.name = renamed.settings[1].value = "mine";
    return study;
}

const std::string own_arm = "/mine/kf";

const std::vector<Damage> damages{
    {"/mine@groups: is missing", without_attribute("/mine", "groups")},
    {"/mine@groups: `beyond 3:9` goes beyond the 4 components", with_text("/mine", "groups", "beyond 3:9")},
    {"/mine@groups: names two groups", with_text("/mine", "groups", "a 0:1, a 1:2")},
    {"/component: does not name the components", with_text(own_arm + "/component", "component_names", "p_x p_y")},
    {"/component: does not name the components", with_text(own_arm + "/component", "component_names", "a b c \x1b")},
    {"/component: does not name the components", with_text(own_arm + "/component", "component_units", "")},
    {"/component: is missing", without(own_arm + "/component")},
    {"/step: is no list of steps", replaced<std::int32_t>(own_arm + "/step", {0})},
    {"/step: is no list of steps", replaced<std::int32_t>(own_arm + "/step", {2, 2})},
    {"/mine/kf: has no columns that end with status", without(own_arm + "/status_pose")},
    {"/mine/kf: has no columns that end with status", without_attribute(own_arm + "/status", "flag_meanings")},
    {"is missing", without("/mine/calm/measurements")},
    {"is missing", without("/mine/kf/nees_total")},
    {"/mine/kf/more: is no readable dataset", [](auto& r) { hdf5::new_group(open(r, "/mine/kf"), "more"); }},
    {"/mine: is no scenario with arms", [](auto& r) { remove(r, "/mine/kf"), remove(r, "/mine/calm"); }},
    {"does not agree with the group's name",
     with_text("/mine", "scenario", "[scenario]\nworld = elsewhere\nname = other\n")},
    {"broken line", with_text("/mine", "scenario", "[scenario]\nworld = elsewhere\njunk\n")},
    {"/@study_hash: does not belong", with_text("/mine", "scenario", "[scenario]\nworld = elsewhere\nname = mine\n")},
};

}  // namespace

TEST_CASE("store: a file of a world that this program does not have is read by what it says of itself") {
    const Study study = unknown_world();
    const TemporaryFolder folder;
    write_results(folder / "there.h5", study, {});
    const Study read = read_results(folder / "there.h5").study;
    CHECK(same_results(read, study));
    CHECK(study_hash(read) == study_hash(study));
    const ScenarioResults &a = read.scenarios[0], &b = study.scenarios[0];
    CHECK(a.scenario.components == b.scenario.components);
    REQUIRE(a.all_series.size() == b.all_series.size());
    for (std::size_t f = 0; f < a.all_series.size(); ++f) {
        CHECK(a.all_series[f].name == b.all_series[f].name);
        CHECK(a.all_series[f].unit == b.all_series[f].unit);
        CHECK(a.all_series[f].part == b.all_series[f].part);
        CHECK(a.all_series[f].dimension == b.all_series[f].dimension);
    }
    REQUIRE(a.columns.size() == b.columns.size());
    for (std::size_t c = 0; c < a.columns.size(); ++c) {
        CHECK(a.columns[c].name == b.columns[c].name);
        CHECK(a.columns[c].type == b.columns[c].type);
        CHECK(a.columns[c].unit == b.columns[c].unit);
        CHECK(a.columns[c].long_name == b.columns[c].long_name);
    }
    REQUIRE_THROWS_WITH(simulation_of(a.scenario),
                        Catch::Contains("scenario.world=elsewhere (this program has no such world)"));
}

TEST_CASE("store: a file of another world that does not say enough of itself is refused") {
    require_refused(unknown_world(), damages);
}

}  // namespace credence::test::store_declared_test
