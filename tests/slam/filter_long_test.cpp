// Long trials and other numbers of features against the oracle, to a bound that follows from the condition of S.
//
// One update: the gain comes from solving with S, m rows, so either way of computing it errs by m cond(S) u relative,
// u = 2^-53 [Higham, Accuracy and Stability of Numerical Algorithms, 10.1], and what it takes off P, K S K', is at most
// P^-. Predicting and subtracting add n u. With g_i = (n + m_i cond(S_i)) u:
//     |dP_i| <= g_i |P^-_i|,   |dx_i| <= g_i |x_i|   (a correction is smaller than the state).
// Later updates contract an error as they contract the uncertainty, so over a trial the steps at worst add up. Then, to
// first order, with e the estimation error and lambda the smallest eigenvalue:
//     dNEES/NEES <= |dP|/lambda(P) + 2 |dx| / sqrt(lambda(P) NEES) + n cond(P) u,   the same for NIS with S and nu.
// What is seen is 10 to 1000 times below; a wrong term of any equation is above by many powers of ten, as every test
// also asks that the bound itself is small.

#include "catch.hpp"
#include "support.hpp"

#include <random>

namespace credence::test::filter_long_test {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double unit_roundoff = 0x1p-53;

/// Bounds on absolute errors so far.
struct Budget {
    double mean = 0, covariance = 0;

    void spend(const oracle::Step& step) {
        const double g = (static_cast<double>(step.mean.size()) + step.rows * step.condition_of_S) * unit_roundoff;
        mean += g * step.mean.norm();
        covariance += g * step.prior_covariance.norm();
    }

    /// Relative bound on a squared error e' A^-1 e of value q, A of size n.
    double of_square(const MatrixXd& A, double q, double dA, double de) const {
        const VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues();
        const double least = eigenvalues.minCoeff(), condition = eigenvalues.maxCoeff() / least;
        return dA / least + 2 * de / std::sqrt(least * q) + static_cast<double>(A.rows()) * condition * unit_roundoff;
    }
};

void check_step(const Run& ours, const oracle::Step& theirs, int k, const Budget& budget) {
    const RunStep& step = ours.steps[static_cast<std::size_t>(k)];
    CHECK(step.seen == theirs.seen);
    CHECK((step.mean - theirs.mean).norm() <= budget.mean);
    CHECK((step.covariance - theirs.covariance).norm() <= budget.covariance);
    CHECK(budget.mean < 1e-9 * theirs.mean.norm());
    CHECK(budget.covariance < 1e-7 * theirs.covariance.norm());
    const double nees = budget.of_square(theirs.covariance, theirs.nees, budget.covariance, budget.mean);
    CHECK(relative(ours.figure("nees", k), theirs.nees) <= nees);
    CHECK(nees < 1e-5);
    if (theirs.rows == 0) return;
    // H is made of unit rows and levers of at most the range of sight, 2, but for an edge: |H|^2 below 2 (1 + 2)^2.
    const double reach = 3 * std::sqrt(2.0);
    const double nis = budget.of_square(theirs.innovation_covariance, theirs.nis, reach * reach * budget.covariance,
                                        reach * budget.mean);
    CHECK(relative(ours.figure("nis", k), theirs.nis) <= nis);
    CHECK(nis < 1e-5);
}

void check_trial(const Settings& settings, Controller controller, std::uint64_t trial) {
    const DeformableSettings scenario = scenario_with(settings);
    const AnyNoise noise = keyed_noise(scenario, 30, trial);
    const Run ours = run_arm(scenario, controller, noise);
    const oracle::Trial theirs = oracle::run(scenario, controller, for_oracle(noise));
    Budget budget;
    for (int k = 1; k < scenario.poses; ++k) {
        CAPTURE(described(settings), static_cast<int>(controller), trial, k);
        budget.spend(theirs.steps[static_cast<std::size_t>(k)]);
        check_step(ours, theirs.steps[static_cast<std::size_t>(k)], k, budget);
    }
    CHECK(ours.columns[column_unseen] == theirs.unseen);
}

/// M features in a square of side 2 about the robot, as a value of features.positions.
std::string scattered(int count) {
    std::mt19937 random(static_cast<unsigned>(count));
    std::uniform_int_distribution<int> place(-100, 100);
    std::string text;
    for (int coordinate = 0; coordinate < 2 * count; ++coordinate)
        text += (coordinate == 0 ? "" : coordinate % 2 ? " " : ", ") + std::to_string(place(random) / 100.0);
    return text;
}

Settings with_features(const char* process, int count) {
    return {{"model.process", process}, {"features.path", "circle"}, {"sensor.noise", "ranged"},
            {"features.positions", scattered(count)}};
}

}  // namespace

