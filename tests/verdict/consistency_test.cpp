// The verdict. Every kind has a case that must get it and one that must not.

#include "catch.hpp"
#include "either_way.hpp"
#include "matched.hpp"
#include "of_scenarios.hpp"

#include <credence/consistency.hpp>
#include <credence/study.hpp>

#include <algorithm>

namespace credence::test::consistency_test {

namespace {

ScenarioResults simulated(const DeformableSettings& scenario, std::int64_t trials) {
    validate(scenario);
    Study study = new_study({resolved(scenario)}, 1);
    run_study(study, {trials, 0, {}});
    return study.scenarios.front();
}

Evidence evidence_of_first_arm(const ScenarioResults& results) { return evidence_either_way(results); }

Consistency verdict_of(const DeformableSettings& scenario, std::int64_t trials, double margin = 0.05) {
    return judge(evidence_of_first_arm(simulated(scenario, trials)), margin);
}

double ratio(const Evidence& evidence, const std::string& group) {
    for (const GroupEvidence& b : evidence.groups)
        if (b.name == group) return b.run.mean;
    FAIL("no group " << group);
    return 0;
}

bool has(const Consistency& consistency, Fault what, const std::string& where) {
    return std::any_of(consistency.findings.begin(), consistency.findings.end(),
                       [&](const Finding& f) { return f.what == what && f.where == where; });
}

}  // namespace

TEST_CASE("consistency: the matched linear filter is consistent", "[long]") {
    const Evidence evidence = evidence_of_first_arm(simulated(matched_linear(), 20000));
    const Consistency c = judge(evidence, 0.05);
    CHECK(verdict_name(c.verdict) == "consistent");
    CHECK(c.findings.empty());
    // model.md: 0.9989 +- 0.0039 of 3,000 trials; 20,000 trials have a standard error of 0.0015. 4 sigma: 6e-5.
    CHECK(ratio(evidence, "all") == Approx(1).margin(0.006));
}

TEST_CASE("consistency: the same filter is undecided with few trials, and the trials that decide are named") {
    const Consistency c = verdict_of(matched_linear(), 200);
    CHECK(verdict_name(c.verdict) == "undecided");
    CHECK(c.trials_needed.value > 200);
    CHECK(c.trials_needed.value < 20000);
    CHECK(c.trials_needed.low < c.trials_needed.value);
    CHECK(c.trials_needed.high > c.trials_needed.value);
    CHECK_FALSE(c.reasons.empty());
}

TEST_CASE("consistency: few trials do not make a consistent filter look inconsistent", "[long]") {
    // 100 studies of N trials of the matched filter. The corrected level is 5 %: more than 12 of 100 has probability
    // 4e-4.
    for (const std::int64_t trials : {20, 50, 100}) {
        int wrong = 0;
        for (std::uint64_t seed = 1; seed <= 100; ++seed) {
            Study study = new_study({resolved(matched_linear())}, seed);
            run_study(study, {trials, 1, {}});
            const Verdict verdict = judge(evidence_of_first_arm(study.scenarios.front()), 0.05).verdict;
            wrong += verdict != Verdict::undecided && verdict != Verdict::consistent;
        }
        CAPTURE(trials);
        CHECK(wrong <= 12);
    }
}

TEST_CASE("consistency: assuming 0.8 of the measurement noise, a filter is optimistic in its features only") {
    DeformableSettings s = matched_linear();
    s.filter.measurement = 0.8;
    const Evidence evidence = evidence_of_first_arm(simulated(s, 4000));
    const Consistency c = judge(evidence, 0.05);
    CHECK(verdict_name(c.verdict) == "optimistic");
    // model.md: 1.382 (all), 0.98 (pose), 1.16 to 1.17 (each feature), 1,500 trials, +- 0.006, 0.02, 0.015.
    CHECK(ratio(evidence, "all") == Approx(1.382).margin(0.02));
    CHECK(ratio(evidence, "pose") == Approx(0.99).margin(0.05));
    CHECK(ratio(evidence, "feature_1") == Approx(1.165).margin(0.04));
    CHECK(has(c, Fault::optimistic, "all"));
    CHECK_FALSE(has(c, Fault::optimistic, "pose"));
}

TEST_CASE("consistency: a reported covariance 1.1 times too large is pessimistic", "[long]") {
    DeformableSettings s = matched_linear();
    s.filter.covariance = 1.1;
    const Evidence evidence = evidence_of_first_arm(simulated(s, 20000));
    const Consistency c = judge(evidence, 0.05);
    CHECK(verdict_name(c.verdict) == "pessimistic");
    CHECK(ratio(evidence, "all") == Approx(1 / 1.1).margin(0.006));
    CHECK(has(c, Fault::pessimistic, "all"));
}

TEST_CASE("consistency: errors that cancel in one average are mixed", "[long]") {
    // Measured before: the reference study's EKF with sigma_head = 0.042: 0.97 over all, 1.20 for the pose, 0.70 for
    // the features.
    DeformableSettings s;
    s.noise.heading = 0.042;
    s.arms.controllers = {Controller::fixed};
    const Evidence evidence = evidence_of_first_arm(simulated(s, 10000));
    const Consistency c = judge(evidence, 0.05);
    CHECK(verdict_name(c.verdict) == "mixed");
    CHECK(ratio(evidence, "all") == Approx(0.97).margin(0.04));
    CHECK(has(c, Fault::optimistic, "pose"));
    CHECK(has(c, Fault::pessimistic, "features"));
}

TEST_CASE("consistency: a bias of one component is found and named, and keeps a filter from being consistent",
          "[long]") {
    ScenarioResults results = simulated(matched_linear(), 20000);
    REQUIRE(judge(evidence_of_first_arm(results), 0.05).verdict == Verdict::consistent);
    const auto bias = std::find_if(results.all_series.begin(), results.all_series.end(),
                                   [](const Series& f) { return f.name == "standardised_error_f1_x"; });
    REQUIRE(bias != results.all_series.end());
    SeriesTotals& totals =
        results.arms.front().totals.series[static_cast<std::size_t>(bias - results.all_series.begin())];
    for (const double share : {0.05, 0.2}) {  // of a sigma: within the margin, and beyond it
        for (ExactSum& step : totals.sum) step.add(20000 * share);
        const Consistency c = judge(evidence_of_first_arm(results), 0.05);
        CAPTURE(share);
        REQUIRE(c.findings.size() == (share > 0.1 ? 1 : 0));
        CHECK(verdict_name(c.verdict) == (share > 0.1 ? "optimistic" : "consistent"));
        if (c.findings.empty()) continue;
        CHECK(c.findings.front().what == Fault::biased);
        CHECK(c.findings.front().where == "f1_x");
        CHECK(c.findings.front().when.starts_with("over all steps"));
    }
}

TEST_CASE("consistency: a dropped correlation, which mean NEES cannot see, is found as a direction", "[long]") {
    // Errors of two components with correlation 0.5; the filter's P has none, and the right variances.
    ScenarioResults results = simulated(matched_linear(), 600);
    ArmResults& arm = results.arms.front();
    const auto n = static_cast<std::size_t>(results.state_size()), groups = results.scenario.groups.size(),
               size = static_cast<std::size_t>(results.moment_count()), place = groups + n + 1;  // of e1 e0, row 1 of S
    const auto at = [&](std::size_t trial, std::size_t entry) -> double& { return arm.moments[trial * size + entry]; };
    for (std::size_t trial = 0; trial < 600; ++trial)
        // S_10 by 0.5 of the mean variance.
        at(trial, place) += 0.5 * 0.5 * (at(trial, place - 1) + at(trial, place + 1));
    const Consistency c = judge(evidence_of_first_arm(results), 0.05);
    CHECK(verdict_name(c.verdict) == "mixed");
    const auto direction = std::find_if(c.findings.begin(), c.findings.end(), [](const Finding& f) {
        return f.what == Fault::optimistic && f.about == Subject::direction;
    });
    REQUIRE(direction != c.findings.end());
    CHECK_THAT(direction->when, Catch::Contains("r_x") && Catch::Contains("r_y"));
    CHECK(when_text(*direction) == "direction " + direction->when);
    CHECK(direction->value > 1.4);  // 1.5 were the two not correlated with the others
}

TEST_CASE("consistency: trouble at some steps only is found there", "[long]") {
    ScenarioResults results = simulated(matched_linear(), 20000);
    SeriesTotals& whole = results.arms.front().totals.series.front();
    for (const std::size_t k : {2u, 3u, 4u, 8u}) {  // 10 % more NEES at steps 3 to 5 and 9
        whole.sum[k].add(0.1 * whole.sum[k].rounded());
        whole.square_sum[k].add(0.21 * whole.square_sum[k].rounded());
    }
    const Consistency c = judge(evidence_of_first_arm(results), 0.05);
    CHECK(verdict_name(c.verdict) == "optimistic");
    REQUIRE(c.findings.size() == 1);
    CHECK(c.findings.front().where == "all");
    CHECK(c.findings.front().when == "steps 3 to 5, 9");
    CHECK(sentence(c.findings.front()).find("optimistic: all, steps 3 to 5, 9, NEES/dim 1.1") == 0);
}

TEST_CASE("consistency: a wider margin forgives more", "[long]") {
    DeformableSettings s = matched_linear();
    s.filter.covariance = 1.1;
    CHECK(verdict_name(verdict_of(s, 20000, 0.15).verdict) == "consistent");
}

TEST_CASE("consistency: of failed trials exactly the share is not more, whatever the rounding of share times trials") {
    for (const std::int64_t all : {100LL, 1000LL, 29'000LL, 1'000'000LL, 999'983LL * 1000})
        for (std::int64_t percent = 0; percent <= 100; ++percent) {
            const std::int64_t exact = all / 100 * percent;
            const double share = static_cast<double>(percent) / 100;
            CAPTURE(all, percent);
            CHECK_FALSE(too_many_failed(exact, all, share));
            CHECK(too_many_failed(exact + 1, all, share));
        }
    CHECK_FALSE(too_many_failed(0, 0, 0));
}

TEST_CASE("consistency: trials that failed and trials that diverged count alike as failed") {
    Evidence evidence;
    evidence.all_trials = 200;
    for (const auto& [left_out, diverged, verdict] :
         {std::tuple(2, 0, Verdict::undecided), std::tuple(0, 2, Verdict::undecided), std::tuple(3, 0, Verdict::failed),
          std::tuple(0, 3, Verdict::failed), std::tuple(2, 1, Verdict::failed)}) {
        CAPTURE(left_out, diverged);
        evidence.left_out = left_out;
        evidence.diverged = diverged;
        evidence.trials = 200 - left_out - diverged;
        CHECK(judge(evidence, 0.05).verdict == verdict);
        CHECK(judge(evidence, {0.05, 0.02}).verdict == Verdict::undecided);
    }
}

}  // namespace credence::test::consistency_test
