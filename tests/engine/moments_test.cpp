// The moments of detailed trials: those of the lanes are what the recorded trajectories give.

#include "catch.hpp"
#include "slam_steps.hpp"
#include "study_support.hpp"
#include "support.hpp"

#include <credence/ini.hpp>
#include <credence/detail/worlds.hpp>

namespace credence::test::moments_test {

namespace {

/// Moments as columns.hpp defines them, from truth, estimate and covariance of each step.
std::vector<double> plain_moments(const Scenario& scenario, std::size_t arm, std::int64_t trial) {
    const std::vector<TrajectoryStep> steps = steps_of(replay_trial(scenario, arm, 3, trial));
    const auto n = static_cast<Eigen::Index>(scenario.components.size());
    const double count = static_cast<double>(steps.size() - 1);
    std::vector<double> nees(scenario.groups.size());
    Eigen::VectorXd z = Eigen::VectorXd::Zero(n);
    Eigen::MatrixXd S = Eigen::MatrixXd::Zero(n, n), C = S;
    for (std::size_t k = 1; k < steps.size(); ++k) {
        Eigen::VectorXd e = steps[k].mean - steps[k].truth;
        for (Eigen::Index j = 0; j < n; ++j)
            if (scenario.components[static_cast<std::size_t>(j)].unit == "rad") e[j] = std::remainder(e[j], 2 * pi);
        const Eigen::MatrixXd& P = steps[k].covariance;
        for (std::size_t g = 0; g < nees.size(); ++g) {
            const Eigen::Index first = scenario.groups[g].first, size = scenario.groups[g].count;
            const Eigen::VectorXd part = e.segment(first, size);
            nees[g] += part.dot(Eigen::MatrixXd(P.block(first, first, size, size)).ldlt().solve(part)) / count;
        }
        const Eigen::VectorXd standardised = e.cwiseQuotient(P.diagonal().cwiseSqrt());
        z += standardised / count;
        S += standardised * standardised.transpose();
        C += P.cwiseQuotient((P.diagonal() * P.diagonal().transpose()).cwiseSqrt());
    }
    std::vector<double> moments = nees;
    moments.insert(moments.end(), z.begin(), z.end());
    for (const Eigen::MatrixXd& matrix : {S, C})
        for (Eigen::Index i = 0; i < n; ++i)
            for (Eigen::Index j = 0; j <= i; ++j) moments.push_back(matrix(i, j));
    return moments;
}

void check_moments(const std::string& text) {
    const Scenario scenario = read_scenario_text(text, "test", "s");
    const Block block = BlockRunner(world_of(scenario), scenario).run(3, 0, 20);
    const int size =
        moment_count(static_cast<int>(scenario.components.size()), static_cast<int>(scenario.groups.size()));
    for (std::size_t a = 0; a < block.arms.size(); ++a) {
        REQUIRE(block.arms[a].moments.size() == 20 * static_cast<std::size_t>(size));
        for (const std::int64_t trial : {0, 7, 19}) {
            CAPTURE(text, scenario.arms[a], trial);
            const std::vector<double> plain = plain_moments(scenario, a, trial);
            REQUIRE(plain.size() == static_cast<std::size_t>(size));
            for (std::size_t i = 0; i < plain.size(); ++i)
                CHECK(block.arms[a].moments[static_cast<std::size_t>(trial) * plain.size() + i] ==
                      Approx(plain[i]).epsilon(1e-8).margin(1e-8));
        }
    }
}

}  // namespace

TEST_CASE("moments: those of the lanes are those of the recorded trajectories") {
    check_moments("");
    check_moments("[model]\nprocess = translation\n[filter]\ncovariance = 1.3\n");
    check_moments("[scenario]\nworld = explore\nposes = 30\n[landmarks]\nmap = prior\n");
}

TEST_CASE("moments: later blocks, and states of more than 64 components, keep none") {
    const Scenario scenario = read_scenario_text("", "test", "s");
    CHECK(BlockRunner(world_of(scenario), scenario).run(3, 16, 3).arms.front().moments.empty());
    CHECK(moment_count(64, 3) == 3 + 64 + 64 * 65);
    CHECK(moment_count(65, 3) == 0);
}

}  // namespace credence::test::moments_test
