// Sweeps through the rooms: scenario files, the study and its hash, the file, merging, and the report in every form.

#include "catch.hpp"
#include "journal_support.hpp"
#include "store_damage.hpp"

#include "files/merge/merge.hpp"
#include <credence/report.hpp>
#include <credence/detail/worlds.hpp>

#include "files/hdf5/read.hpp"
#include "report/sweep.hpp"
#include "report/words.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace credence::test::sweep_run_test {

using Catch::Contains;
using Json = nlohmann::json;

namespace {

const std::string world = "[scenario]\nposes = 6\n[planner]\nspeeds = 2\n";
const std::vector<std::string> square{"noise.heading=0.01,0.1", "sensor.noise=constant,ranged"};

/// The grid of a scenario file `base.ini`.
std::vector<Scenario> swept(const TemporaryFolder& folder, const std::vector<std::string>& sweeps,
                            const std::string& text = world, const Overrides& overrides = {}) {
    put_bytes(folder / "base.ini", text);
    return read_grid(folder / "base.ini", overrides, parse_grid(sweeps));
}

std::string refused(const std::vector<std::string>& sweeps, const std::string& text = world,
                    const Overrides& overrides = {}) {
    const TemporaryFolder folder;
    return refusal<InputError>([&] { swept(folder, sweeps, text, overrides); });
}

Study run(const std::vector<Scenario>& scenarios, std::int64_t trials = 300, const Shard& shard = {}) {
    Study study = new_study(scenarios, 1);
    RunOptions options{trials, 1, {}};
    options.shard = shard;
    run_study(study, options);
    return study;
}

std::vector<std::string> names_of(const std::vector<Scenario>& scenarios) {
    std::vector<std::string> names;
    for (const Scenario& scenario : scenarios) names.push_back(scenario.name);
    return names;
}

}  // namespace

TEST_CASE("sweep: a file's grid has a scenario for every point, with --set before it") {
    const TemporaryFolder folder;
    const std::vector<Scenario> grid = swept(folder, square, world, {{"noise.heading", "0.5"}, {"noise.walk", "0.2"}});
    CHECK(names_of(grid) ==
          std::vector<std::string>{"base_heading-0p01_noise-constant", "base_heading-0p01_noise-ranged",
                                   "base_heading-0p1_noise-constant", "base_heading-0p1_noise-ranged"});
    CHECK(value_of(grid[1], "noise.heading") == "0.01");
    CHECK(value_of(grid[1], "noise.walk") == "0.2");
    CHECK(value_of(grid[2], "sensor.noise") == "constant");
    CHECK(grid[3].sweep == SweepPoint{"base", {{"noise.heading", "0.1"}, {"sensor.noise", "ranged"}}});
    for (const Scenario& scenario : grid)
        CHECK(scenario_text(read_scenario_text(scenario_text(scenario), "x.ini", "x")) == scenario_text(scenario));
    CHECK(swept(folder, {}).front().name == "base");
    CHECK(scenario_text(swept(folder, {}).front()) == scenario_text(read_scenario(folder / "base.ini")));
}

TEST_CASE("sweep: what depends on a swept key is resolved at each point") {
    const TemporaryFolder folder;
    const std::vector<Scenario> grid = swept(folder, {"model.process=heading,translation"}, "");
    CHECK(value_of(grid[0], "planner.speeds") == "10");
    CHECK(value_of(grid[1], "planner.speeds") == "5");
    CHECK(grid[1].arms.front() == "fixed.kf");
}

