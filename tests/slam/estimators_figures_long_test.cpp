// The estimators over thousands of trials, against a published table of an independent implementation (batched
// numpy, its own draws), and the engine's lanes against one trial at a time.

#include <credence/detail/block.hpp>
#include "worlds/deformable/deformable.hpp"

#include <cmath>

#include "catch.hpp"
#include "support.hpp"

namespace credence::test::estimators_figures_long_test {

namespace {

struct Ratio {
    double mean = 0, error = 0;
};

/// NEES over its dimension, mean over steps and trials, with its standard error; by arm. `figure` 0 is the series of
/// all, 1 that of the pose.
std::vector<Ratio> ratios(const Problem& problem, int blocks, int figure, int dimension) {
    const std::size_t arms = arms_of(problem.scenario()).size();
    const int steps = problem.view().poses - 1;
    std::vector<double> sum(arms), square(arms);
    double trials = 0;
    for (int b = 0; b < blocks; ++b) {
        const Block block = run_block(problem, 7, b, block_size);
        trials += block_size;
        for (std::size_t a = 0; a < arms; ++a) {
            REQUIRE(block.arms[a].counted == block_size);
            for (int k = 0; k < steps; ++k) sum[a] += block.arms[a].sums[static_cast<std::size_t>(figure * steps + k)];
            square[a] += block.arms[a].run_square_sums[static_cast<std::size_t>(figure)];
        }
    }
    std::vector<Ratio> result;
    for (std::size_t a = 0; a < arms; ++a) {
        const double mean = sum[a] / trials, variance = square[a] / trials - mean * mean;
        result.push_back({mean / steps / dimension, std::sqrt(variance / trials) / steps / dimension});
    }
    return result;
}

/// A row of the table: the values of ekf, ideal, fej, riekf and iekf, all and pose, with the error in the last digits.
struct Row {
    std::string path, poses, sigma;
    int blocks;
    Ratio all[5], pose[5];
};

}  // namespace

TEST_CASE("estimators: NEES in the matched world is what an independent implementation found", "[long]") {
    const Row table[]{
        {"straight", "20", "0.001", 40,
         {{0.999, 0.002}, {1.000, 0.002}, {0.999, 0.002}, {0.999, 0.002}, {0.999, 0.002}},
         {{0.993, 0.006}, {0.994, 0.006}, {0.993, 0.006}, {0.993, 0.006}, {0.993, 0.006}}},
        {"straight", "20", "0.01", 40,
         {{1.019, 0.002}, {1.030, 0.002}, {1.019, 0.002}, {1.002, 0.002}, {1.001, 0.002}},
         {{1.004, 0.005}, {1.037, 0.006}, {1.003, 0.005}, {0.998, 0.005}, {1.000, 0.005}}},
        {"straight", "20", "0.05", 40,
         {{1.193, 0.003}, {1.227, 0.003}, {1.187, 0.003}, {1.032, 0.002}, {1.021, 0.002}},
         {{1.085, 0.006}, {1.175, 0.007}, {1.067, 0.006}, {1.014, 0.005}, {1.052, 0.006}}},
        {"circle", "100", "0.03", 12,
         {{1.068, 0.004}, {1.090, 0.004}, {1.068, 0.004}, {1.017, 0.003}, {1.005, 0.003}},
         {{1.034, 0.010}, {1.098, 0.011}, {1.032, 0.010}, {1.022, 0.010}, {1.010, 0.010}}}};
    Settings settings = matched_world();
    settings.insert(settings.end(), {{"model.process", "heading"}, {"arms.controllers", "fixed"},
                                     {"arms.estimators", "ekf, ideal, fej, riekf, iekf"}});
    for (const Row& row : table) {
        Settings here = settings;
        here.insert(here.end(),
                    {{"features.path", row.path}, {"scenario.poses", row.poses}, {"noise.heading", row.sigma}});
        const Problem problem(scenario_with(here));
        const std::vector<Ratio> all = ratios(problem, row.blocks, 0, 9), pose = ratios(problem, row.blocks, 1, 3),
                                 invariant = ratios(problem, row.blocks, problem.view().series_count - 1, 3);
        for (std::size_t arm = 0; arm < 5; ++arm) {
            CAPTURE(row.path, row.sigma, arm);
            // Four standard errors of the difference: of 40 comparisons one in 400 runs fails by chance; seeds are
            // fixed.
            CHECK(std::abs(all[arm].mean - row.all[arm].mean) < 4 * std::hypot(all[arm].error, row.all[arm].error));
            CHECK(std::abs(pose[arm].mean - row.pose[arm].mean) < 4 * std::hypot(pose[arm].error, row.pose[arm].error));
            // What the independent implementation found of the invariant chart, of all but `ideal`.
            if (arm != 1) CHECK(std::abs(invariant[arm].mean - pose[arm].mean) < 0.02);
        }
    }
}

TEST_CASE("estimators: in lanes, planned and fixed, on few and many features, the same bits as one trial at a time") {
    for (const char* positions : {"0.5 0.5, 0.9 0.8, 0.3 0.4", "1 1, 0.5 0.2, -0.4 0.6, 0.2 1, 0.7 -0.3"}) {
        CAPTURE(positions);
        const Problem problem(scenario_with({{"features.positions", positions}, {"features.path", "circle"},
                                             {"noise.heading", "0.05"}, {"scenario.poses", "8"},
                                             {"arms.estimators", "ekf, ideal, fej, riekf, iekf"}}));
        CHECK(other_bits_in_lanes(problem) == std::vector<std::string>{});
    }
}

}  // namespace credence::test::estimators_figures_long_test
