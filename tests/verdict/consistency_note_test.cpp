// The notes beside a verdict, and the limits of verdicts on few trials.

#include "catch.hpp"
#include "matched.hpp"
#include "synthetic.hpp"
#include "of_scenarios.hpp"

#include <credence/consistency.hpp>
#include "statistics/goodness.hpp"
#include <credence/study.hpp>

#include <cmath>
#include <limits>

namespace credence::test::consistency_note_test {

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// Evidence of a state of dimension 1 at one step: N values of NEES.
Evidence evidence_of_values(const std::vector<double>& nees) {
    double sum = 0, squares = 0;
    for (const double value : nees) sum += value, squares += value * value;
    Evidence evidence;
    evidence.trials = static_cast<std::int64_t>(nees.size());
    evidence.steps = 1;
    GroupEvidence group;
    group.name = "all";
    group.dimension = 1;
    group.run = moments_from_sums(evidence.trials, sum, squares);
    group.step = {group.run};
    group.anees.degrees = {static_cast<double>(nees.size())};
    evidence.groups = {group};
    evidence.distribution = {{nan_value}, {nan_value}, false};
    return evidence;
}

Evidence quiet_evidence() {
    std::vector<double> values;
    for (int i = 0; i < 4000; ++i) values.push_back(1 + 0.1 * (i % 2 == 0 ? 1 : -1));
    return evidence_of_values(values);
}

NisEvidence nis_of(double ratio, double half_width) {
    NisEvidence nis;
    nis.part = "all";
    nis.degrees = 1e6;
    nis.ratio = ratio;
    nis.ratio95 = {ratio - half_width, ratio + half_width};
    nis.scale95 = nis.ratio95;
    nis.run = {4000, ratio, half_width / 1.96 * std::sqrt(4000.0), half_width / 1.96};
    return nis;
}

}  // namespace

TEST_CASE("consistency: five trials of one step seldom make a consistent filter pessimistic") {
    // chi-square(1) is as skewed as NEES gets. 2,000 replications at a level of 5 %: over 7 % has probability 3e-5.
    int wrong = 0;
    Normals normals(41);
    for (int replication = 0; replication < 2000; ++replication) {
        std::vector<double> nees;
        for (int i = 0; i < 5; ++i) nees.push_back(normals.chi_square(1));
        const Verdict verdict = judge(evidence_of_values(nees), 0.05).verdict;
        wrong += verdict == Verdict::pessimistic || verdict == Verdict::optimistic || verdict == Verdict::mixed;
    }
    CHECK(wrong < 140);
}

TEST_CASE("consistency: innovations of the wrong size are noted where the state is right") {
    Evidence evidence = quiet_evidence();
    evidence.nis = {nis_of(1.02, 0.01)};
    CHECK(judge(evidence, 0.05).verdict == Verdict::consistent);
    CHECK(judge(evidence, 0.05).cautions.empty());
    evidence.nis = {nis_of(3.9, 0.2)};
    const Consistency verdict = judge(evidence, 0.05);
    CHECK(verdict.verdict == Verdict::consistent);
    REQUIRE(verdict.cautions.size() == 1);
    CHECK(sentence(verdict.cautions.front()) ==
          "optimistic: innovations (all), over all steps, NIS/m 3.9 (3.68 to 4.14)");
    evidence.nis = {nis_of(1.05, 0.02)};  // beyond the margin, but not for sure
    CHECK(judge(evidence, 0.05).cautions.empty());
}

TEST_CASE("consistency: a wrong size of S is not taken for correlation") {
    Study study = new_study({resolved(matched_linear())}, 1);
    run_study(study, {500, 1, {}});
    ScenarioResults& results = study.scenarios.front();
    ArmResults& arm = results.arms.front();
    const Evidence right = evidence_of(results, arm);
    // S four times too small: every nu~ is twice as long, every product four times.
    const auto scale = [](ExactSum& sum) { sum = ExactSum::from_parts({4 * sum.rounded()}); };
    for (ExactSum& sum : arm.totals.products.sum) scale(sum);
    for (std::size_t f = 0; f < results.all_series.size(); ++f)
        if (results.all_series[f].role == SeriesRole::nis)
            for (ExactSum& sum : arm.totals.series[f].sum) scale(sum);
    const Evidence wrong = evidence_of(results, arm);
    for (std::size_t lag = 0; lag < right.whiteness.size(); ++lag) {
        CHECK(wrong.whiteness[lag].correlation == Approx(4 * right.whiteness[lag].correlation).epsilon(1e-12));
        CHECK(wrong.whiteness[lag].scaled == Approx(right.whiteness[lag].scaled).epsilon(1e-12));
    }
    CHECK(wrong.nis.front().ratio == Approx(4).margin(0.1));
}

TEST_CASE("consistency: a single trial decides nothing, whatever its innovations say") {
    Evidence evidence = evidence_of_values({1.3});
    evidence.nis = {nis_of(1.01, 0.01)};
    evidence.whiteness = {{1, 1'000'000, 0.001, 0.001, 0.00196, 0.00196}};
    CHECK(judge(evidence, 0.05).verdict == Verdict::undecided);
    evidence.nis = {nis_of(8, 0.01)};
    CHECK(judge(evidence, 0.05).verdict == Verdict::undecided);
    CHECK(judge(evidence, 0.05).reasons.front() == "one trial decides nothing: give more trials");
    CHECK(judge(evidence_of_values({100}), 0.05).verdict == Verdict::optimistic);  // of any correlation of its steps
    CHECK(judge(evidence_of_values({1e-9}), 0.05).verdict == Verdict::pessimistic);
}

}  // namespace credence::test::consistency_note_test
