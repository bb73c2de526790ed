// The advised number of trials: what it does not depend on, and that it is where a finding is made.

#include "statistics/moments/advice.hpp"

#include "statistics/verdict_cases.hpp"

namespace credence::test::advice_test {

namespace {

const double missing = std::numeric_limits<double>::quiet_NaN();

/// Three components and a group of two of them.
TrialMoments three_components(int trials, double scale) {
    const nlohmann::json settings = {{"n", 3},        {"steps", 4},    {"trials", trials},
                                     {"rho", 0},      {"bias", 0},     {"groups", {{0, 1, 2}, {0, 2}}},
                                     {"kind", ""},    {"seed", 7},     {"tails", "normal"},
                                     {"true", 0.3},   {"gaps", false}, {"claimed", 0.3},
                                     {"scale", scale}};
    return VerdictCase(settings).moments();
}

std::optional<Advice> advice_on(const TrialMoments& trials) { return trials_for_consistent(trials, {0, 1, 2}, 3); }

void check_same(const std::optional<Advice>& one, const std::optional<Advice>& other) {
    REQUIRE((one && other));
    CHECK(std::abs(one->trials / other->trials - 1) < 1e-9);
    CHECK(std::abs(one->range.high / other->range.high - 1) < 1e-9);
}

}  // namespace

TEST_CASE("advice: how wrong a filter is does not move the number, because the trials are centred") {
    TrialMoments right = three_components(100, 1), large = three_components(100, 1.4);
    for (TrialMoments* trials : {&right, &large})  // biases have a scale, and bind nowhere here
        for (std::size_t i = 0; i < trials->trials(); ++i)
            for (int j = 0; j < 3; ++j) trials->values[i * trials->size() + 2 + static_cast<std::size_t>(j)] = 0;
    check_same(advice_on(right), advice_on(large));
}

TEST_CASE("advice: trials that lack a component are left out, and fewer than 30 give none") {
    const TrialMoments complete = three_components(40, 1);
    TrialMoments some = complete, none{3, 2, {}, {}};
    for (std::size_t i = 0; i < complete.trials(); ++i) {
        if (i % 5 == 0)
            some.values[i * some.size() + 1] = missing;
        else
            std::copy(complete.row(i), complete.row(i) + complete.size(), none.append(complete.trial[i]));
    }
    check_same(advice_on(some), advice_on(none));
    CHECK(advice_on(three_components(30, 1)).has_value());
    CHECK_FALSE(advice_on(three_components(29, 1)).has_value());
}

TEST_CASE("advice: none where a component is a copy of another") {
    const nlohmann::json settings = {
        {"n", 3},    {"steps", 4},         {"trials", 100},     {"rho", 0},  {"bias", 0},     {"groups", {{0, 1, 2}}},
        {"seed", 7}, {"kind", "singular"}, {"tails", "normal"}, {"true", 0}, {"gaps", false}, {"claimed", 0},
        {"scale", 1}};
    CHECK_FALSE(advice_on(VerdictCase(settings).moments()).has_value());
}

TEST_CASE("advice: the number that would show it is where the bound crosses the margin") {
    for (const double mean : {1.2, 0.7}) {
        const PositiveSample seen{1000, mean, 1};
        const double number = trials_to_show(seen, 0.01, 0.05);
        const auto shown = [&](double trials) {
            const MeanClaim claim = claim_on_mean({trials, mean, 1}, 0.01, 0.05);
            return claim.above || claim.below;
        };
        // Student's quantile is that of 1000 trials, and the unseen share ln(1/level)/N, to first order.
        CHECK(shown(1.02 * number));
        CHECK_FALSE(shown(0.98 * number));
    }
    CHECK(std::isinf(trials_to_show({1000, 1.02, 1}, 0.01, 0.05)));
    const double number = trials_to_show_bias({400, -0.2, 1, 0.05}, 0.001, 0.1);
    CHECK(std::abs(number - std::pow(t_quantile(0.002, 399) / 0.1, 2)) < 1e-9 * number);
    CHECK(std::isinf(trials_to_show_bias({400, 0.1, 1, 0.05}, 0.001, 0.1)));
}

}  // namespace credence::test::advice_test
