// Bounds, directions, bias, advice and lags against their slow version, tests/oracle/verdict_oracle.py. Its
// values are stored: python3 tests/reference/make_verdict.py > tests/reference/verdict.json

#include <map>

#include "statistics/moments/advice.hpp"
#include "statistics/mean_bounds.hpp"
#include "statistics/moments/directions.hpp"
#include "statistics/verdict_cases.hpp"
#include "statistics/whiteness.hpp"

namespace credence::test::verdict_oracle_test {

using Json = nlohmann::json;

namespace {

/// Moments of one number per trial.
template <class Value>
Moments moments_of(const TrialMoments& trials, const Value& value) {
    const auto count = static_cast<double>(trials.trials());
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < trials.trials(); ++i) sum += value(i);
    for (std::size_t i = 0; i < trials.trials(); ++i) squares += std::pow(value(i) - sum / count, 2);
    const double deviation = std::sqrt(squares / (count - 1));
    return {count, sum / count, deviation, deviation / std::sqrt(count)};
}

PositiveSample nees_sample(const TrialMoments& trials, int g) {
    return positive_sample(moments_of(trials, [&](std::size_t i) { return trials.X(i, g); }));
}

void check_direction(const Direction& found, const Json& expected) {
    check_close(found.ratio.mean, expected["ratio"]);
    check_close(found.bounds, expected["bounds"]);
    CHECK(found.finding == expected["finding"]);
    CHECK(found.approximate == expected["approximate"]);
    REQUIRE(found.entries.size() == expected["components"].size());
    for (std::size_t j = 0; j < found.entries.size(); ++j) {
        CHECK(found.entries[j].component == expected["components"][j]);
        // An eigenvector is as good as the distance of its eigenvalue from the next allows.
        CHECK(std::abs(found.entries[j].weight - expected["weights"][j].get<double>()) < 1e-8);
    }
}

}  // namespace

TEST_CASE("verdict: the bounds on mean NEES, its claims and its acceptance agree with the oracle's") {
    for (const Json& one : verdict_cases()) {
        const VerdictCase drawn(one);
        const TrialMoments trials = drawn.moments();
        for (int g = 0; g < trials.groups; ++g) {
            const Json& expected = one["nees"][static_cast<std::size_t>(g)];
            const PositiveSample sample = nees_sample(trials, g);
            const auto dimension = static_cast<int>(drawn.groups()[static_cast<std::size_t>(g)].size());
            const double degrees = degrees_over_steps(sample, dimension, one["steps"]),
                         level = level_of_group(levels::run, g, trials.groups) / 2;
            check_close(sample.mean, expected["mean"]);
            check_close(degrees, expected["degrees"]);
            check_close(level, expected["level"]);
            const MeanClaim claim = claim_on_nees(sample, degrees, level, 0.05);
            check_close(claim.bounds, expected["bounds"]);
            CHECK(claim.above == (expected["finding"] == "above"));
            CHECK(claim.below == (expected["finding"] == "below"));
            CHECK((margin_shown(acceptance_interval(sample, sample)) <= 0.05) == expected["accepted"]);
            const double show = trials_to_show(sample, level, 0.05);
            if (expected["show"].is_null())
                CHECK(std::isinf(show));
            else
                check_close(show, expected["show"]);
        }
    }
}

TEST_CASE("verdict: directions, their names and their bounds agree with the oracle's") {
    for (const Json& one : verdict_cases()) {
        const VerdictCase drawn(one);
        const TrialMoments trials = drawn.moments();
        for (const Json& expected : one["directions"]) {
            const GroupMoments group = group_moments(trials, expected["group"]);
            const GroupDirections found =
                find_directions(group, fold_sums(group), expected["level"], {.steps = one["steps"].get<double>()});
            CAPTURE(one["n"], one["kind"], one["seed"]);
            REQUIRE(found.state == GroupDirections::State::known);
            CHECK(found.trials == one["trials"]);
            CHECK(found.left_out == expected["left_out"]);
            check_direction(found.largest, expected["largest"]);
            check_direction(found.smallest, expected["smallest"]);
        }
    }
}

TEST_CASE("verdict: the acceptance of all directions agrees with the oracle's") {
    int accepted_studies = 0;
    for (const Json& one : verdict_cases()) {
        const VerdictCase drawn(one);
        const GroupMoments state = group_moments(drawn.moments(), drawn.groups()[0]);
        const DirectionsAccepted accepted = accept_directions(state, fold_sums(state));
        const Json& expected = one["all_directions"];
        if (state.trials() < direction_trials) CHECK(accepted.state == GroupDirections::State::few_trials);
        if (expected.is_null()) continue;
        REQUIRE(accepted.state == GroupDirections::State::known);
        check_close(accepted.spectrum.front(), expected["smallest"]);
        check_close(accepted.spectrum.back(), expected["largest"]);
        check_close(accepted.bounds, expected["bounds"]);
        CHECK((accepted.shown <= 0.1) == expected["accepted"]);
        accepted_studies += accepted.shown <= 0.1;
    }
    CHECK(accepted_studies > 0);
}

TEST_CASE("verdict: bias agrees with the oracle's, and a component that is known exactly has none") {
    for (const Json& one : verdict_cases()) {
        const TrialMoments trials = VerdictCase(one).moments();
        for (int j = 0; j < trials.components; ++j) {
            const Json& expected = one["biases"][static_cast<std::size_t>(j)];
            const Moments z = moments_of(trials, [&](std::size_t i) { return trials.z(i, j); });
            const BiasClaim claim = claim_on_bias(z, expected["size"], trials.components, 0.1);
            check_close(claim.value, expected["value"]);
            check_close(claim.interval, expected["interval"]);
            CHECK(claim.known_exactly == expected["known"]);
            CHECK(claim.finding == expected["finding"]);
            CHECK(claim.accepted == expected["accepted"]);
        }
    }
}

TEST_CASE("verdict: the advised number and its range agree with the oracle's") {
    for (const Json& one : verdict_cases()) {
        const VerdictCase drawn(one);
        const std::optional<Advice> advice =
            trials_for_consistent(drawn.moments(), drawn.groups()[0], one["seed"].get<std::uint64_t>());
        const Json& expected = one["advice"];
        REQUIRE(advice.has_value() == !expected.is_null());
        if (!advice) continue;
        check_close(advice->trials, expected["number"]);
        check_close(advice->range, expected["range"]);
    }
}

TEST_CASE("verdict: the correlation at a lag agrees with the oracle's, for few trials too") {
    for (const Json& one : verdict_cases()) {
        const TrialMoments trials = VerdictCase(one).moments();
        for (const Json& expected : one["lags"]) {
            LagSums sums;
            for (std::size_t i = 0; i < expected["trials"]; ++i) {
                const double p = 40 * trials.z(i, 0);
                sums.add(p, static_cast<double>(40 + trials.trial[i] % 3), p * p);
            }
            const auto correlation = correlation_of(sums, 0.05 / 3);
            REQUIRE(correlation.has_value());
            check_close(correlation->r, expected["r"]);
            check_close(correlation->interval, expected["interval"]);
        }
    }
    LagSums few;
    few.add(1, 29, 1);
    CHECK_FALSE(correlation_of(few, 0.05).has_value());
}

}  // namespace credence::test::verdict_oracle_test
