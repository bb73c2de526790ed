// The budget of an error by its sources: against the study itself, the closed form of a linear filter, and P.

#include "catch.hpp"
#include "landmark_loop.hpp"
#include "matched.hpp"
#include "study/budget.hpp"
#include "support.hpp"
#include "worlds/explore/explore.hpp"

#include <credence/detail/draws.hpp>
#include <credence/text.hpp>

#include <cmath>
#include <random>
#include <set>

namespace credence::test::budget_test {

namespace {

Study study_with(const std::vector<Scenario>& scenarios, std::int64_t trials, int threads = 1) {
    Study study = new_study(scenarios, 3);
    RunOptions options;
    options.trials = trials;
    options.threads = threads;
    run_study(study, options);
    return study;
}

std::vector<double> numbers_of(const std::vector<ArmBudget>& budgets) {
    std::vector<double> numbers;
    for (const ArmBudget& budget : budgets)
        for (const BudgetPart& one : budget.parts) {
            numbers.insert(numbers.end(), {one.mean, one.interactions, one.rss, one.rmse, one.p_says});
            for (const Contribution& source : one.contributions)
                numbers.insert(numbers.end(), {source.alone95.low, source.alone95.high, source.with_others,
                                               source.p_counts});
        }
    return numbers;
}

}  // namespace

TEST_CASE("budget: only the draws of the named sources are another world's, and pose 0 is apart") {
    const std::uint32_t walk = source_bit(Source::walk, 1), start = source_bit(Source::walk, 0);
    const KeyedDraws<double> own(1, 2, 9), later(1, 2, 9, walk), first(1, 2, 9, start);
    for (int pose = 0; pose < 3; ++pose)
        for (const Source source : {Source::walk, Source::measurement, Source::detection}) {
            CAPTURE(pose, static_cast<int>(source));
            const double x = own.normal(source, pose, 1).x, u = own.uniform(source, pose, 1);
            const bool is_walk = source == Source::walk;
            CHECK((later.normal(source, pose, 1).x == x) == !(is_walk && pose > 0));
            CHECK((first.normal(source, pose, 1).x == x) == !(is_walk && pose == 0));
            CHECK((later.uniform(source, pose, 1) == u) == !(is_walk && pose > 0));
        }
}

TEST_CASE("budget: its first world is the scenario itself, bit for bit, and the others differ from it and each other") {
    DeformableSettings settings = scenario_with({{"scenario.poses", "5"}, {"sensor.noise", "ranged"}});
    settings.planner.speeds = 1;
    const Scenario scenario = scenario_of(settings);
    const Study plain = study_with({scenario}, 300),
                worlds = study_with(budget_scenarios(scenario, KeptErrors::last), 300);
    REQUIRE(worlds.scenarios.size() == 2 + 2 * world_of(scenario).sources(scenario).size());
    for (std::size_t arm = 0; arm < 2; ++arm) {
        const auto own = [&](const ScenarioResults& results, std::size_t column) {
            return column_values(results, results.arms[arm], column);
        };
        for (std::size_t c = 0; c < column_count - 2; ++c)
            CHECK(own(worlds.scenarios[0], c) == own(plain.scenarios[0], c));
        std::set<std::vector<double>> different;
        for (const ScenarioResults& results : worlds.scenarios) different.insert(own(results, column_pose_error));
        CHECK(different.size() == worlds.scenarios.size());
    }
    // The kept errors are those of the trial: the squared error of the position at the last step is their sum.
    const ScenarioResults& first = worlds.scenarios.front();
    const std::size_t error = column_count - 2;
    CHECK(first.columns[error + 1].name == "error_r_x");
    double squares = 0;
    for (const std::size_t axis : {std::size_t{1}, std::size_t{2}})
        for (const double e : column_values(first, first.arms[0], error + axis)) squares += e * e;
    const auto series = std::ranges::find(first.all_series, "squared_error_position", &Series::name);
    const auto place = static_cast<std::size_t>(series - first.all_series.begin());
    const SeriesTotals& total = first.arms[0].totals.series[place];
    CHECK(squares == Approx(total.sum.back().rounded()).epsilon(1e-12));  // sums of 300 numbers in another order
}

TEST_CASE("budget: of a linear filter that is right, every source is what P counts for it") {
    DeformableSettings settings = matched_linear();
    settings.poses = 6;
    settings.noise.initial_position = 0.1;
    for (const KeptErrors kept : {KeptErrors::last, KeptErrors::mean}) {
        const Study study = study_with(budget_scenarios(scenario_of(settings), kept), 2000);
        const ArmBudget budget = budgets_of(study).front();
        CHECK(budget.sources ==
              std::vector<std::string>{"start", "odometry", "measurement", "walk", "deformation", "edges"});
        CHECK(budget.counted_trials == 256);
        int beyond = 0, intervals = 0;
        for (const BudgetPart& one : budget.parts) {
            CHECK(one.closes);
            CHECK(one.interactions < 1e-6 * one.rmse);
            CHECK(one.ratio == Approx(1).margin(0.12));  // 2 sqrt(2/4000) of two worlds and at least two components
            double counted = 0;
            for (const Contribution& source : one.contributions) {
                counted += source.p_counts * source.p_counts;
                ++intervals;
                beyond += source.p_counts < source.alone95.low || source.p_counts > source.alone95.high;
            }
            CHECK(std::sqrt(counted) == Approx(one.p_says).epsilon(1e-9));
        }
        CHECK(intervals >= 60);
        CHECK(beyond < 0.15 * intervals);  // 5 % are expected; the parts share their draws
    }
}

TEST_CASE("budget: what P counts for the sources adds up to P, for every estimator of every world") {
    DeformableSettings settings = scenario_with({{"noise.heading", "0.05"}, {"features.path", "circle"},
                                                 {"arms.estimators", "ekf, ideal, fej, riekf, iekf"},
                                                 {"noise.initial_heading", "0.1"}, {"sensor.detection", "0.8"},
                                                 {"filter.gate", "0.99"}, {"filter.measurement", "1.3"}});
    settings.poses = 8;
    settings.planner.speeds = 1;
    settings.budget.errors = KeptErrors::mean;
    ExploreSettings landmarks = landmark_loop(30, {20, 1, 8, 1});
    landmarks.budget.errors = KeptErrors::mean;
    ExploreSettings explore;
    explore.poses = 12;
    explore.features.count = 6;
    explore.features.extent = 8;
    explore.noise.initial_heading = 0.1;
    explore.sensor.detection = 0.8;
    explore.filter.gate = 0.99;
    explore.filter.measurement = 1.3;
    explore.walls = {{{-2, 1}, {2, 1}}};  // which hides landmarks, and ends no motion along the path
    explore.arms.estimators = {Estimator::ekf, Estimator::ideal, Estimator::fej, Estimator::riekf, Estimator::iekf};
    explore.budget.errors = KeptErrors::mean;
    ExploreSettings with_prior = explore, known = explore;
    with_prior.map = LandmarkMap::prior;
    known.map = LandmarkMap::known;
    for (const Scenario& scenario : {scenario_of(settings), scenario_of(resolved(landmarks)), scenario_of(resolved(explore)),
                                     scenario_of(resolved(with_prior)), scenario_of(resolved(known))})
        for (std::size_t arm = 0; arm < scenario.arms.size(); ++arm) {
            CAPTURE(scenario.arms[arm]);
            const CountedVariances counted = simulation_of(scenario)->counted(arm, 3, 40);  // or it throws
            CHECK(counted.trials == 40);
            const Study study = study_with({scenario}, 40);
            const ScenarioResults& results = study.scenarios.front();
            const std::size_t n = scenario.components.size(),
                              steps = kept_steps(KeptErrors::mean, results.steps()).size(),
                              first = results.columns.size() - 2 - 2 * steps * n;
            for (std::size_t j = 0; j < n; ++j) {
                double sum = 0, says = 0, there = 0;
                for (const std::vector<double>& variance : counted.variance) sum += variance[j];
                for (std::size_t k = 0; k < steps; ++k) {
                    const auto at = [&](std::size_t row) {
                        return column_values(results, results.arms[arm], first + row * n + j);
                    };
                    const std::vector<double> errors = at(k), variances = at(steps + k);
                    for (std::size_t i = 0; i < errors.size(); ++i)
                        if (!std::isnan(errors[i])) says += variances[i], ++there;
                }
                CHECK(sum == Approx(there > 0 ? says / there : 0).epsilon(1e-9));
            }
        }
}

TEST_CASE("budget: the numbers are the same on any number of threads") {
    ExploreSettings explore;
    explore.poses = 6;
    for (const Scenario& scenario : {scenario_of(matched_linear()), scenario_of(resolved(explore))}) {
        const std::vector<Scenario> worlds = budget_scenarios(scenario, KeptErrors::last);
        const std::vector<double> one = numbers_of(budgets_of(study_with(worlds, 600, 1))),
                                  three = numbers_of(budgets_of(study_with(worlds, 600, 3)));
        REQUIRE(one.size() == three.size());
        for (std::size_t i = 0; i < one.size(); ++i)
            CHECK((one[i] == three[i] || (std::isnan(one[i]) && std::isnan(three[i]))));
    }
}

TEST_CASE("budget: of a component that is absent in some trials it is that of the other trials alone") {
    std::mt19937_64 rng(4);
    std::normal_distribution<double> normal;
    constexpr std::size_t trials = 200, runs = 6;
    std::vector<std::vector<double>> errors(runs, std::vector<double>(trials)), some(runs);
    std::vector<char> there(trials);
    for (std::size_t i = 0; i < trials; ++i) {
        there[i] = i % 3 != 1;
        const double u[] = {normal(rng), normal(rng)}, v[] = {normal(rng), normal(rng)};
        const double all[] = {u[0] + v[0], u[1] + v[1], u[1] + v[0], u[0] + v[1], u[0] + v[1], u[1] + v[0]};
        for (std::size_t run = 0; run < runs; ++run) {
            errors[run][i] = there[i] ? 0.3 + all[run] : std::nan("");
            if (there[i]) some[run].push_back(0.3 + all[run]);
        }
    }
    const auto budget = [](const std::vector<std::vector<double>>& all, std::vector<std::vector<char>> mask) {
        BudgetErrors one{{"u", "v"}, all.front().size(), 1, {{"x", "m"}}, {},
                         [&](std::size_t run, std::size_t) { return all[run]; }};
        one.there = std::move(mask);
        one.variance = {1.7};
        return budget_parts(one).front();
    };
    const BudgetPart whole = budget(errors, {there}), rest = budget(some, {});
    CHECK(whole.there == Approx(133 / 200.0));
    CHECK(rest.there == 1);
    CHECK(whole.mean == Approx(rest.mean));  // the same sums in another order
    CHECK(whole.rss == Approx(rest.rss));
    CHECK(whole.rmse == Approx(rest.rmse));
    CHECK(whole.ratio == Approx(rest.ratio));
    REQUIRE(whole.contributions.size() == 2);
    for (std::size_t s = 0; s < 2; ++s) {
        CHECK(whole.contributions[s].alone == Approx(rest.contributions[s].alone));
        CHECK(whole.contributions[s].with_others == Approx(rest.contributions[s].with_others));
        CHECK(whole.contributions[s].share == Approx(rest.contributions[s].share));
        const Interval &own = whole.contributions[s].alone95, &of_rest = rest.contributions[s].alone95;
        CHECK(own.high - own.low == Approx(of_rest.high - of_rest.low).epsilon(0.15));  // that the share is drawn, too
    }
}

TEST_CASE("budget: worlds that are there already, or are missing, are refused") {
    const Scenario scenario = scenario_of(matched_linear());
    const std::vector<Scenario> worlds = budget_scenarios(scenario, KeptErrors::last);
    CHECK_THROWS_WITH(budget_scenarios(worlds[2], KeptErrors::last), Catch::Contains("as the worlds of a budget do"));
    CHECK_THROWS_WITH(budgets_of(study_with({scenario}, 2)), Catch::Contains("the study has no budget"));
    CHECK_THROWS_WITH(budgets_of(study_with({worlds[0], worlds[1]}, 2)), Catch::Contains("are missing"));
    CHECK_THROWS_WITH(budgets_of(study_with(worlds, 1)), Catch::Contains("1 of 1 trials completed"));
}

}  // namespace credence::test::budget_test
