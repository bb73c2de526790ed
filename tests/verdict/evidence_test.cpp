// The totals behind NIS by group, accuracy, coverage, shape, whiteness and credibility, against the
// oracle's matrices and plain loops over trials.

#include "catch.hpp"
#include "support.hpp"
#include "of_scenarios.hpp"

#include "numeric/chi_square.hpp"
#include "engine/detail.hpp"
#include <credence/evidence.hpp>
#include <credence/study.hpp>

#include <boost/math/distributions/chi_squared.hpp>

#include <algorithm>
#include <cmath>

namespace credence::test::evidence_test {

namespace {

/// Worlds of every kind: few and many features in sight, every graph, both processes.
std::vector<Settings> worlds() {
    std::vector<Settings> worlds = seed_cells();
    for (const char* graph : {"all", "chain", "none", "0-2"})
        worlds.push_back({{"edges.graph", graph}, {"truth.edge_noise", "independent"}, {"truth.deformation", "walk"}});
    worlds.push_back({{"features.positions", "0.5 0.5, 0.9 0.8, 0.3 0.4, 1 1, 0.2 0.9, 0.7 0.1, 0.4 0.6, 0.1 0.1"},
                      {"edges.graph", "0-1, 1-2, 0-2, 5-7"}});
    worlds.push_back({{"features.positions", "0.5 0.5"}, {"filter.measurement", "0.8"}, {"noise.heading", "0.05"}});
    return worlds;
}

double quadratic(const Eigen::VectorXd& e, const Eigen::MatrixXd& P) {
    return e.size() == 0 ? 0 : e.dot(P.ldlt().solve(e));
}

/// The whitened innovation with a place for every row, NaN where it was not observed.
Eigen::VectorXd whitened_rows(const oracle::Step& step, Eigen::Index features, Eigen::Index edges) {
    Eigen::VectorXd rows = Eigen::VectorXd::Constant(2 * (features + edges), not_a_number);
    const Eigen::VectorXd white = step.innovation_covariance.llt().matrixL().solve(step.innovation);
    Eigen::Index next = 0;
    for (Eigen::Index j = 0; j < features + edges; ++j)
        if (j >= features || step.seen[static_cast<std::size_t>(j)]) {
            rows.segment<2>(2 * j) = white.segment<2>(next);
            next += 2;
        }
    return rows;
}

/// Sums of products of whitened innovations over one trial, and their number, by lag.
struct Products {
    Eigen::VectorXd sum, count;
};
Products products_of(const oracle::Trial& trial, int features, int edges, int lags) {
    Products products{Eigen::VectorXd::Zero(lags), Eigen::VectorXd::Zero(lags)};
    std::vector<Eigen::VectorXd> rows;
    for (std::size_t k = 1; k < trial.steps.size(); ++k) rows.push_back(whitened_rows(trial.steps[k], features, edges));
    for (int lag = 1; lag <= lags; ++lag)
        for (std::size_t k = static_cast<std::size_t>(lag); k < rows.size(); ++k)
            for (Eigen::Index r = 0; r < rows[k].size(); ++r) {
                const double product = rows[k][r] * rows[k - static_cast<std::size_t>(lag)][r];
                if (std::isnan(product)) continue;
                products.sum[lag - 1] += product;
                ++products.count[lag - 1];
            }
    return products;
}

oracle::Trial oracle_trial(const DeformableSettings& scenario, std::uint64_t trial) {
    return oracle::run(scenario, Controller::fixed, for_oracle(keyed_noise(scenario, 7, trial)));
}

}  // namespace

TEST_CASE("evidence: NIS of features and of edges, squared errors and variances are the oracle's") {
    for (const Settings& world : worlds()) {
        CAPTURE(described(world));
        const DeformableSettings scenario = scenario_with(scenario_with(world), {{"arms.controllers", "fixed"}});
        const Run run = run_arm(scenario, Controller::fixed, keyed_noise(scenario, 7, 3));
        const oracle::Trial oracle = oracle_trial(scenario, 3);
        for (int k = 1; k < scenario.poses; ++k) {
            const oracle::Step& step = oracle.steps[static_cast<std::size_t>(k)];
            const Eigen::Index seen = 2 * std::count(step.seen.begin(), step.seen.end(), true),
                               rest = step.innovation.size() - seen;
            // Conditioning of S as in the tests of the filter: 1e-9 leaves room for it.
            CHECK(run.figure("nis_features", k) ==
                  Approx(quadratic(step.innovation.head(seen), step.innovation_covariance.topLeftCorner(seen, seen)))
                      .epsilon(1e-9));
            CHECK(
                run.figure("nis_edges", k) ==
                Approx(quadratic(step.innovation.tail(rest), step.innovation_covariance.bottomRightCorner(rest, rest)))
                    .epsilon(1e-9));
            for (const ComponentGroup& block : state_groups(scenario)) {
                const auto e = (step.mean - step.truth).segment(block.first, block.count);
                const auto P = step.covariance.diagonal().segment(block.first, block.count);
                const std::string suffix = block.name == "all" ? "" : "_" + block.name;
                CHECK(run.figure("squared_error" + suffix, k) == Approx(e.squaredNorm()).epsilon(1e-9));
                CHECK(run.figure(block.name == "all" ? "trace_P_step" : "variance" + suffix, k) ==
                      Approx(P.sum()).epsilon(1e-9));
            }
        }
        CHECK(run.columns[column_mean_trace_P] == Approx(run.series("trace_P_step").mean()).epsilon(1e-14));
    }
}

TEST_CASE("evidence: errors and products of whitened innovations of detailed trials are the oracle's") {
    for (const Settings& world : worlds()) {
        CAPTURE(described(world));
        const DeformableSettings scenario = scenario_with(scenario_with(world), {{"arms.controllers", "fixed"}});
        const int trials = 11, features = static_cast<int>(scenario.features.positions.size()),
                  edges = static_cast<int>(edge_list(scenario).size()), lags = lag_count(scenario.poses);
        const Block block = run_block(Problem(scenario), 7, 0, trials);
        const ArmBlock& arm = block.arms.front();
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(lags), squares = sum, count = sum;
        const Eigen::Index n = state_size(scenario), steps = scenario.poses - 1;
        for (int trial = 0; trial < trials; ++trial) {
            const oracle::Trial oracle = oracle_trial(scenario, static_cast<std::uint64_t>(trial));
            const Products products = products_of(oracle, features, edges, lags);
            sum += products.sum;
            squares += products.sum.cwiseAbs2();
            count += products.count;
            for (Eigen::Index k = 0; k < steps; ++k) {
                const oracle::Step& step = oracle.steps[static_cast<std::size_t>(k + 1)];
                const std::size_t row = static_cast<std::size_t>(trial * steps + k);
                CHECK(arm.nees[row] == Approx(step.nees).epsilon(1e-6));  // single precision
                for (Eigen::Index i = 0; i < n; ++i)
                    CHECK(arm.errors[row * static_cast<std::size_t>(n) + static_cast<std::size_t>(i)] ==
                          Approx(step.mean[i] - step.truth[i]).epsilon(1e-6).margin(1e-9));
            }
        }
        for (int lag = 0; lag < lags; ++lag) {
            CAPTURE(lag);
            const auto l = static_cast<std::size_t>(lag);
            CHECK(arm.product_counts[l] == count[lag]);
            // Sums of terms of size 1: the error is that of their whitening, 1e-10, times their number.
            CHECK(arm.product_sums[l] == Approx(sum[lag]).margin(1e-10 * count[lag]));
            CHECK(arm.product_square_sums[l] == Approx(squares[lag]).epsilon(1e-6).margin(1e-6));
        }
    }
}

TEST_CASE("evidence: later blocks have no details, and many edges are not whitened") {
    const DeformableSettings scenario = scenario_with({{"arms.controllers", "fixed"}});
    const Block later = run_block(Problem(scenario), 7, 16, 3);
    CHECK(later.arms.front().errors.empty());
    CHECK(later.arms.front().product_sums.empty());
    CHECK(later.arms.front().cells.size() == 3 * 19);
    CHECK(detailed_trials(19, 9) == 4096);
    CHECK(detailed_trials(99, 131) == 1280);     // 2^24 / (99 * 132) = 1283 trials, in whole blocks
    CHECK(detailed_trials(100000, 131) == 256);  // never fewer than a block
    CHECK(edges_whitened(3, 3));
    CHECK_FALSE(edges_whitened(64, 2016));
}

TEST_CASE("evidence: coverage and cells count the trials that did not fail") {
    // Near singular: some trials fail.
    const DeformableSettings scenario = scenario_with({{"arms.controllers", "fixed"},
                                                       {"noise.heading", "0.9"},
                                                       {"sensor.sigma", "1e-9"},
                                                       {"noise.odometry", "1e-7"},
                                                       {"filter.edges", "1e-7"}});
    for (const DeformableSettings& world : {scenario, scenario_with({{"arms.controllers", "fixed"}})}) {
        ScenarioResults results = empty_results(world);
        extend(results, 300);
        const Problem problem(world);
        for (const std::int64_t b : {0, 1}) {
            const Block block = run_block(problem, 3, b, trials_in_block(300, b));
            store_columns(results, block);
            add_totals(results, block);
        }
        const ArmResults& arm = results.arms.front();
        const Eigen::Index steps = results.steps();
        std::vector<Eigen::MatrixXd> covered(state_groups(world).size(), Eigen::MatrixXd::Zero(steps, 4));
        Eigen::MatrixXd cells = Eigen::MatrixXd::Zero(steps, distribution_cells);
        for (std::uint64_t trial = 0; trial < 300; ++trial) {
            const Run run = run_arm(world, Controller::fixed, keyed_noise(world, 3, trial));
            if (failed(static_cast<Status>(static_cast<int>(run.columns[column_status])))) continue;
            for (std::size_t b = 0; b < covered.size(); ++b)
                for (Eigen::Index k = 0; k < steps; ++k) {
                    const double value = run.figures(static_cast<Eigen::Index>(b), k);
                    const boost::math::chi_squared distribution(state_groups(world)[b].count);
                    const double share = boost::math::cdf(distribution, std::min(value, 1e6));
                    for (Eigen::Index level = 0; level < 4; ++level)
                        covered[b](k, level) += share < coverage_levels[level];
                    if (b == 0)
                        ++cells(k, std::min<Eigen::Index>(distribution_cells - 1,
                                                          static_cast<Eigen::Index>(share * distribution_cells)));
                }
        }
        for (std::size_t b = 0; b < covered.size(); ++b)
            for (Eigen::Index k = 0; k < steps; ++k)
                for (Eigen::Index level = 0; level < 4; ++level)
                    CHECK(static_cast<double>(arm.totals.series[b].covered[static_cast<std::size_t>(4 * k + level)]) ==
                          covered[b](k, level));
        for (Eigen::Index k = 0; k < steps; ++k)
            for (Eigen::Index cell = 0; cell < distribution_cells; ++cell)
                if (static_cast<double>(arm.totals.cells[static_cast<std::size_t>(k * distribution_cells + cell)]) !=
                    cells(k, cell))
                    FAIL_CHECK("cell " << cell << " of step " << k + 1);
    }
}

TEST_CASE("evidence: stable quantiles of chi-square are Boost's") {
    for (const int degrees : {1, 2, 3, 4, 5, 9, 20, 131, 1000}) {
        const boost::math::chi_squared distribution(degrees);
        const EquiprobableCells cells(degrees);
        double worst = 0;
        for (int i = 1; i < distribution_cells; ++i) {
            const double expected = boost::math::quantile(distribution, static_cast<double>(i) / distribution_cells);
            const double bound = cells.upper()[static_cast<std::size_t>(i - 1)];
            worst = std::max(worst, std::abs(bound / expected - 1));
            CHECK(cells.cell(bound) == i);
            CHECK(cells.cell(std::nextafter(bound, 0)) == i - 1);
        }
        CHECK(worst < 5e-11);  // the series for 1000 degrees has 500 factors
        CHECK(cells.cell(0) == 0);
        CHECK(cells.cell(1e300) == distribution_cells - 1);
        CHECK(cells.cell(infinity) == distribution_cells - 1);
        for (const double level : coverage_levels)
            CHECK(stable_chi_square_quantile(level, degrees) ==
                  Approx(boost::math::quantile(distribution, level)).epsilon(2e-12));
    }
}

}  // namespace credence::test::evidence_test
