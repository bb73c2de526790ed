// Totals of columns are the exact sums over the trials that have a value, and what follows from them.

#include "catch.hpp"
#include "of_scenarios.hpp"
#include "support.hpp"

#include <credence/detail/paired.hpp>

#include "numeric/superaccumulator.hpp"
#include "study/block_results.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace credence::test::aggregates_test {

namespace {

/// Some trials fail in it under either arm, and some measure nothing.
DeformableSettings mixed_world() {
    return scenario_with({{"noise.odometry", "1e5"}, {"sensor.sigma", "1e-3"}, {"sensor.range_max", "1e5"},
                          {"scenario.poses", "6"}, {"planner.speeds", "1"}});
}

/// The first trials of the world, its blocks added in this order, of which the first was added and taken back before.
ScenarioResults results_of(Keep keep, std::int64_t trials, const std::vector<std::int64_t>& blocks) {
    const Problem problem(mixed_world());
    ScenarioResults results = empty_results(problem.scenario(), keep);
    extend(results, trials);
    const Block again = run_block(problem, 9, blocks.front(), 77);
    add_totals(results, again);
    for (const std::int64_t index : blocks) {
        const Block block = run_block(problem, 9, index, trials_in_block(trials, index));
        store_columns(results, block);
        add_totals(results, block);
    }
    remove_totals(results, again);
    return results;
}

/// x^2 in parts that need no rounding: x = high + low with half the digits each [Veltkamp; Dekker 1971].
void add_square(ExactSum& sum, double x) {
    const double scaled = 134217729 * x, high = scaled - (scaled - x), low = x - high;
    for (const double part : {high * high, 2 * high * low, low * low}) sum.add(part);
}

/// One value at a time; those that are NaN are left out.
ExactMoments slow_moments(const std::vector<double>& values) {
    ExactMoments moments;
    for (const double value : values) {
        if (std::isnan(value)) continue;
        ++moments.count;
        moments.sum.add(value);
        add_square(moments.square_sum, value);
    }
    return moments;
}

void check_moments(const ExactMoments& moments, const std::vector<double>& values) {
    const ExactMoments expected = slow_moments(values);
    CHECK(moments.count == expected.count);
    CHECK(moments.sum.parts() == expected.sum.parts());
    CHECK(moments.square_sum.parts() == expected.square_sum.parts());
}

/// Of pairs that lack a value they are NaN.
std::vector<double> differences_between(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> differences;
    for (std::size_t i = 0; i < a.size(); ++i) differences.push_back(a[i] - b[i]);
    return differences;
}

void check_totals_of(const ScenarioResults& aggregates, const ScenarioResults& trials) {
    for (std::size_t a = 0; a < trials.arms.size(); ++a) {
        const TrialTotals& arm = aggregates.arms[a].totals.trials;
        std::vector<std::int64_t> statuses(status_names().size());
        for (const double status : trials.arms[a].columns.in_memory()[status_column(trials.columns)])
            ++statuses[static_cast<std::size_t>(status)];
        CHECK(arm.statuses == statuses);
        CHECK(arm.trials() == trials.trials);
        CHECK(arm.counted() == trials.arms[a].totals.trials.counted());
        REQUIRE(arm.differences.size() == a);
        for (std::size_t c = 0; c < trials.columns.size(); ++c) {
            if (!is_reported(trials.columns[c])) continue;
            CAPTURE(trials.arms[a].name, trials.columns[c].name);
            const std::vector<double> own = figure_values(trials, trials.arms[a], c);
            check_moments(arm.columns[c], own);
            for (std::size_t b = 0; b < a; ++b) {
                const std::vector<double> other = figure_values(trials, trials.arms[b], c),
                                          differences = differences_between(own, other);
                const DifferenceTotals& totals = arm.differences[b][c];
                check_moments(totals.difference, differences);
                CHECK(totals.below ==
                      std::count_if(differences.begin(), differences.end(), [](double d) { return d < 0; }));
                CHECK(totals.above ==
                      std::count_if(differences.begin(), differences.end(), [](double d) { return d > 0; }));
            }
        }
    }
}

/// Two arms of one block with made-up columns: trials that failed, and one that has no value.
Block made_up_block(const std::vector<Column>& columns) {
    constexpr std::size_t trials = 5;
    Block block{0, trials, std::vector<ArmBlock>(2)};
    for (std::size_t a = 0; a < 2; ++a) {
        ArmBlock& arm = block.arms[a];
        for (std::size_t c = 0; c < columns.size(); ++c)
            for (std::size_t i = 0; i < trials; ++i)
                arm.columns.push_back(columns[c].type == ColumnType::real
                                          ? std::sqrt(static_cast<double>(3 + a + c + 7 * i))
                                          : static_cast<double>(a + i));
    }
    const auto set = [&](std::size_t arm, ColumnIndex column, std::vector<double> values) {
        std::copy(values.begin(), values.end(), block.arms[arm].columns.begin() + column * static_cast<int>(trials));
    };
    set(0, column_status, {0, 2, 0, 1, 0});
    set(1, column_status, {0, 0, 0, 3, 0});
    set(0, column_unseen, {1, -1, 2, 3, 4});
    set(0, column_nis_ratio, {1, NAN, NAN, 2, 3});
    return block;
}

std::vector<TrialTotals> totals_of(const std::vector<Column>& columns, const Block& block) {
    ScenarioResults results;
    results.columns = columns;
    return trial_totals_of(results, block);
}

}  // namespace

