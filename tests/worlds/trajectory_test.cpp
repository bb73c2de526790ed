// A replayed trial is the engine's, bit for bit, and its stored quantities are consistent.

#include "catch.hpp"
#include "study_support.hpp"

#include <credence/error.hpp>
#include "slam_steps.hpp"
#include "worlds/deformable/deformable.hpp"
#include "slam/trial/problem.hpp"

#include <bit>

namespace credence::test::trajectory_test {

namespace {

double mahalanobis(const Eigen::VectorXd& e, const Eigen::MatrixXd& P) { return e.dot(P.ldlt().solve(e)); }

}  // namespace

TEST_CASE("trajectory: a replayed trial has the bits of the engine's columns, in every arm") {
    const Study study = small_study(3, 300, 2);
    for (const ScenarioResults& results : study.scenarios) {
        const Problem problem(settings_of(results.scenario));
        for (std::size_t a = 0; a < results.arms.size(); ++a)
            for (const std::int64_t trial : {0, 17, 255, 256, 299}) {
                const Trajectory t = replay_trial(problem, arms_of(problem.scenario())[a], 3, trial);
        const std::vector<TrajectoryStep> steps = steps_of(t);
                for (std::size_t c = 0; c < t.column_values.size(); ++c)
                    CHECK(std::bit_cast<std::uint64_t>(t.column_values[c]) ==
                          std::bit_cast<std::uint64_t>(results.arms[a].columns.values(c, trial, 1).front()));
            }
    }
}

TEST_CASE("trajectory: NEES, NIS, trace and unseen of the columns follow from what is written down") {
    for (const DeformableSettings& scenario : small_scenarios()) {
        const Problem problem(scenario);
        const Trajectory t = replay_trial(problem, {Controller::greedy}, 5, 2);
        const std::vector<TrajectoryStep> steps = steps_of(t);
        const int n = state_size(scenario);
        double nees = 0, nis = 0, rows = 0, unseen = 0, score = 0, length = 0;
        for (std::size_t k = 1; k < steps.size(); ++k) {
            const TrajectoryStep& step = steps[k];
            const double own = mahalanobis(step.mean - step.truth, step.covariance);
            CHECK(step.nees == Approx(own).epsilon(1e-10));
            nees += own / n;
            length += (step.truth - steps[k - 1].truth).segment<2>(scenario.process == Process::heading).norm();
            score += (own + n * std::log(2 * pi) + std::log(step.covariance.determinant())) / 2;
            std::vector<Eigen::Index> seen;
            for (Eigen::Index i = 0; i < step.innovation.size(); ++i)
                if (!std::isnan(step.innovation[i])) seen.push_back(i);
            CHECK(static_cast<int>(seen.size()) == step.rows);
            const Eigen::VectorXd nu = step.innovation(seen);
            const Eigen::MatrixXd S = step.innovation_covariance(seen, seen);
            CHECK(step.nis == Approx(mahalanobis(nu, S)).epsilon(1e-10));
            nis += mahalanobis(nu, S);
            rows += static_cast<double>(seen.size());
            for (const bool is_seen : step.seen) unseen += !is_seen;
            CHECK(step.trace_P == Approx(step.covariance.trace()).epsilon(1e-14));
        }
        CHECK(t.column_values[column_nees_ratio] == Approx(nees / (scenario.poses - 1)).epsilon(1e-10));
        CHECK(t.column_values[column_log_score] == Approx(score / (scenario.poses - 1)).epsilon(1e-10));
        CHECK(t.column_values[column_path_length] == Approx(length).epsilon(1e-10));
        CHECK(t.column_values[column_nis_ratio] == Approx(nis / rows).epsilon(1e-10));
        CHECK(t.column_values[column_unseen] == unseen);
        CHECK(t.column_values[column_trace_P] == steps.back().trace_P);
    }
}

TEST_CASE(
    "trajectory: the planner's choice is the last of its least costs, and the step that follows keeps its promise") {
    const Problem problem(small_scenarios().front());
    const Trajectory t = replay_trial(problem, {Controller::greedy}, 5, 4);
    const std::vector<TrajectoryStep> steps = steps_of(t);
    const std::vector<Control> candidates = planner_candidates(problem.scenario());
    for (std::size_t k = 1; k < steps.size(); ++k) {
        const std::vector<double>& costs = steps[k].candidate_cost;
        REQUIRE(costs.size() == candidates.size());
        std::size_t chosen = 0;
        for (std::size_t i = 1; i < costs.size(); ++i)
            if (costs[i] <= costs[chosen] * (1 + 1e-12)) chosen = i;
        CHECK(steps[k].control == candidates[chosen]);
    }
}

TEST_CASE("trajectory: pose 0 has a belief and a truth, and nothing of a step") {
    const Problem problem(small_scenarios().front());
    const Trajectory t = replay_trial(problem, {Controller::fixed}, 1, 0);
    const std::vector<TrajectoryStep> steps = steps_of(t);
    CHECK(steps.front().mean.size() == 9);
    CHECK(steps.front().truth.size() == 9);
    CHECK(steps.front().predicted_mean.array().isNaN().all());
    CHECK(steps.front().covariance.topLeftCorner(3, 3).isZero(0));
    CHECK(find_variable(t, "candidate_turn") == nullptr);
    CHECK(steps.back().candidate_cost.empty());
}

TEST_CASE("trajectory: recorded noise that does not cover the scenario is refused") {
    NoiseRecord record;
    record.poses = 8;
    record.features = 3;
    DeformableSettings s = small_scenarios().front();
    CHECK_NOTHROW(check_covers(record, s, "r.h5"));
    s.poses = 9;
    CHECK_THROWS_AS(check_covers(record, s, "r.h5"), InputError);
    s.poses = 8;
    s.truth.edge_noise = EdgeNoise::independent;
    CHECK_THROWS_WITH(check_covers(record, s, "r.h5"), Catch::Contains("`edge` [poses, 3, 2]"));
    record.edges = 3;
    CHECK_NOTHROW(check_covers(record, s, "r.h5"));
    s.features.positions.push_back({0, 0});
    CHECK_THROWS_AS(check_covers(record, s, "r.h5"), InputError);
    s.features.positions.pop_back();
    s.sensor.detection = 0.5;
    CHECK_THROWS_AS(check_covers(record, s, "r.h5"), InputError);
}

}  // namespace credence::test::trajectory_test