TEST_CASE("sweep: a point that cannot be run is named, and so is a scenario that is one already") {
    CHECK_THAT(refused({"noise.heading=0.1,0"}),
               Contains("base.ini at noise.heading=0: invalid noise.heading=0 (the heading's variance would stay 0"));
    CHECK_THAT(refused({"sensor.range_min=1:3:3", "noise.heading=0.1"}),
               Contains("base.ini at sensor.range_min=2, noise.heading=0.1: invalid sensor.range_max=2"));
    CHECK_THAT(refused({"noise.heading=0.1"}, world, {{"scenario.name", std::string(90, 'x')}}),
               Contains("must have 1 to 100 characters"));
    CHECK_THAT(refused({"noise.heding=0.1"}),
               Contains("--sweep noise.heding: unknown key noise.heding. Did you mean noise.heading?"));
    CHECK_THAT(refused({"noise.heading=0.1,-1"}),
               Contains("--sweep noise.heading: invalid noise.heading=-1 (must be at least 0"));
    CHECK_THAT(refused({"scenario.poses=10:20:4"}), Contains("invalid scenario.poses=13.33333 (not a whole number)"));
    CHECK_THAT(refused({"noise.heading=0.1"}, world + "[sweep]\nof = other\nat = noise.walk=0.3\n"),
               Contains("it is a point of a grid already: sweep.of=other"));
}

TEST_CASE("sweep: a scenario says where it is, and is refused where it is not") {
    const auto placed = [](const std::string& sweep) {
        return read_scenario_text(world + "[sweep]\n" + sweep, "x.ini", "x");
    };
    const Scenario there = placed("of = base\nat = planner.turns=default, noise.heading=1e-3,planner.speeds=2\n");
    CHECK(there.sweep ==
          SweepPoint{"base", {{"planner.turns", "default"}, {"noise.heading", "0.001"}, {"planner.speeds", "2"}}});
    CHECK_THAT(scenario_text(there),
               Contains("\n\n[sweep]\nof = base\nat = planner.turns=default, noise.heading=0.001, planner.speeds=2\n"));
    CHECK(scenario_text(read_scenario_text(scenario_text(there), "x.ini", "x")) == scenario_text(there));
    const auto refused_place = [&](const std::string& sweep) { return refusal<InputError>([&] { placed(sweep); }); };
    CHECK_THAT(refused_place("of = base\nat = noise.heading=0.002"),
               Contains("x.ini:7: invalid sweep.at=noise.heading=0.002 (the scenario has noise.heading=0.001)"));
    CHECK_THAT(refused_place("of = base\nat = planner.speeds=default"), Contains("the scenario has planner.speeds=2"));
    CHECK_THAT(refused_place("of = base\nat = noise.heding=1"), Contains("unknown key noise.heding"));
    CHECK_THAT(refused_place("at = noise.heading=0.001"), Contains("invalid sweep.of= (a point of a grid"));
    CHECK_THAT(refused_place("of = base"), Contains("invalid sweep.of=base (a point of a grid"));
    CHECK_THAT(refused_place("of = a b\nat = noise.heading=0.001"), Contains("x.ini:6: invalid sweep.of=a b"));
    CHECK_THAT(refused_place("off = base"), Contains("x.ini:6: unknown key sweep.off"));
}

TEST_CASE("sweep: the text of a study without one is what it was, and so is its hash") {
    // Computed before there were sweeps: existing files of studies must stay usable.
    CHECK(study_hash(StudyDefinition{1, {read_scenario_text("", "x.ini", "scenario")}}) ==
          "ba5d28bb-9fb1-5546-9527-e36bb295fbee");
}

TEST_CASE("sweep: the points of a grid have the bits of runs of their own") {
    const TemporaryFolder folder;
    const Study grid = run(swept(folder, square));
    std::size_t at = 0;
    for (const char* heading : {"0.01", "0.1"})
        for (const char* noise : {"constant", "ranged"}) {
            Study alone = run(
                {read_scenario_text(world, "one.ini", "one", {{"noise.heading", heading}, {"sensor.noise", noise}})});
            Study point{grid.root_seed, {grid.scenarios[at++]}, grid.trials, grid.complete};
            CHECK(same_results(alone, point));
        }
    CHECK_FALSE(same_results({1, {grid.scenarios[0]}, 300, true}, {1, {grid.scenarios[2]}, 300, true}));
}

