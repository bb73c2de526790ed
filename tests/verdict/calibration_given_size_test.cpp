// Calibration given P: a P that is too small in some trials and too large in others, which the mean of NEES hides, is
// found wherever the trials are.

#include <nlohmann/json.hpp>

#include "either_way.hpp"
#include "own_program.hpp"
#include "worlds/own_study.hpp"

#include <credence/ini.hpp>

namespace credence::test::calibration_given_size_test {

namespace {

/// P is 2/3 of what it should be in half of the trials, and twice that in the others: NEES/n is 1 in the mean.
struct Halves {
    struct Settings {};
    static constexpr const char* name = "halves";
    static void keys(OwnKeys<Settings>&) {}
    static std::vector<Component> components(const Settings&) { return {{"x", "m"}, {"y", "m"}}; }
    static std::vector<ComponentGroup> groups(const Settings&) { return {}; }
    static std::vector<std::string> arms(const Settings&) { return {"halves", "some_lost", "right"}; }
    static int innovation_rows(const Settings&) { return 0; }
    static void run(const Settings&, OwnTrial& trial) {
        enum Source { walk, half, diverged };
        const double P = trial.arm() == 2 ? 1 : trial.uniform(half, 0) < 0.5 ? 2.0 / 3 : 2;
        const double size = trial.arm() == 1 && trial.uniform(diverged, 0) < 0.003 ? 100 : 1;
        for (int k = 1; k < trial.poses(); ++k)
            trial.step(size * trial.normal(walk, k), P * Eigen::Matrix2d::Identity());
    }
};

const bool halves_added = (add_own_world<Halves>(), true);

const std::string scenario_file = "[scenario]\nworld = halves\nposes = 12\n";
constexpr int trials = 4000;

}  // namespace

TEST_CASE("calibration given P: what a mean over all trials hides is found in memory and in a file alike") {
    REQUIRE(halves_added);
    const Report report =
        report_either_way(run(read_scenario_text(scenario_file, "halves.ini", "halves"), trials), {});
    for (const std::size_t arm : {0, 1}) {
        const Consistency& found = report.arms[arm].consistency;
        CHECK(found.verdict == Verdict::mixed);
        REQUIRE(found.findings.size() > 1);
        for (const Finding& finding : found.findings) CHECK(finding.about == Subject::calibration);
        const GroupEvidence& state = report.arms[arm].evidence.groups.front();
        CHECK((arm == 0 ? state.run : state.without_diverged).mean == Approx(1).margin(0.03));
    }
    CHECK(report.arms[0].diverged == 0);
    CHECK(report.arms[1].diverged > 3);
    CHECK(report.arms[2].consistency.verdict == Verdict::consistent);
}

TEST_CASE("calibration given P: `run` says it as it ends, and `report` of its file, of shards and after growth") {
    const Workplace here;
    here.write("halves.ini", scenario_file);
    const std::string more = " --trials " + std::to_string(trials);
    REQUIRE(own_program(here, "run halves.ini -o x.h5" + more) == 0);
    CHECK_THAT(here.read("out"), Catch::Contains("halves/halves     mixed"));
    REQUIRE(own_program(here, "run halves.ini -o grown.h5 --quiet --trials 700") == 0);
    REQUIRE(own_program(here, "run halves.ini -o grown.h5 --quiet --resume" + more) == 0);
    for (const std::string shard : {"0/2", "1/2"})
        REQUIRE(own_program(here, "run halves.ini --quiet -o {shard}.h5 --shard " + shard + more) == 0);
    REQUIRE(own_program(here, "merge 0.h5 1.h5 -o merged.h5 --quiet") == 0);
    for (const std::string file : {"x.h5", "grown.h5", "merged.h5"}) {
        CAPTURE(file);
        const auto arms = nlohmann::json::parse(here.credence("report --format json " + file).out);
        CHECK(arms[0]["verdict"] == "mixed");
        CHECK(arms[2]["verdict"] == "consistent");
    }
}

}  // namespace credence::test::calibration_given_size_test
