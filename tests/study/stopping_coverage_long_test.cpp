// The interval at which a study stops covers the truth as often as it says, early stopping included.
// Replications with fixed seeds; each one runs the production's analyses and decisions.

#include "catch.hpp"
#include "matched.hpp"
#include "synthetic.hpp"

#include <credence/detail/exact_moments.hpp>
#include <credence/statistics.hpp>
#include "study/stopping.hpp"

#include <cmath>

namespace credence::test::stopping_coverage_long_test {

namespace {

/// How a replication went over many of them.
struct Replicated {
    int missed = 0;                 ///< last intervals that do not cover the truth
    std::vector<int> stops;         ///< by analysis
    int analyses_used() const {
        int used = 0;
        for (const int count : stops) used += count > 20;
        return used;
    }
};

/// Draws until the goal is met; `draw(normals)` is one value.
template <class Draw, class Decide>
Replicated replicate(int replications, const StoppingRule& rule, double truth, Draw draw, Decide decision) {
    Replicated result;
    result.stops.resize(analysis_trials(rule.ceiling, rule.first_analysis).size());
    for (int r = 0; r < replications; ++r) {
        Normals normals(static_cast<std::uint64_t>(r) + 1);
        std::vector<double> values;
        const InterimAnalysis last = run_analyses(rule, [&](std::int64_t trials, int number) {
            while (values.size() < static_cast<std::size_t>(trials)) values.push_back(draw(normals));
            const GoalState state = decision(values, rule.goals.front(), number);
            return InterimAnalysis{trials, number, analysis_alpha(number), {state}, state.met()};
        });
        result.missed += std::abs(last.states.front().mean - truth) > last.states.front().half_width;
        ++result.stops[static_cast<std::size_t>(last.number - 1)];
    }
    return result;
}

GoalState decided(const std::vector<double>& values, const StoppingGoal& goal, int number) {
    return decide(moments_of(exact_moments(values)), goal, number);
}

/// Most misses of intervals that miss with 5 %: four standard deviations of the binomial above, 3e-5 beyond.
int most_missed(int replications) {
    return static_cast<int>(0.05 * replications + 4 * std::sqrt(0.0475 * replications));
}

double normal_draw(Normals& normals) { return 10 + normals(); }
double exponential_draw(Normals& normals) { return normals.chi_square(2) / 2; }

/// The half-width that a sample of sd 1 has at `times` the first analysis's trials: later analyses then matter.
StoppingRule rule_of(std::int64_t first_analysis, double times, const std::string& unit = "") {
    const double width = 2.2414 / std::sqrt(static_cast<double>(first_analysis) * times) * (unit == "%" ? 100 : 1);
    return {{parse_goal("x=" + std::to_string(width) + unit)}, first_analysis * 16 + 7, first_analysis};
}

}  // namespace

TEST_CASE("stopping: intervals of normal values cover the truth in 95 %, stopped at any analysis", "[long]") {
    for (const double times : {0.8, 1.4, 2.8}) {
        const Replicated r = replicate(2000, rule_of(16, times), 10, normal_draw, decided);
        CAPTURE(times, r.missed, r.stops);
        CHECK(r.missed <= most_missed(2000));
        CHECK(r.analyses_used() >= 2);
    }
}

TEST_CASE("stopping: intervals of exponential values cover the truth in 95 %, stopped at any analysis", "[long]") {
    // Where the sample's spread is small, so is its mean: stopping prefers samples that miss.
    for (const double times : {0.8, 1.4, 2.8}) {
        const Replicated r = replicate(2000, rule_of(64, times), 1, exponential_draw, decided);
        CAPTURE(times, r.missed, r.stops);
        CHECK(r.missed <= most_missed(2000));
        CHECK(r.analyses_used() >= 2);
    }
    const Replicated relative = replicate(2000, rule_of(64, 1.4, "%"), 1, exponential_draw, decided);
    CAPTURE(relative.missed, relative.stops);
    CHECK(relative.missed <= most_missed(2000));
    CHECK(relative.analyses_used() >= 2);
}

TEST_CASE("stopping: so they do at the first analysis that is used, 4096 trials", "[long]") {
    const Replicated r = replicate(2000, rule_of(first_analysis_trials, 1), 1, exponential_draw, decided);
    CAPTURE(r.missed, r.stops);
    CHECK(r.missed <= most_missed(2000));
    CHECK(r.analyses_used() >= 2);
}

TEST_CASE("stopping: intervals that were not widened would cover too rarely, and be found out", "[long]") {
    const auto plain = [](const std::vector<double>& values, const StoppingGoal& goal, int) {
        const Summary summary = summarise(values);
        return GoalState{"", summary.count, summary.mean, summary.standard_deviation,
                         (summary.ci95.high - summary.ci95.low) / 2, goal.half_width};
    };
    CHECK(replicate(2000, rule_of(64, 2), 1, exponential_draw, plain).missed > most_missed(2000));
}

TEST_CASE("stopping: the engine's own intervals cover, where the truth is known exactly", "[long]") {
    // The matched linear world: NEES ~ chi-square(n) and NIS ~ chi-square(m), both ratios have mean 1 [docs/model.md,
    // Truth against filter].
    DeformableSettings matched = matched_linear();
    matched.poses = 8;
    const StoppingRule rule{{parse_goal("nees_ratio=3.4%"), parse_goal("nis_ratio=0.0225")}, 5000, 256};
    constexpr int seeds = 200;
    int missed[2] = {0, 0}, beyond_the_first = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        Study study = new_study({resolved(matched)}, seed);
        const InterimAnalysis analysis = run_until(study, rule, {0, 1, {}});
        REQUIRE(analysis.met);
        for (std::size_t g = 0; g < 2; ++g)
            missed[g] += std::abs(analysis.states[g].mean - 1) > analysis.states[g].half_width;
        beyond_the_first += analysis.number > 1;
    }
    CAPTURE(missed[0], missed[1], beyond_the_first);
    CHECK(missed[0] <= most_missed(seeds));
    CHECK(missed[1] <= most_missed(seeds));
    CHECK(beyond_the_first > 20);
    CHECK(beyond_the_first < 180);
}

}  // namespace credence::test::stopping_coverage_long_test