TEST_CASE("sweep: a grid survives file and merge, and the file says where each point is") {
    const TemporaryFolder folder;
    const std::vector<Scenario> scenarios = swept(folder, square);
    const Study whole = run(scenarios, 600);
    write_results(folder / "whole.h5", whole, {});
    for (const int part : {0, 1}) {
        const std::string path = folder / ("part" + std::to_string(part) + ".h5");
        write_results(path, run(scenarios, 600, {part, 2}), {});
    }
    write_results(folder / "merged.h5", merge_results({folder / "part1.h5", folder / "part0.h5"}), {});
    CHECK(bytes_of(folder / "merged.h5") == bytes_of(folder / "whole.h5"));
    const Study read = read_results(folder / "whole.h5").study;
    CHECK(same_results(read, whole));
    for (std::size_t s = 0; s < 4; ++s) CHECK(read.scenarios[s].scenario.sweep == scenarios[s].sweep);
    const hdf5::Handle group = hdf5::open_group(hdf5::open_file(folder / "whole.h5"), scenarios[3].name);
    CHECK(hdf5::read_text(group, "sweep_of") == "base");
    CHECK(hdf5::read_text(group, "sweep_keys") == "noise.heading sensor.noise");
    CHECK(hdf5::read_number<double>(group, "sweep.noise.heading") == 0.1);
    CHECK(hdf5::read_text(group, "sweep.sensor.noise") == "ranged");
}

TEST_CASE("sweep: a file whose attributes contradict its scenarios is refused") {
    const TemporaryFolder folder;
    const std::vector<Scenario> scenarios = swept(folder, square);
    const std::string name = scenarios[0].name;
    const std::vector<Damage> damages{
        {"@sweep_of: does not agree", with_text(name, "sweep_of", "other")},
        {"@sweep_keys: does not agree", with_text(name, "sweep_keys", "noise.heading")},
        {"@sweep.noise.heading: does not agree", with_number<double>(name, "sweep.noise.heading", 0.02)},
        {"@sweep.noise.heading: holds", with_text(name, "sweep.noise.heading", "0.01")},
        {"@sweep.sensor.noise: does not agree", with_text(name, "sweep.sensor.noise", "ranged")},
        {"@sweep_keys: does not agree", without_attribute(name, "sweep_of")},
        {"@sweep_keys: does not agree",
         [&](const Handle& root) { hdf5::write_text(open(root, name), "sweep.more", ""); }},
    };
    require_refused(new_study(scenarios, 1), damages);
}

TEST_CASE("sweep: a grid that a crash left in its journal goes on to the same results") {
    const TemporaryFolder folder;
    const std::vector<Scenario> scenarios = swept(folder, square);
    Asked asked;
    asked.trials = 300;
    {
        StoredRun dying(folder / "study.h5", new_study(scenarios, 1), Start::resume);
        compute(dying, asked, 3);
    }
    StoredRun resumed(folder / "study.h5", new_study(scenarios, 1), Start::resume);
    CHECK(blocks_in(resumed.study()) == 3);
    compute(resumed, asked);
    resumed.finish({});
    Study once = run(scenarios);
    once.computed_by = {unknown_release};
    write_results(folder / "once.h5", once, {});
    CHECK(bytes_of(folder / "study.h5") == bytes_of(folder / "once.h5"));
}

TEST_CASE("sweep: grids of a study are distinguished by scenario and keys") {
    Report report;
    for (const auto& [name, of, at] : {std::tuple("1", "a", "k.x=2, k.n=p"), std::tuple("2", "", ""),
                                       std::tuple("3", "b", "k.x=1"), std::tuple("4", "a", "k.x=1, k.n=p"),
                                       std::tuple("5", "a", "k.x=7")}) {
        report.scenarios.emplace_back().name = name;
        if (*of != '\0') report.scenarios.back().sweep = {of, parse_coordinates(at)};
    }
    using Keys = std::vector<std::string>;
    const std::vector<Grid> grids = grids_of(report);
    REQUIRE(grids.size() == 3);
    CHECK((grids[0].of == "a" && grids[0].keys == Keys{"k.x", "k.n"}));
    CHECK((grids[1].of == "b" && grids[1].keys == Keys{"k.x"}));
    CHECK((grids[2].of == "a" && grids[2].keys == Keys{"k.x"}));
    CHECK(grids[0].points.size() == 2);
    CHECK(grids[0].points.at("4") == &report.scenarios[3]);
}