TEST_CASE("filter: 200 poses agree with the oracle") {
    for (Settings cell : seed_cells()) {
        cell.emplace_back("scenario.poses", "200");
        for (std::uint64_t trial = 0; trial < 3; ++trial) check_trial(cell, Controller::fixed, trial);
        if (cell[1].second == "straight") check_trial(cell, Controller::greedy, 0);
    }
}

TEST_CASE("filter: 1 to 7 features agree with the oracle on fixed paths") {
    for (const char* process : {"heading", "translation"})
        for (const int count : {1, 2, 4, 5, 6, 7})
            for (std::uint64_t trial = 0; trial < 5; ++trial)
                check_trial(with_features(process, count), Controller::fixed, trial);
}

TEST_CASE("filter: 1 to 7 features agree with the oracle on planned paths") {
    for (const char* process : {"heading", "translation"})
        for (const int count : {1, 2, 5, 7}) check_trial(with_features(process, count), Controller::greedy, 0);
}

TEST_CASE("filter: 64 features in a chain agree with the oracle") {
    for (const char* process : {"heading", "translation"}) {
        Settings settings = with_features(process, 64);
        settings.insert(settings.end(), {{"edges.graph", "chain"}, {"scenario.poses", "8"}});
        check_trial(settings, Controller::fixed, 0);
    }
}

TEST_CASE("filter: 64 features with all 2016 edges agree with the update in information form") {
    // 4160 rows are too many for the joint update; P^-1 + H' N^-1 H has 131 [Bar-Shalom 2001, 7.2.2].
    Settings settings = with_features("heading", 64);
    settings.emplace_back("scenario.poses", "2");
    const DeformableSettings scenario = scenario_with(settings);
    const Run run = run_arm(scenario, Controller::fixed, keyed_noise(scenario, 30, 1));
    const RunStep& step = run.steps.back();
    MatrixXd information = step.prior_covariance.inverse();
    VectorXd pull = VectorXd::Zero(step.mean.size());
    const auto add = [&](const MatrixXd& H, const Eigen::Vector2d& nu, double sigma) {
        information += H.transpose() * H / (sigma * sigma);
        pull += H.transpose() * nu / (sigma * sigma);
    };
    for (int j = 0; j < 64; ++j) {
        if (!step.seen[static_cast<std::size_t>(j)]) continue;
        const Eigen::Vector2d z = step.sighting.row(j);
        add(oracle::measurement_rows(scenario, step.prior_mean, j),
            z - oracle::predicted_measurement(scenario, step.prior_mean, j), step.sigma[j]);
    }
    const std::vector<Edge> edges = edge_list(scenario);
    REQUIRE(edges.size() == 2016);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const Eigen::Vector2d z = step.edge.row(static_cast<Eigen::Index>(e));
        add(oracle::edge_rows(scenario, edges[e]), z - oracle::predicted_edge(scenario, step.prior_mean, edges[e]),
            0.2);
    }
    const MatrixXd P = information.inverse();
    // Both inverses lose the condition of the prior, below 1e6, and 2080 updates add their rounding: 1e6 * 131 * 2^-53.
    const double tolerance = 1.5e-8;
    CHECK((step.covariance - P).norm() < tolerance * P.norm());
    CHECK((step.mean - step.prior_mean - P * pull).norm() < tolerance * (P * pull).norm());
}

}  // namespace credence::test::filter_long_test
