// A world of one's own: the tracker of experiments/own_filter, and worlds that do what they must not.

#include "catch.hpp"
#include "own_study.hpp"
#include "temporary_folder.hpp"

#include "../../experiments/own_filter/tracker.hpp"

#include <credence/consistency.hpp>
#include <credence/evidence.hpp>
#include <credence/ini.hpp>
#include "files/merge/merge.hpp"
#include "report/format.hpp"
#include "study/budget.hpp"
#include <credence/report.hpp>
#include <credence/detail/store.hpp>
#include "files/stored_run.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

namespace credence::test::own_world_test {

using test::run;
using test::TemporaryFolder;

namespace {

/// A random walk judged exactly, and arms that spoil one thing at one step.
struct Spoiled {
    struct Settings {
        int step = 3;  ///< at which it happens
    };
    static constexpr const char* name = "spoiled";
    static void keys(OwnKeys<Settings>& keys) { keys.integer("fault.step", &Settings::step, 1, 100, "where"); }
    static std::vector<Component> components(const Settings&) { return {{"a", "m"}, {"b", "m"}}; }
    static std::vector<ComponentGroup> groups(const Settings&) { return {}; }
    static std::vector<std::string> arms(const Settings&) { return {"sound", "indefinite", "nan", "large", "missing"}; }
    static int innovation_rows(const Settings&) { return 3; }
    static void run(const Settings& s, OwnTrial& trial) {
        for (int k = 1; k < trial.poses(); ++k) {
            Eigen::VectorXd error = trial.normal(0, k);
            Eigen::MatrixXd P = Eigen::Matrix2d::Identity();
            Eigen::VectorXd innovation(3);
            innovation << trial.normal(1, k), trial.normal(1, k, 1).x();
            const bool here = k == s.step;
            if (here && trial.arm() == 1) P(1, 1) = -1;
            if (here && trial.arm() == 2) error(0) = std::nan("");
            if (here && trial.arm() == 3) error(0) = 1e13;
            if (here && trial.arm() == 4) innovation(1) = std::nan("");
            trial.step(error, P, innovation, Eigen::Matrix3d::Identity());
        }
    }
};

/// Takes one step too few.
struct Short : Spoiled {
    static constexpr const char* name = "short";
    static void run(const Settings&, OwnTrial& trial) {
        for (int k = 2; k < trial.poses(); ++k) trial.step(Eigen::Vector2d::Zero(), Eigen::Matrix2d::Identity());
    }
};

/// A scalar random walk seen at every step, whose arms count its two sources: right, wrong, and once too rarely.
struct Sourced {
    struct Settings {};
    static constexpr const char* name = "sourced";
    static constexpr const char* sources[] = {"walk", "measurement"};
    static void keys(OwnKeys<Settings>&) {}
    static std::vector<Component> components(const Settings&) { return {{"x", "m"}}; }
    static std::vector<ComponentGroup> groups(const Settings&) { return {}; }
    static std::vector<std::string> arms(const Settings&) { return {"right", "wrong", "rare", "silent", "unknown"}; }
    static int innovation_rows(const Settings&) { return 0; }
    static void run(const Settings&, OwnTrial& trial) {
        double e = 0, of_walk = 0, of_measurement = 0;
        for (int k = 1; k < trial.poses(); ++k) {
            e -= trial.normal(0, k).x();
            of_walk += 1;
            const double P = of_walk + of_measurement, K = P / (P + 0.25);
            e = (1 - K) * e + 0.5 * K * trial.normal(1, k).x();
            of_walk *= (1 - K) * (1 - K);
            of_measurement = (1 - K) * (1 - K) * of_measurement + 0.25 * K * K;
            const auto count = [&](int source, double variance) {
                trial.counts(source, Eigen::Matrix<double, 1, 1>(variance));
            };
            if (trial.arm() < 3) count(0, of_walk);
            if (trial.arm() < 2 || (trial.arm() == 2 && k > 1)) count(1, of_measurement * (trial.arm() == 1 ? 1.1 : 1));
            if (trial.arm() == 4) count(16, 1);
            trial.step(Eigen::Matrix<double, 1, 1>(e), Eigen::Matrix<double, 1, 1>(of_walk + of_measurement));
        }
    }
};

/// The worlds of this file, added once.
const bool worlds_added = [] {
    add_own_world<Tracker>();
    add_own_world<Spoiled>();
    add_own_world<Short>();
    add_own_world<Sourced>();
    return true;
}();

Scenario tracker(const Overrides& more = {}) {
    return read_scenario_text("[scenario]\nworld = tracker\nposes = 30\n", "test", "mine", more);
}

Study run_spoiled(std::int64_t trials) {
    return run(read_scenario_text("[scenario]\nworld = spoiled\nposes = 12\n", "test", "mine"), trials);
}

double statuses(const ArmResults& arm, std::size_t column, Status status) {
    double count = 0;
    for (const double one : arm.columns.in_memory()[column]) count += one == static_cast<double>(status);
    return count;
}

}  // namespace

TEST_CASE("own world: the filter that knows its model is consistent, the calm one optimistic in velocity first") {
    REQUIRE(worlds_added);
    const Report report = make_report(run(tracker(), 4000), 0.05);
    CHECK(report.arms[0].consistency.verdict == Verdict::consistent);
    CHECK(report.arms[1].consistency.verdict == Verdict::optimistic);
    const Evidence &kf = report.arms[0].evidence, &calm = report.arms[1].evidence;
    REQUIRE(kf.groups.size() == 3);
    CHECK(kf.groups[2].name == "velocity");
    // Means of 4000 trials, each over 29 correlated steps: five standard errors.
    for (const GroupEvidence& group : kf.groups) CHECK(std::abs(group.run.mean - 1) < 5 * group.run.standard_error);
    CHECK(calm.groups[2].run.mean > 2 * calm.groups[1].run.mean / 1.5);
    CHECK(kf.nis.front().ratio == Approx(1).margin(0.02));
    CHECK(std::abs(kf.whiteness.front().correlation) < kf.whiteness.front().simultaneous_bound);
    CHECK(calm.whiteness.front().correlation > 5 * calm.whiteness.front().bound);
}

TEST_CASE("own world: what P counts for each source is what the world says, and adds up to P") {
    // All is seen at every step, so that the gains of all trials are the same, and the error of a source is what the
    // right filter counts for it.
    const Scenario all_seen = tracker({{"sensor.detection", "1"}, {"scenario.poses", "12"}});
    for (const KeptErrors at : {KeptErrors::last, KeptErrors::mean}) {
        Study study = new_study(budget_scenarios(all_seen, at), 1);
        RunOptions options;
        options.trials = 4000;
        run_study(study, options);
        const std::vector<ArmBudget> budgets = budgets_of(study);
        REQUIRE(budgets.size() == 2);
        for (const BudgetPart& part : budgets[0].parts) {
            CAPTURE(part.name);
            double counted = 0;
            for (const Contribution& one : part.contributions) {
                CAPTURE(one.source);
                counted += one.p_counts * one.p_counts;
                if (one.source == "detection") continue;
                CHECK(one.alone * one.alone == Approx(one.p_counts * one.p_counts).epsilon(0.12).margin(1e-9));
            }
            CHECK(std::sqrt(counted) == Approx(part.p_says).epsilon(1e-9));
        }
        CHECK(budgets[0].counted_trials == 256);
        const auto ratio = [&](const ArmBudget& budget) {
            return std::ranges::find(budget.parts.front().contributions, "acceleration", &Contribution::source)->ratio;
        };
        CHECK(ratio(budgets[0]) == Approx(1).epsilon(0.12));
        CHECK(ratio(budgets[1]) > 3);  // it assumes a fifth of Q
    }

    const Scenario counting = read_scenario_text("[scenario]\nworld = sourced\nposes = 5\n", "test", "mine");
    const auto counted = [&](std::size_t arm) { return simulation_of(counting)->counted(arm, 1, 3); };
    CHECK(counted(0).trials == 3);
    CHECK(counted(0).sources == std::vector<std::string>{"walk", "measurement"});
    CHECK_THROWS_WITH(counted(1), Catch::Contains("they differ from P by 0.0"));
    CHECK_THROWS_WITH(counted(2), Catch::Contains("Give every source at every step"));
    CHECK(counted(3).trials == 0);
    CHECK_THROWS_WITH(counted(4), Catch::Contains("a source that it does not have counts"));
}

TEST_CASE("own world: the same bits for any number of threads, over shards, and after resuming") {
    const Scenario scenario = tracker();
    const Study whole = run(scenario, 700);
    CHECK(same_results(whole, run(scenario, 700, 3)));
    CHECK_FALSE(same_results(whole, run(scenario, 700, 1, 2)));

    const TemporaryFolder folder;
    std::vector<std::string> parts;
    for (const std::int64_t shard : {1, 0}) {
        StoredRun stored(folder / ("part" + std::to_string(shard)), new_study(std::vector<Scenario>{scenario}, 1),
                         Start::fresh);
        RunOptions options;
        options.trials = 700;
        options.shard = {shard, 2};
        options.keeper = &stored.begin(700, 1, options.shard);
        run_study(stored.study(), options);
        stored.finish({});
        parts.push_back(folder / ("part" + std::to_string(shard)));
    }
    write_results(folder / "whole", merge_results(parts), {});
    CHECK(same_results(read_results(folder / "whole").study, whole));

    StoredRun grown(folder / "whole", new_study(std::vector<Scenario>{scenario}, 1), Start::resume);
    RunOptions options;
    options.trials = 900;
    options.keeper = &grown.begin(900, 1, {});
    run_study(grown.study(), options);
    grown.finish({});
    CHECK(same_results(read_results(folder / "whole").study, run(scenario, 900)));
}

TEST_CASE("own world: arms share their draws, and a setting changes what it should") {
    const Study study = run(tracker(), 300), other = run(tracker({{"sensor.detection", "0.5"}}), 300);
    const auto& columns = study.scenarios[0].columns;
    REQUIRE(columns[1].name == "measurements");
    const auto &kf = study.scenarios[0].arms[0].columns.in_memory(),
               &calm = study.scenarios[0].arms[1].columns.in_memory();
    CHECK(kf[1] == calm[1]);
    CHECK(kf[0] != calm[0]);
    double fewer = 0, all = 0;
    for (const double count : other.scenarios[0].arms[0].columns.in_memory()[1]) fewer += count;
    for (const double count : kf[1]) all += count;
    CHECK(fewer / all == Approx(0.5 / 0.9).margin(0.02));  // 8700 coins: sd 0.006
}

TEST_CASE("own world: trouble in a trial is its status, and changes no other") {
    const Study study = run_spoiled(20);
    const ScenarioResults& results = study.scenarios[0];
    const std::size_t status = status_column(results.columns);
    const auto all_are = [&](std::size_t arm, Status what, double pose) {
        CHECK(statuses(results.arms[arm], status, what) == 20);
        for (const double at : results.arms[arm].columns.in_memory()[status + 1]) CHECK(at == pose);
    };
    all_are(0, Status::completed, -1);
    all_are(1, Status::covariance_not_positive_definite, 3);
    all_are(2, Status::non_finite, 3);
    all_are(3, Status::diverged, -1);
    all_are(4, Status::completed, -1);
    CHECK(results.arms[1].totals.trials.counted() == 0);
    CHECK(results.arms[3].totals.trials.counted() == 0);
    CHECK(results.arms[3].totals.trials.diverged() == 20);
    CHECK(std::isnan(results.arms[1].columns.in_memory()[0][0]));
    // One row was not observed at one of eleven steps; rows stand for themselves from step to step.
    const Evidence sound = evidence_of(results, results.arms[0]), missing = evidence_of(results, results.arms[4]);
    CHECK(sound.nis[0].degrees == 20 * 33);
    CHECK(missing.nis[0].degrees == 20 * 32);
    CHECK(sound.whiteness[0].count == 20 * 10 * 3);
    CHECK(missing.whiteness[0].count == 20 * (10 * 3 - 2));
}

TEST_CASE("own world: series are those of the formulas") {
    // P = I and S = I: NEES |e|^2 with e the draw itself, NIS the same of the innovation.
    const ScenarioResults results = run_spoiled(1).scenarios[0];
    const KeyedDraws<double> draws(1, 0, std::numeric_limits<double>::infinity());
    double nees = 0, nis = 0;
    for (int k = 1; k < 12; ++k) {
        const auto e = draws.normal(static_cast<Source>(0), k, 0), a = draws.normal(static_cast<Source>(1), k, 0);
        const double c = draws.normal(static_cast<Source>(1), k, 1).x;
        nees += e.x * e.x + e.y * e.y;
        nis += a.x * a.x + a.y * a.y + c * c;
    }
    const auto column = [&](const std::string& name) {
        for (std::size_t c = 0; c < results.columns.size(); ++c)
            if (results.columns[c].name == name) return results.arms[0].columns.in_memory()[c][0];
        return std::nan("");
    };
    CHECK(column("trace_P") == 2);
    CHECK(column("squared_error") == Approx(nees).epsilon(1e-14));
    CHECK(column("nees_ratio") == Approx(nees / 11 / 2).epsilon(1e-14));
    CHECK(column("nis_ratio") == Approx(nis / 33).epsilon(1e-14));
    CHECK(column("log_score") == Approx(std::log(2 * std::acos(-1)) + nees / 11 / 2).epsilon(1e-14));
}

TEST_CASE("own world: what a world does wrong is said, not counted") {
    const Scenario shorter = read_scenario_text("[scenario]\nworld = short\n", "test", "mine");
    REQUIRE_THROWS_WITH(run(shorter, 1), "world short: a trial took 18 steps, not 19.");
}

TEST_CASE("own world: its keys are read, refused and shown like any other") {
    CHECK(scenario_text(tracker({{"target.period", "0.5"}})) ==
          "[scenario]\nworld = tracker\nname = mine\ntitle = \nlength_unit = m\nposes = 30\n\n"
          "[target]\nperiod = 0.5\nacceleration = 0.2\n\n[sensor]\nsigma = 2\ndetection = 0.9\n");
    const auto refused = [](const std::string& text, const std::string& message) {
        REQUIRE_THROWS_WITH(read_scenario_text(text, "file.ini", "mine"), Catch::Contains(message));
    };
    refused("[scenario]\nworld = trakcer\n",
            "file.ini:2: invalid scenario.world=trakcer (this program has no such world)");
    refused("[scenario]\nworld = tracker\n[sensor]\ndetection = 2\n", "file.ini:4: invalid sensor.detection=2");
    refused("[scenario]\nworld = tracker\n[sensor]\ndetections = 1\n",
            "file.ini:4: unknown key sensor.detections. Did you mean sensor.detection?");
    refused("[scenario]\nworld = tracker\n[noise]\nheading = 1\n", "file.ini:4: unknown key noise.heading");
}

TEST_CASE("own world: its keys are swept like those of any other") {
    const TemporaryFolder folder;
    std::ofstream(folder / "mine.ini") << "[scenario]\nworld = tracker\nposes = 30\n";
    const std::vector<Scenario> grid = read_grid(folder / "mine.ini", {}, parse_grid({"sensor.sigma=0.5,1"}));
    REQUIRE(grid.size() == 2);
    CHECK(grid[1].name == "mine_sigma-1");
    CHECK(grid[1].sweep == SweepPoint{"mine", {{"sensor.sigma", "1"}}});
    const std::string text = scenario_text(grid[0]);
    CHECK(scenario_text(read_scenario_text(text, "test", "x")) == text);
    CHECK(same_results(run(grid[0], 20), run(tracker({{"sensor.sigma", "0.5"}}), 20)));
    CHECK_THROWS_WITH(read_grid(folder / "mine.ini", {}, parse_grid({"target.period=0"})),
                      Catch::Contains("--sweep target.period: invalid target.period=0"));
    CHECK_THROWS_WITH(read_scenario_text(text.substr(0, text.size() - 4) + "0.7\n", "test", "x"),
                      Catch::Contains("the scenario has sensor.sigma=0.5"));
}

TEST_CASE("own world: the tables of a sweep have its own columns") {
    const TemporaryFolder folder;
    std::ofstream(folder / "own.ini") << "[scenario]\nworld = tracker\nposes = 10\n";
    Study study = new_study(read_grid(folder / "own.ini", {}, parse_grid({"sensor.detection=0.2,0.9"})), 1);
    RunOptions options;
    options.trials = 200;
    run_study(study, options);
    const Report report = make_report(study, 0.05);
    const std::string text = report_text(report), page = report_html(report, {"r.h5", {}, "test"});
    CHECK_THAT(text, Catch::Contains(" measurements "));
    CHECK_THAT(page, Catch::Contains("<th scope=\"col\">measurements</th>"));
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) CHECK(characters(line) < 120);
}

}  // namespace credence::test::own_world_test
