// The same machinery on draws made elsewhere. NumPy's normal draws are errors and innovations of a filter that
// is right; their totals are put together here by hand, and every figure of the evidence must be what SciPy computes
// from the values (tests/reference/make_chi_square.py).

#include <credence/consistency.hpp>

#include "statistics/mean_bounds.hpp"
#include "calibration_draws.hpp"

namespace credence::test::calibration_reference_long_test {

using namespace credence::test::drawn;

namespace {

Evidence evidence(double claimed = 1) {
    const ScenarioResults all = results(claimed);
    return evidence_of(all, all.arms.front());
}

void check_list(const std::vector<double>& values, const Json& expected) {
    REQUIRE(values.size() == expected.size());
    for (std::size_t i = 0; i < values.size(); ++i) check_agrees(values[i], number(expected[i]));
}

void check_intervals(const std::vector<Interval>& values, const Json& expected) {
    REQUIRE(values.size() == expected.size());
    for (std::size_t i = 0; i < values.size(); ++i) check_agrees(values[i], expected[i]);
}

void check_moments(const Moments& moments, const Json& expected) {
    CHECK(moments.count == trials);
    check_agrees(moments.mean, number(expected["mean"]));
    check_agrees(moments.standard_deviation, number(expected["sd"]));
    check_agrees(moments.standard_error, number(expected["se"]));
}

void check_banded(const BandedRatio& ratio, const Json& expected) {
    check_list(ratio.degrees, expected["degrees"]);
    check_list(ratio.ratio, expected["ratio"]);
    check_intervals(ratio.band, expected["band"]);
    check_intervals(ratio.simultaneous_band, expected["simultaneous_band"]);
    CHECK(ratio.outside == expected["outside_band"]);
    CHECK(ratio.outside_simultaneous == expected["outside_simultaneous_band"]);
}

void check_accuracy(const Accuracy& accuracy, const Json& expected) {
    check_list(accuracy.rmse, expected["rmse"]);
    check_list(accuracy.predicted, expected["predicted"]);
    check_agrees(accuracy.over_steps, number(expected["over_steps"]));
    check_agrees(accuracy.ratio, number(expected["ratio"]));
    check_agrees(accuracy.ratio_ci95, expected["interval"]);
}

}  // namespace

TEST_CASE("calibration: NEES, coverage and accuracy of NumPy's draws are what SciPy computes from their values") {
    const Evidence found = evidence();
    CHECK(found.trials == trials);
    REQUIRE(found.groups.size() == expected()["groups"].size());
    for (std::size_t b = 0; b < found.groups.size(); ++b) {
        const GroupEvidence& group = found.groups[b];
        const Json& theirs = expected()["groups"][b];
        CAPTURE(group.name);
        CHECK(group.name == theirs["group"]);
        CHECK(group.dimension == theirs["dimension"]);
        check_moments(group.run, theirs["run"]);
        check_agrees(over_steps95(group), theirs["interval"]);
        for (std::size_t k = 0; k < steps; ++k) check_moments(group.step[k], theirs["step"][k]);
        check_banded(group.anees, theirs["anees"]);
        check_list(group.variance_ratio, theirs["variance_ratio"]);
        for (std::size_t level = 0; level < coverage_level_count; ++level) {
            check_list(group.coverage[level].share, theirs["coverage"][level]["share"]);
            check_intervals(group.coverage[level].interval, theirs["coverage"][level]["interval"]);
            check_agrees(group.coverage[level].over_steps, number(theirs["coverage"][level]["over_steps"]));
        }
        check_accuracy(group.accuracy, theirs["accuracy"]);
    }
}

TEST_CASE("calibration: NIS of rows that vary has their number of degrees, and whiteness is SciPy's") {
    const Evidence found = evidence();
    REQUIRE(found.nis.size() == 1);
    const NisEvidence& nis = found.nis.front();
    CHECK(nis.degrees < 0.75 * trials * steps * rows);  // N m would be 4000; 30 % of the rows were not observed
    check_banded(nis.nis, expected()["nis"]["nis"]);
    check_agrees(nis.degrees, number(expected()["nis"]["degrees"]));
    check_agrees(nis.ratio, number(expected()["nis"]["ratio"]));
    check_agrees(nis.scale95, expected()["nis"]["scale95"]);
    check_agrees(nis.ratio95, expected()["nis"]["ratio95"]);
    REQUIRE(found.whiteness.size() == lags);
    for (std::size_t i = 0; i < lags; ++i) {
        const Json& theirs = expected()["whiteness"][i];
        CHECK(found.whiteness[i].lag == theirs["lag"]);
        CHECK(found.whiteness[i].count == theirs["count"]);
        check_agrees(found.whiteness[i].correlation, number(theirs["correlation"]));
        check_agrees(found.whiteness[i].scaled, number(theirs["scaled"]));
    }
}

TEST_CASE("calibration: the correlation of innovations has Student's interval by the spread of the trials") {
    ScenarioResults made = results(1);
    ProductTotals& products = made.arms.front().totals.products;
    for (std::size_t i = 0; i < lags; ++i)
        products.square_sum[i] = ExactSum::from_parts({2.0 * static_cast<double>(products.count[i])});
    const Evidence found = evidence_of(made, made.arms.front());
    for (std::size_t i = 0; i < lags; ++i) {
        const double N = trials, p = products.sum[i].rounded(), c = static_cast<double>(products.count[i]);
        const double sd = std::sqrt((2 * c - p * p / N) / (N - 1)),
                     half = sd / std::sqrt(N) / (c / N) / found.nis.front().ratio;
        check_agrees(found.whiteness[i].bound, t_quantile(0.05, N - 1) * half);
        check_agrees(found.whiteness[i].simultaneous_bound, t_quantile(0.05 / lags, N - 1) * half);
    }
}

TEST_CASE("calibration: bias, distribution and credibility of NumPy's draws are SciPy's") {
    const Evidence found = evidence();
    REQUIRE(found.bias.size() == n);
    for (std::size_t j = 0; j < n; ++j)
        for (std::size_t k = 0; k < steps; ++k) check_moments(found.bias[j].step[k], expected()["bias"][j]["step"][k]);
    const Json& distribution = expected()["distribution"];
    CHECK_FALSE(found.distribution.exact);
    check_list(found.distribution.distance, distribution["cell_distance"]);
    check_list(found.distribution.p, distribution["cell_p"]);
    const Json& credibility = expected()["credibility"];
    for (std::size_t k = 0; k < steps; ++k) {
        CHECK(found.credibility.step[k].count == trials);
        check_agrees(found.credibility.step[k].nci, number(credibility["nci_by_step"][k]));
        check_agrees(found.credibility.step[k].inclination, number(credibility["inclination_by_step"][k]));
        CHECK(distribution["distance"][k] >= distribution["cell_distance"][k]);
        CHECK(distribution["distance"][k] <= distribution["cell_distance"][k].get<double>() + 1.0 / distribution_cells);
    }
    check_agrees(found.credibility.nci, number(credibility["nci"]));
    check_agrees(found.credibility.inclination, number(credibility["inclination"]));
    ScenarioResults exact = results(1);
    exact.arms.front().totals.distribution_distance = numbers(distribution["distance"]);
    check_list(evidence_of(exact, exact.arms.front()).distribution.p, distribution["p"]);
}

TEST_CASE("calibration: NumPy's draws are called what they are, with their interval") {
    CHECK(judge(evidence(), 0.05).findings.empty());
    Limits wide(0.3);
    wide.bias = 0.5;  // 200 trials do not show 0.1
    CHECK(judge(evidence(), wide).verdict == Verdict::consistent);
    for (const double claimed : {0.7, 1.4}) {  // P so many times what it should be: 200 trials suffice
        const Consistency judged = judge(evidence(claimed), 0.05);
        CHECK(judged.verdict == (claimed < 1 ? Verdict::optimistic : Verdict::pessimistic));
        REQUIRE_FALSE(judged.findings.empty());
        const Finding& finding = judged.findings.front();
        const Json& whole = expected()["groups"][0];
        CHECK(finding.where == "all");
        CHECK(finding.when == "over all steps");
        check_agrees(finding.value * claimed, number(whole["run"]["mean"]));
        const double level = level_of_group(levels::run, 0, static_cast<int>(expected()["groups"].size())) / 2,
                     mean = number(whole["run"]["mean"]),
                     half = t_quantile(2 * level, trials - 1.0) * number(whole["run"]["se"]);
        check_agrees(finding.interval.low * claimed, mean - half);
        // Trials of three sigma, 2 in N of which none was seen.
        check_agrees(finding.interval.high * claimed, mean + half + (1 - std::pow(0.135, 1.0 / trials)) * 8 * mean);
    }
}

}  // namespace credence::test::calibration_reference_long_test
