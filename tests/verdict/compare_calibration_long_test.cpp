// The gain by shared draws, and the frequency of wrong conclusions, by replication.

#include <algorithm>
#include <credence/detail/draws.hpp>

#include "compare_support.hpp"
#include "store_study.hpp"
#include "study_support.hpp"

namespace credence::test::compare_calibration_long_test {

TEST_CASE("compare: the variance reduction is what unpaired runs with seeds of their own have too much", "[long]") {
    // 400 small studies give the variance of a paired mean difference; two arms of two further seeds each give that of
    // an unpaired one. Their ratio is Fisher's F(399, 399) times the true factor, means of 64 trials being near enough
    // to normal: the logarithm has standard deviation sqrt(4/399) = 0.1, and 4 of them are exceeded with 6e-5 for each
    // of the four figures. The factor reported of 20,000 trials adds less than 0.03. A test that took one arm's
    // variance alone would be off by log 2 = 0.69, one that took the standard deviation by more.
    constexpr std::uint64_t replications = 400;
    constexpr std::int64_t trials = 64;
    const std::vector<int> columns{column_unseen, column_pose_error, column_nees_ratio, column_nis_ratio};
    const std::vector<DeformableSettings> circle{small_scenarios()[1]};
    std::vector<std::vector<double>> paired(columns.size()), unpaired(columns.size());
    for (std::uint64_t r = 0; r < replications; ++r) {
        const Study both = run(circle, 1000 + r, trials), one = run(circle, 2000 + r, trials),
                    other = run(circle, 3000 + r, trials);
        for (std::size_t c = 0; c < columns.size(); ++c) {
            const auto mean = [&](const Study& study, std::size_t arm) {
                return mean_of(study.scenarios[0].arms[arm].columns.in_memory()[static_cast<std::size_t>(columns[c])]);
            };
            paired[c].push_back(mean(both, 1) - mean(both, 0));
            unpaired[c].push_back(mean(one, 1) - mean(other, 0));
        }
    }
    const CompareReport report = compared({{"large.h5", run(circle, 1, 20000)}});
    for (std::size_t c = 0; c < columns.size(); ++c) {
        const double factor = of(report.pairs[0], columns[c]).variance_reduction;
        const double measured = variance_of(unpaired[c]) / variance_of(paired[c]);
        INFO("column " << columns[c] << ": reported " << factor << ", measured " << measured);
        CHECK(std::abs(std::log(measured / factor)) < 4 * std::sqrt(4.0 / (replications - 1)) + 0.03);
        CHECK(factor > (columns[c] == column_unseen ? 1.2 : 4));  // there is something to measure
    }
}

TEST_CASE("compare: conclusions hold together at 95 %", "[long]") {
    // 200 families of 5 comparisons of 100 standard-normal differences with mean 0, at 0.8 % each: 3.9 % of the
    // families have a conclusion, 8 with standard deviation 2.8; more than 19 or none have probability 5e-4. Without
    // the correction, 4 % each, there would be 37.
    std::vector<DeformableSettings> scenarios;
    for (int s = 0; s < 5; ++s) scenarios.push_back(changed(matched(), "scenario.name", "s" + std::to_string(s)));
    Study study = new_study(scenarios, 1);
    int wrong = 0;
    for (std::uint64_t family = 0; family < 200; ++family) {
        for (std::size_t s = 0; s < 5; ++s) {
            const KeyedDraws<double> draws(family, s, std::numeric_limits<double>::infinity());
            if (family == 0) extend(study.scenarios[s], 100);
            for (auto& arm : study.scenarios[s].arms)
                for (auto& column : arm.columns.in_memory()) std::fill(column.begin(), column.end(), 0.0);
            std::vector<double>& first = study.scenarios[s].arms[0].columns.in_memory()[0];
            for (int i = 0; i < 100; ++i) first[static_cast<std::size_t>(i)] = draws.normal(Source::walk, i, 0).x;
        }
        const CompareReport report = compared({{"null.h5", study}});
        wrong += std::any_of(report.pairs.begin(), report.pairs.end(),
                             [](const ComparedPair& pair) { return pair.conclusion != Conclusion::not_shown; });
    }
    CAPTURE(wrong);
    CHECK(wrong > 0);
    CHECK(wrong <= 19);
}

}  // namespace credence::test::compare_calibration_long_test
