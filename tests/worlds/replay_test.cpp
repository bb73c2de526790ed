// Trials of every world, replayed: the engine's bits, and variables from which its NEES and NIS follow.

#include "catch.hpp"
#include "landmark_loop.hpp"
#include "slam_steps.hpp"
#include "study_support.hpp"
#include "worlds/explore/explore.hpp"

#include <credence/ini.hpp>
#include <credence/own_world.hpp>
#include <credence/detail/worlds.hpp>

#include <bit>

namespace credence::test::replay_test {

namespace {

/// A world whose covariance is larger than what is recorded.
struct LargeState {
    struct Settings {};
    static constexpr const char* name = "large_state";
    static void keys(OwnKeys<Settings>&) {}
    static std::vector<Component> components(const Settings&) {
        std::vector<Component> all;
        for (std::size_t i = 0; i <= largest_recorded_matrix; ++i) all.push_back({"x" + std::to_string(i), "m"});
        return all;
    }
    static std::vector<ComponentGroup> groups(const Settings&) { return {}; }
    static std::vector<std::string> arms(const Settings&) { return {"filter"}; }
    static int innovation_rows(const Settings&) { return 0; }
    static void run(const Settings&, OwnTrial& trial) {
        constexpr auto n = static_cast<Eigen::Index>(largest_recorded_matrix + 1);
        for (int k = 1; k < trial.poses(); ++k) trial.step(Eigen::VectorXd::Ones(n), Eigen::MatrixXd::Identity(n, n));
    }
};
const bool added = (add_own_world<LargeState>(), true);

Study study_of(const Scenario& scenario, std::int64_t trials) {
    Study study = new_study(std::vector{scenario}, 5);
    run_study(study, {trials, 2, {}});
    return study;
}

/// Every column of these trials, in every arm, is that of the study.
void check_bits(const Scenario& scenario, const std::vector<std::int64_t>& trials) {
    const Study study = study_of(scenario, trials.back() + 1);
    const ScenarioResults& results = study.scenarios.front();
    for (std::size_t a = 0; a < results.arms.size(); ++a)
        for (const std::int64_t trial : trials) {
            CAPTURE(results.arms[a].name, trial);
            const Trajectory replayed = replay_trial(scenario, a, 5, trial);
            CHECK(replayed.arm == results.arms[a].name);
            REQUIRE(replayed.column_values.size() == results.columns.size());
            for (std::size_t c = 0; c < results.columns.size(); ++c)
                CHECK(std::bit_cast<std::uint64_t>(replayed.column_values[c]) ==
                      std::bit_cast<std::uint64_t>(results.arms[a].columns.values(c, trial, 1).front()));
        }
}

/// v' M^-1 v over the entries of v that are numbers.
double mahalanobis(const Eigen::VectorXd& v, const Eigen::MatrixXd& M) {
    std::vector<Eigen::Index> given;
    for (Eigen::Index i = 0; i < v.size(); ++i)
        if (!std::isnan(v[i])) given.push_back(i);
    const Eigen::VectorXd chosen = v(given);
    return given.empty() ? 0 : chosen.dot(Eigen::MatrixXd(M(given, given)).ldlt().solve(chosen));
}

Scenario own(const std::string& world) {
    return read_scenario_text("[scenario]\nworld = " + world + "\nposes = 12\n", "test", "mine");
}

}  // namespace

TEST_CASE("replay: a trial among landmarks has the engine's bits under every estimator") {
    check_bits(scenario_of(resolved(landmark_loop(40))), {0, 9, 256, 300});
}

TEST_CASE("replay: a trial of a user's own world has the engine's bits, failed ones too") {
    check_bits(own("tracker"), {0, 7, 256});
    check_bits(own("spoiled"), {0, 3});
}

TEST_CASE("replay: NEES, NIS and rows among landmarks follow from the recorded matrices") {
    const Scenario scenario = scenario_of(resolved(landmark_loop(25)));
    const Trajectory trajectory = replay_trial(scenario, 0, 5, 1);
    const std::vector<TrajectoryStep> steps = steps_of(trajectory);
    int first_sights = 0;
    for (std::size_t k = 1; k < steps.size(); ++k) {
        const TrajectoryStep& step = steps[k];
        CHECK(step.nis == Approx(mahalanobis(step.innovation, step.innovation_covariance)).epsilon(1e-9));
        CHECK(step.rows == 2 * std::count(step.seen.begin(), step.seen.end(), true));
        CHECK(step.trace_P == Approx(step.covariance.trace()).epsilon(1e-13));
        CHECK(step.control.move.x != 0);
        // A landmark at first sight enters the belief, but not the update: P may fall although it was not measured.
        for (std::size_t j = 0; j < step.seen.size(); ++j) {
            const auto at = static_cast<Eigen::Index>(3 + 2 * j);
            first_sights += !step.seen[j] && step.covariance(at, at) < 0.9 * step.predicted_covariance(at, at);
        }
        Eigen::VectorXd error = step.mean - step.truth;
        error[0] = std::remainder(error[0], 2 * pi);
        CHECK(step.nees == Approx(mahalanobis(error, step.covariance)).epsilon(1e-8));
    }
    CHECK(first_sights > 0);
}

TEST_CASE("replay: NEES, NIS and trace(P) of an own world follow from the recorded matrices") {
    for (const char* world : {"tracker", "spoiled"}) {
        const Scenario scenario = own(world);
        for (std::size_t arm = 0; arm < scenario.arms.size(); ++arm) {
            const Trajectory trajectory = replay_trial(scenario, arm, 5, 2);
            CAPTURE(scenario.arms[arm]);
            const auto n = static_cast<Eigen::Index>(scenario.components.size());
            const auto m = values_at(trajectory, "innovation", 0).size();
            for (int k = 0; k < scenario.poses; ++k) {
                const auto at = [&](const char* name, Eigen::Index columns = 1) {
                    return values_at(trajectory, name, k, columns);
                };
                const double nees = at("nees")(0);
                CHECK(std::isnan(nees) ==
                      (k == 0 || (world == std::string("spoiled") && (arm == 1 || arm == 2) && k >= 3)));
                if (std::isnan(nees)) continue;
                CHECK(nees == Approx(mahalanobis(at("error"), at("covariance", n))).epsilon(1e-9));
                CHECK(at("nis")(0) ==
                      Approx(mahalanobis(at("innovation"), at("innovation_covariance", m))).epsilon(1e-9));
                CHECK(at("trace_P")(0) == Approx(at("covariance", n).trace()).epsilon(1e-13));
            }
        }
    }
}

TEST_CASE("replay: a covariance beyond the recorded size is left out, and a note says so") {
    REQUIRE(added);
    const Trajectory trajectory =
        replay_trial(read_scenario_text("[scenario]\nworld = large_state\nposes = 3\n", "test", "large"), 0, 1, 0);
    CHECK(find_variable(trajectory, "covariance") == nullptr);
    CHECK(find_variable(trajectory, "innovation") == nullptr);
    REQUIRE(trajectory.notes.size() == 1);
    CHECK(trajectory.notes.front() ==
          std::pair<std::string, std::string>("covariance_omitted", "513 rows, more than the 512 that are kept"));
    CHECK(values_at(trajectory, "error", 2).isOnes());
    CHECK(values_at(trajectory, "nees", 2)(0) == Approx(513));
}

}  // namespace credence::test::replay_test