TEST_CASE("aggregates: the sums of a block are those that are added one value at a time, at any exponent") {
    std::minstd_rand random(3);
    for (int repeat = 0; repeat < 200; ++repeat) {
        Superaccumulator fast;
        ExactSum slow, slow_squares;
        for (int i = 0; i < 1024; ++i) {
            const int widest = repeat % 2 == 0 ? 4 : 2040;
            const double mantissa = (static_cast<double>(random()) - 0x1p30) * 0x1p22 + static_cast<double>(random()),
                         value =
                             std::ldexp(mantissa, static_cast<int>(random() % static_cast<unsigned>(widest)) - 1072);
            // Of other values squares lose digits where the slow sum forms them.
            const bool squared = repeat % 4 != 1 && repeat % 4 != 0;
            if (std::abs(value) > (squared ? 1e140 : 1e290) || (squared && std::abs(value) < 1e-140)) continue;
            fast.add(value);
            slow.add(value);
            if (squared) add_square(slow_squares, value);
        }
        REQUIRE(fast.sum().parts() == slow.parts());
        if (repeat % 4 == 3) REQUIRE(fast.square_sum().parts() == slow_squares.parts());
    }
    for (const double value : {0.0, -0.0, 5e-324, -2.2250738585072014e-308, 9.99e299, 1.0}) {
        Superaccumulator alone;
        for (int i = 0; i < 1024; ++i) alone.add(value < 1 ? value : value / 1024);
        CHECK(alone.sum().rounded() == (value < 1 ? 1024 * value : value));
    }
    for (const double value : {1e300, -HUGE_VAL}) {
        Superaccumulator none;
        none.add(value);
        none.add(1);
        CHECK(std::isnan(none.sum().rounded()));
        CHECK(std::isnan(none.square_sum().rounded()));
    }
}

TEST_CASE("aggregates: the totals are the exact sums over the columns that a study of trials has") {
    const ScenarioResults trials = results_of(Keep::trials, 700, {0, 1, 2}),
                          aggregates = results_of(Keep::aggregates, 700, {1, 2, 0});
    for (const ArmResults& arm : trials.arms) {
        CHECK(arm.totals.trials.counted() > 100);
        CHECK(arm.totals.trials.counted() < 600);
    }
    check_totals_of(aggregates, trials);
    CHECK(column_differences(aggregates, aggregates.arms[0], aggregates.arms[1], 0).below ==
          column_differences(aggregates, aggregates.arms[1], aggregates.arms[0], 0).above);
}

