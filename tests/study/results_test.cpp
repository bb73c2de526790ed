// The totals over blocks.

#include "catch.hpp"
#include "of_scenarios.hpp"
#include "support.hpp"

#include <credence/detail/results.hpp>

#include <algorithm>

namespace credence::test::results_test {

namespace {

constexpr std::uint64_t seed = 9;

/// Some trials fail in it, so that the totals are not those of all.
DeformableSettings mixed_world() {
    return scenario_with({{"noise.heading", "1e9"}, {"filter.covariance", "10"}, {"arms.controllers", "fixed"},
                          {"scenario.poses", "4"}});
}

void add_block(ScenarioResults& results, const Problem& problem, std::int64_t index, int trials) {
    const Block block = run_block(problem, seed, index, trials);
    store_columns(results, block);
    add_totals(results, block);
}

/// The results of a study's first trials, its blocks added in a given order.
ScenarioResults results_of(const DeformableSettings& scenario, std::int64_t trials, bool backwards = false) {
    const Problem problem(scenario);
    ScenarioResults results = empty_results(scenario);
    extend(results, trials);
    for (std::int64_t b = 0; b < block_count(trials); ++b) {
        const std::int64_t index = backwards ? block_count(trials) - 1 - b : b;
        add_block(results, problem, index, trials_in_block(trials, index));
    }
    return results;
}

/// All totals as the exact parts they are stored in.
std::vector<double> parts_of(const ScenarioResults& results) {
    std::vector<double> all;
    const auto append = [&](const ExactSum& sum) {
        for (const double part : sum.parts()) all.push_back(part);
        all.push_back(-1);
    };
    for (const ArmResults& arm : results.arms) {
        for (const auto* all_series : {&arm.totals.series, &arm.totals.diverged})
            for (const SeriesTotals& totals : *all_series) {
                for (const ExactSum& sum : totals.sum) append(sum);
                for (const ExactSum& sum : totals.square_sum) append(sum);
                append(totals.run_square_sum);
            }
        all.push_back(static_cast<double>(arm.totals.trials.counted()));
    }
    return all;
}

bool same(const ScenarioResults& a, const ScenarioResults& b) {
    bool columns = a.trials == b.trials && a.arms.size() == b.arms.size();
    for (std::size_t arm = 0; columns && arm < a.arms.size(); ++arm)
        for (std::size_t c = 0; c < a.columns.size(); ++c)
            columns = columns && same_bits(a.arms[arm].columns.in_memory()[c], b.arms[arm].columns.in_memory()[c]);
    return columns && same_bits(parts_of(a), parts_of(b));
}

}  // namespace

TEST_CASE("results: empty results have the dimensions that the scenario declares, and no values") {
    const DeformableSettings scenario = scenario_with({});
    const ScenarioResults results = empty_results(scenario);
    REQUIRE(results.arms.size() == 2);
    CHECK(results.arms[0].name == "fixed.ekf");
    CHECK(results.arms[1].name == "greedy.ekf");
    CHECK(results.trials == 0);
    CHECK(results.steps() == 19);
    CHECK(results.columns.size() == column_count);
    CHECK(results.all_series.size() == static_cast<std::size_t>(Problem(scenario).view().series_count));
    for (std::size_t f = 0; f < results.all_series.size(); ++f) {
        const SeriesTotals& totals = results.arms[0].totals.series[f];
        CHECK(totals.sum.size() == 19);
        CHECK(totals.square_sum.size() == (results.all_series[f].integer ? 0u : 19u));
        CHECK(totals.run_square_sum.rounded() == 0);
    }
}

TEST_CASE("results: the order of the blocks does not matter") {
    const DeformableSettings scenario = mixed_world();
    const ScenarioResults forwards = results_of(scenario, 700), backwards = results_of(scenario, 700, true);
    CHECK(same(forwards, backwards));
    CHECK(forwards.arms[0].totals.trials.counted() > 0);
    CHECK(forwards.arms[0].totals.trials.counted() < 700);
}

TEST_CASE("results: totals are those of the trials that neither failed nor diverged, and of diverged ones apart") {
    const DeformableSettings scenario = mixed_world();
    const ScenarioResults results = results_of(scenario, 300);
    const std::size_t trace =
        static_cast<std::size_t>(std::find_if(results.all_series.begin(), results.all_series.end(),
                                              [](const Series& f) { return f.name == "trace_P_step"; }) -
                                 results.all_series.begin());
    for (const Status status : {Status::completed, Status::diverged}) {
        double sum = 0;
        std::int64_t count = 0;
        for (std::size_t i = 0; i < 300; ++i) {
            if (results.arms[0].columns.in_memory()[column_status][i] != static_cast<double>(status)) continue;
            sum += results.arms[0].columns.in_memory()[column_trace_P][i];
            ++count;
        }
        const Totals& totals = results.arms[0].totals;
        REQUIRE(count > 0);
        CHECK(totals.trials.statuses[static_cast<std::size_t>(status)] == count);
        // trace_P is the last step's value; 300 roundings of a sum of positive numbers.
        const auto& all_series = status == Status::completed ? totals.series : totals.diverged;
        CHECK(relative(all_series[trace].sum.back().rounded(), sum) < 300 * 0x1p-53);
    }
}

TEST_CASE("results: a partial block that is taken back and computed again gives the same bits as a fresh run") {
    const DeformableSettings scenario = mixed_world();
    const Problem problem(scenario);
    ScenarioResults grown = results_of(scenario, 300);
    remove_totals(grown, run_block(problem, seed, 1, 44));
    CHECK(same_bits(parts_of(grown), parts_of(results_of(scenario, 256))));
    extend(grown, 400);
    add_block(grown, problem, 1, 144);
    CHECK(same(grown, results_of(scenario, 400)));
}

TEST_CASE("results: taking everything back leaves nothing") {
    const DeformableSettings scenario = scenario_with({{"arms.controllers", "fixed"}});
    const Problem problem(scenario);
    ScenarioResults results = results_of(scenario, 300);
    for (const std::int64_t index : {0, 1})
        remove_totals(results, run_block(problem, seed, index, trials_in_block(300, index)));
    CHECK(same_bits(parts_of(results), parts_of(empty_results(scenario))));
}

TEST_CASE("results: columns are stored at their trials") {
    const DeformableSettings scenario = scenario_with({{"arms.controllers", "fixed"}});
    const ScenarioResults results = results_of(scenario, 300);
    const Block second = run_block(Problem(scenario), seed, 1, 44);
    for (std::size_t c = 0; c < column_count; ++c)
        for (std::size_t trial = 0; trial < 44; ++trial)
            CHECK(same_bits(results.arms[0].columns.in_memory()[c][256 + trial],
                            second.arms[0].columns[c * 44 + trial]));
}

}  // namespace credence::test::results_test