TEST_CASE("sweep: of a large grid the page has the table, and no section for each point") {
    const TemporaryFolder folder;
    std::vector<Scenario> scenarios = swept(folder, {"noise.heading=0.01:0.13:13"},
                                               "[scenario]\nposes = 3\n[arms]\ncontrollers = fixed\n");
    const auto page_of = [&] { return report_html(make_report(run(scenarios, 3), 0.05), {"r.h5", {}, "test"}); };
    const std::string large = page_of();
    CHECK_THAT(large, !Contains("scenario:base_heading-0p01") &&
                          Contains("<th scope=\"row\"><data value=\"0.13\">0.13</data></th>"));
    CHECK_THAT(large,
               Contains("The points of large grids have no section of their own here.") && !Contains("again.h5"));
    scenarios.pop_back();
    const std::string small = page_of();
    CHECK_THAT(small,
               Contains("id=\"scenario:base_heading-0p12\"") && Contains("href=\"#scenario:base_heading-0p12\""));
    CHECK_THAT(small, Contains("again.h5"));
}

TEST_CASE("sweep: the report has the grid as table, JSON and CSV") {
    const TemporaryFolder folder;
    std::vector<Scenario> scenarios = swept(folder, square);
    scenarios.push_back(read_scenario_text(world, "alone.ini", "alone"));
    const Report report = make_report(run(scenarios, 40), 0.05);

    const Json json = Json::parse(report_json(report));
    REQUIRE(json.size() == 10);
    CHECK(json[2]["sweep"] ==
          Json::parse(R"({"of": "base", "at": {"noise.heading": 0.01, "sensor.noise": "ranged"}})"));
    CHECK_FALSE(json[9].contains("sweep"));

    const std::string csv = report_csv(report);
    CHECK_THAT(csv, Contains("base_heading-0p01_noise-constant,greedy.ekf - fixed.ekf,40,") &&
                        Contains(",base,0.1,ranged,"));
    CHECK_THAT(report_csv(make_report(run({scenarios.back()}, 40), 0.05)),
               Contains(",percentile,verdict,failed_trials\n"));

    CHECK_THAT(report_text(report), !Contains("base_heading-0p01"));  // the table says it shorter
    const std::string page = report_html(report, {"r.h5", {}, "test"});
    CHECK_THAT(
        page,
        Contains(
            "<a href=\"#scenario:base_heading-0p1_noise-ranged\"><data value=\"0.1\">0.1</data></a></th>"
            "<th scope=\"row\">ranged</th>"));
    CHECK_THAT(report_html(make_report(run({scenarios.back()}, 40), 0.05), {"r.h5", {}, "test"}), !Contains("Sweep"));
}

TEST_CASE("sweep: failed trials of all points are one note, and a page folds what is more than five notes") {
    const TemporaryFolder folder;
    std::vector<Scenario> scenarios = swept(folder, {"noise.heading=0.3,0.6,1,1.5"}, world);
    const Report grid = make_report(run(scenarios), 0.05);
    std::int64_t failed = 0;
    for (const ArmReport& arm : grid.arms) failed += arm.failed_trials() > 0;
    REQUIRE(failed > 3);
    const std::vector<std::string> notes = warnings_of(grid);
    REQUIRE(notes.size() == 1);
    CHECK_THAT(notes.front(), Contains("WARNING: trials failed or diverged at points of a sweep, most, ") &&
                                  Contains(" of 300, of base_heading-"));
    CHECK_THAT(report_html(grid, {"r.h5", {}, "test"}), !Contains(" more note"));

    for (Scenario& scenario : scenarios) scenario.sweep = {};
    const Report alone = make_report(run(scenarios), 0.05);
    const std::size_t count = warnings_of(alone).size();
    REQUIRE(count > 5);
    const std::string page = report_html(alone, {"r.h5", {}, "test"});
    REQUIRE_THAT(page, Contains("<summary>" + std::to_string(count - 5) + " more note"));
    CHECK(page.find("diverged (NEES/dim") < page.find("<details"));
}

}  // namespace credence::test::sweep_run_test