TEST_CASE("aggregates: failed trials and missing values are in no sum, and break their pairs only") {
    const std::vector<Column> columns = trial_columns(mixed_world());
    const Block block = made_up_block(columns);
    const std::vector<TrialTotals> arms = totals_of(columns, block);
    CHECK(arms[0].statuses == std::vector<std::int64_t>{3, 1, 1, 0});
    CHECK(arms[0].counted() == 3);
    CHECK(arms[0].diverged() == 1);
    CHECK(arms[0].columns[column_unseen].sum.rounded() == 1 + 2 + 3 + 4);
    CHECK(arms[0].columns[column_nis_ratio].count == 3);
    CHECK(arms[0].columns[column_nis_ratio].square_sum.rounded() == 1 + 4 + 9);
    CHECK(arms[0].columns[column_status].count == 0);
    const DifferenceTotals& unseen = arms[1].differences[0][column_unseen];  // 1 - 1, 3 - 2, 5 - 4
    CHECK(unseen.difference.count == 3);
    CHECK(unseen.difference.sum.rounded() == 2);
    CHECK(unseen.above == 2);
    CHECK(unseen.below == 0);
    CHECK(arms[1].differences[0][column_nis_ratio].difference.count == 2);
    CHECK(unseen.reversed().difference.sum.rounded() == -2);
    CHECK(unseen.reversed().below == 2);

    std::vector<TrialTotals> sum = arms;
    sum[1].add(arms[1]);
    sum[1].add(arms[1], -1);
    CHECK(sum[1].statuses == arms[1].statuses);
    CHECK(sum[1].differences[0][column_trace_P].difference.square_sum.parts() ==
          arms[1].differences[0][column_trace_P].difference.square_sum.parts());
}

TEST_CASE("aggregates: spreads survive the cancellation that their sums invite") {
    // 1e8 + i 1e-6, i = 0 ... 99: in doubles n Q - S^2 has no digit left. The values themselves are rounded to 1.5e-8.
    std::vector<double> values;
    for (int i = 0; i < 100; ++i) values.push_back(1e8 + 1e-6 * i);
    const Moments found = moments_of(slow_moments(values));
    double squares = 0;
    for (const double value : values) squares += (value - found.mean) * (value - found.mean);
    // The mean is rounded to 1.5e-8: (1.5e-8 / 2.9e-5)^2 / 2 = 1.3e-7.
    CHECK(found.standard_deviation == Approx(std::sqrt(squares / 99)).epsilon(2e-7));
    const Summary summary = summarise(values);
    CHECK(summary.mean == found.mean);
    CHECK(summary.standard_deviation == found.standard_deviation);
    CHECK(std::isnan(moments_of({}).mean));
    CHECK(moments_of(slow_moments({3})).mean == 3);
    CHECK(std::isnan(moments_of(slow_moments({3})).standard_error));
}

TEST_CASE("aggregates: the variance reduction and an arm's own mean over pairs need that all trials are in pairs") {
    const std::vector<Column> columns = trial_columns(mixed_world());
    const std::vector<TrialTotals> arms = totals_of(columns, made_up_block(columns));
    const auto compared = [&](ColumnIndex c) {
        return compare_totals(arms[1].differences[0][c], arms[1].columns[c], arms[0].columns[c]);
    };
    CHECK(std::isnan(compared(column_trace_P).variance_reduction));
    CHECK(compared(column_trace_P).pairs == 3);
    CHECK(compared(column_unseen).ties == Approx(1.0 / 3));
    CHECK(compare_totals(arms[1].differences[0][column_unseen], arms[1].differences[0][column_unseen].difference,
                         arms[1].differences[0][column_unseen].difference)
              .variance_reduction == Approx(2));
}

}  // namespace credence::test::aggregates_test
