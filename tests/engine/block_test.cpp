// The block is a pure function of scenario, root seed and index, whichever target computes it.

#include "catch.hpp"
#include "support.hpp"

#include <credence/detail/block.hpp>

#include <array>
#include <cmath>

namespace credence::test::block_test {

namespace {

bool same_bits(const Block& a, const Block& b) {
    bool same = a.index == b.index && a.trials == b.trials && a.arms.size() == b.arms.size();
    const auto same_sums = [](const SeriesSums& x, const SeriesSums& y) {
        return test::same_bits(x.sums, y.sums) && test::same_bits(x.square_sums, y.square_sums) &&
               test::same_bits(x.run_square_sums, y.run_square_sums) && x.covered == y.covered;
    };
    for (std::size_t i = 0; same && i < a.arms.size(); ++i) {
        const ArmBlock &x = a.arms[i], &y = b.arms[i];
        same = test::same_bits(x.columns, y.columns) && same_sums(x, y) && same_sums(x.diverged, y.diverged) &&
               x.counted == y.counted;
    }
    return same;
}

/// Worlds that reach every branch of the equations.
std::vector<Settings> worlds() {
    std::vector<Settings> all = seed_cells();
    all.push_back({{"features.positions", "1 1"}});
    all.push_back({{"features.positions", "1 1, 0 1, 1 0, -1 0, 0.5 0.5"},
                   {"edges.graph", "chain"},
                   {"model.process", "translation"}});
    all.push_back({{"sensor.detection", "0.5"}, {"noise.truncate", "2"}, {"features.sway_amplitude", "0.5"}});
    all.push_back({{"truth.deformation", "walk"}, {"truth.edge_noise", "independent"}, {"sensor.range_max", "inf"}});
    all.push_back({{"noise.initial_heading", "0.1"}, {"noise.initial_position", "0.1"}, {"features.path", "static"}});
    return all;
}

/// A world in which some trials fail, some diverged and some are neither: the heading is unknown after a step.
const Settings fragile{{"noise.heading", "1e9"}, {"filter.covariance", "10"}, {"arms.controllers", "fixed"},
                       {"scenario.poses", "4"}};

/// Value of a column in a block's arm.
double column(const Block& block, std::size_t arm, int index, int trial) {
    return block.arms[arm].columns[static_cast<std::size_t>(index * block.trials + trial)];
}

/// The columns of one trial of a block, by itself.
std::vector<double> single(const DeformableSettings& scenario, Controller controller, std::uint64_t seed,
                           std::int64_t trial) {
    const AnyNoise noise = keyed_noise(scenario, seed, static_cast<std::uint64_t>(trial));
    std::vector<double> columns = run_arm(scenario, controller, noise).columns;
    fill_failed(trial_columns(scenario), columns.data());
    return columns;
}

}  // namespace

TEST_CASE("block: trials fill blocks of 256") {
    CHECK(block_size == 256);
    CHECK(block_count(0) == 0);
    CHECK(block_count(1) == 1);
    CHECK(block_count(256) == 1);
    CHECK(block_count(257) == 2);
    CHECK(block_count(10000) == 40);
    CHECK(trials_in_block(257, 0) == 256);
    CHECK(trials_in_block(257, 1) == 1);
    CHECK(trials_in_block(512, 1) == 256);
    CHECK(trials_in_block(100, 0) == 100);
}

TEST_CASE("block: the same bits every time, others for another root seed or index") {
    const Problem problem(scenario_with({{"arms.controllers", "fixed"}}));
    const Block block = run_block(problem, 1, 2, 64);
    CHECK(same_bits(block, run_block(problem, 1, 2, 64)));
    for (const auto& [seed, index] : {std::pair{2u, 2}, {1u, 3}}) {
        const Block other = run_block(problem, seed, index, 64);
        for (int trial = 0; trial < 64; ++trial)
            CHECK(column(other, 0, column_trace_P, trial) != column(block, 0, column_trace_P, trial));
    }
}

TEST_CASE("block: every target gives the same bits") {
    const std::vector<Target> targets = runnable_targets();
    REQUIRE(targets.back().name == "portable");
    CHECK(best_target().simulate == targets.front().simulate);
    if (targets.size() == 1) WARN("this processor runs the portable unit only: there is nothing to compare");
    for (const Settings& world : worlds()) {
        CAPTURE(described(world));
        const Problem problem(scenario_with(world));
        const Block portable = run_block(problem, 3, 1, 40, targets.back());
        for (const Target& target : targets) {
            CAPTURE(target.name);
            CHECK(same_bits(portable, run_block(problem, 3, 1, 40, target)));
        }
    }
}

TEST_CASE("block: every target agrees on which trials fail") {
    const Problem problem(scenario_with(fragile));
    const Block first = run_block(problem, 3, 0, 256, runnable_targets().front());
    CHECK(same_bits(first, run_block(problem, 3, 0, 256, runnable_targets().back())));
}

TEST_CASE("block: 100 trials are the beginning of 256") {
    const Problem problem(scenario_with({{"arms.controllers", "fixed"}}));
    const Block part = run_block(problem, 1, 4, 100), whole = run_block(problem, 1, 4, 256);
    for (int c = 0; c < column_count; ++c)
        for (int trial = 0; trial < 100; ++trial)
            CHECK(test::same_bits(column(part, 0, c, trial), column(whole, 0, c, trial)));
    CHECK(part.arms[0].columns.size() == 100 * column_count);
    CHECK(part.trials == 100);
}

TEST_CASE("block: a trial of any block is the single trial, in every world and arm") {
    for (Settings world : worlds()) {
        world.emplace_back("scenario.poses", "12");
        CAPTURE(described(world));
        const DeformableSettings scenario = scenario_with(world);
        const Block block = run_block(Problem(scenario), 5, 3, 30);
        for (const int trial : {0, 1, 17, 29})
            for (std::size_t arm = 0; arm < 2; ++arm) {
                const std::vector<double> alone =
                    single(scenario, arms_of(scenario)[arm].controller, 5, 3 * 256 + trial);
                for (int c = 0; c < column_count; ++c)
                    CHECK(test::same_bits(column(block, arm, c, trial), alone[static_cast<std::size_t>(c)]));
            }
    }
}

TEST_CASE("block: long trials, simulated a few at a time, are the single trials too") {
    const DeformableSettings scenario = scenario_with({{"arms.controllers", "fixed"}, {"scenario.poses", "500"}});
    const Block block = run_block(Problem(scenario), 5, 0, 32);
    for (const int trial : {0, 6, 7, 13, 14, 31})
        CHECK(test::same_bits(column(block, 0, column_pose_error, trial),
                              single(scenario, Controller::fixed, 5, trial)[column_pose_error]));
}

TEST_CASE("block: arms are in the scenario's order") {
    const Settings circle{{"features.path", "circle"}};
    const DeformableSettings usual = scenario_with(circle);
    const DeformableSettings turned = scenario_with(usual, {{"arms.controllers", "greedy, fixed"}});
    const Block one = run_block(Problem(usual), 1, 0, 20), other = run_block(Problem(turned), 1, 0, 20);
    CHECK(test::same_bits(one.arms[0].columns, other.arms[1].columns));
    CHECK(test::same_bits(one.arms[1].columns, other.arms[0].columns));
    CHECK_FALSE(test::same_bits(one.arms[0].columns, one.arms[1].columns));
    CHECK(run_block(Problem(scenario_with(usual, {{"arms.controllers", "greedy"}})), 1, 0, 5).arms.size() == 1);
}

TEST_CASE("block: sums are folded in eight, in trial order, over the trials that count") {
    for (const auto& [world, trials] : {std::pair{fragile, 256}, {Settings{{"arms.controllers", "fixed"}}, 37}}) {
        const DeformableSettings scenario = scenario_with(world);
        const Problem problem(scenario);
        const int steps = scenario.poses - 1, figures = problem.view().series_count;
        const Block block = run_block(problem, 3, 0, trials);
        for (const int status : {0, 1}) {  // completed trials, and diverged ones apart
            std::array<Eigen::MatrixXd, 8> sums, squares;  // by column as the block by row
            std::array<Eigen::VectorXd, 8> run_squares;
            sums.fill(Eigen::MatrixXd::Zero(steps, figures));
            squares.fill(Eigen::MatrixXd::Zero(steps, figures));
            run_squares.fill(Eigen::VectorXd::Zero(figures));
            int counted = 0;
            for (int trial = 0; trial < trials; ++trial) {
                const Run run =
                    run_arm(scenario, Controller::fixed, keyed_noise(scenario, 3, static_cast<std::uint64_t>(trial)));
                const bool trial_failed = run.columns[column_status] >= 2;
                CHECK(std::isnan(column(block, 0, column_trace_P, trial)) == trial_failed);
                CHECK((column(block, 0, column_unseen, trial) == -1) == trial_failed);
                if (run.columns[column_status] != status) continue;
                ++counted;
                const std::size_t eighth = static_cast<std::size_t>(trial) % 8;
                for (int f = 0; f < figures; ++f) {
                    double run_sum = 0;
                    for (int k = 0; k < steps; ++k) {
                        const double value = run.figures(f, k);
                        sums[eighth](k, f) += value;
                        squares[eighth](k, f) = std::fma(value, value, squares[eighth](k, f));
                        run_sum += value;
                    }
                    run_squares[eighth][f] = std::fma(run_sum, run_sum, run_squares[eighth][f]);
                }
            }
            CHECK((world == fragile) == (counted > 0 && counted < trials));  // both kinds occur, or none failed
            const SeriesSums& found = status == 0 ? block.arms[0] : block.arms[0].diverged;
            CHECK(found.sums.empty() == (counted == 0));
            if (counted == 0) continue;
            const auto same_as = [](const std::vector<double>& values, const Eigen::MatrixXd& folded) {
                return test::same_bits(values, std::vector<double>(folded.data(), folded.data() + folded.size()));
            };
            for (std::size_t i = 1; i < 8; ++i) {
                sums[0] += sums[i];
                squares[0] += squares[i];
                run_squares[0] += run_squares[i];
            }
            CHECK(same_as(found.sums, sums[0]));
            CHECK(same_as(found.square_sums, squares[0]));
            CHECK(same_as(found.run_square_sums, run_squares[0]));
        }
    }
}

}  // namespace credence::test::block_test
