// What the planners minimise [docs/model.md, Criteria]: each criterion beside dense matrices, and the choices by it.

#include "catch.hpp"
#include "filter_samples.hpp"

namespace credence::test::criteria_test {

namespace {

/// A covariance whose eigenvalues lie up to ten orders of magnitude apart.
MatrixXd wide_covariance(int n, std::mt19937& random) {
    std::normal_distribution<double> normal;
    MatrixXd A(n, n);
    for (double& entry : A.reshaped()) entry = normal(random);
    const MatrixXd Q = A.householderQr().householderQ();
    VectorXd values(n);
    for (double& value : values) value = std::pow(10, 1.6 * normal(random));
    return Q * values.asDiagonal() * Q.transpose();
}

/// As a filter of that layout may have it: the same for both axes, and independent of each other, if it is by axis.
template <class Layout>
MatrixXd covariance_for(const Layout& layout, std::mt19937& random) {
    if constexpr (!Layout::by_axis) return wide_covariance(layout.size(), random);
    const MatrixXd one = wide_covariance(layout.size() / 2, random);
    MatrixXd P = MatrixXd::Zero(layout.size(), layout.size());
    for (int i = 0; i < one.rows(); ++i)
        for (int j = 0; j < one.cols(); ++j) P(2 * i, 2 * j) = P(2 * i + 1, 2 * j + 1) = one(i, j);
    return P;
}

/// The cost by Eigen's decompositions.
double dense_cost(const MatrixXd& P, Criterion criterion, double heading_weight, int pose) {
    const auto n = P.rows();
    VectorXd weight = VectorXd::Ones(n);
    if (pose == 3) weight[0] = heading_weight;
    const auto log_det = [](const MatrixXd& A) { return std::log(A.determinant()); };
    const MatrixXd weighted = weight.cwiseSqrt().asDiagonal() * P * weight.cwiseSqrt().asDiagonal();
    switch (criterion) {
        case Criterion::log_det: return log_det(P);
        case Criterion::max_eigenvalue:
            return Eigen::SelfAdjointEigenSolver<MatrixXd>(weighted, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
        case Criterion::pose_trace: return weighted.topLeftCorner(pose, pose).trace();
        case Criterion::pose_log_det: return log_det(P.topLeftCorner(pose, pose));
        case Criterion::features_trace: return P.bottomRightCorner(n - pose, n - pose).trace();
        case Criterion::trace: break;
    }
    return weighted.trace();
}

template <class Layout>
void check_costs(const char* process) {
    std::mt19937 random(5);
    for (const char* weight : {"1", "0", "25"})
        for (const Settings& criterion : criteria()) {
            const Problem problem(scenario_with({{"model.process", process}, criterion.front(),
                                                 {"planner.heading_weight", weight}}));
            const ControlParameters& control = problem.view().control;
            for (int sample = 0; sample < 200; ++sample) {
                const MatrixXd P = covariance_for(Layout(3), random);
                auto belief = belief_of<Layout>(VectorXd::Zero(P.rows()), P);
                const double cost = cost_of(belief.covariance, control, Layout(3)),
                             dense_one = dense_cost(P, control.criterion, std::stod(weight), Layout::pose_size);
                CAPTURE(described(criterion), weight, sample);
                // A determinant's relative error is about cond(P) 2^-53, and cond(P) is below 1e13.
                if (scale_of(control.criterion) == CostScale::logarithmic)
                    CHECK(std::abs(cost - dense_one) < 1e-2);
                else
                    CHECK(relative(cost, dense_one) < 1e-12);  // of sums of 9 terms
                CHECK(same_bits(dense(belief, P.rows()),
                                dense(belief_of<Layout>(VectorXd::Zero(P.rows()), P), P.rows())));
            }
        }
}

}  // namespace

TEST_CASE("criteria: every cost is that of Eigen's dense decompositions") {
    check_costs<Layout<Process::heading, 3>>("heading");
    check_costs<Layout<Process::translation, 3>>("translation");
}

TEST_CASE("criteria: by each of them, controls and their costs are the oracle's") {
    for (const Settings& criterion : criteria())
        for (const Settings& cell : seed_cells()) {
            Settings settings = cell;
            settings.insert(settings.end(), criterion.begin(), criterion.end());
            settings.insert(settings.end(), {{"planner.speeds", "3"}, {"scenario.poses", "10"}});
            const DeformableSettings scenario = scenario_with(settings);
            const AnyNoise noise = keyed_noise(scenario, 5, 100);
            const Run ours = run_arm(scenario, Controller::greedy, noise);
            const Difference worst = difference(ours, oracle::run(scenario, Controller::greedy, for_oracle(noise)));
            CAPTURE(described(settings));
            CHECK(worst.same_control);
            // As in controller_test; a logarithm may be near 0.
            CHECK(worst.cost < 1e-8);
        }
}

TEST_CASE("criteria: two steps ahead, controls and their costs are the oracle's") {
    for (const Settings& criterion : criteria())
        for (const char* process : {"heading", "translation"}) {
            const DeformableSettings scenario =
                scenario_with({{"model.process", process}, {"arms.controllers", "horizon"}, {"planner.speeds", "2"},
                               {"scenario.poses", "8"}, criterion.front()});
            const AnyNoise noise = keyed_noise(scenario, 6, 3);
            const Run ours = run_arm(scenario, Controller::horizon, noise);
            const Difference worst = difference(ours, oracle::run(scenario, Controller::horizon, for_oracle(noise)));
            CAPTURE(process, described(criterion));
            CHECK(worst.same_control);
            CHECK(worst.cost < 1e-8);
        }
}

TEST_CASE("criteria: equals are decided alike, the later one, where costs are negative logarithms") {
    Choice<double> choice;
    choice.scale = CostScale::logarithmic;
    for (const auto& [turn, cost] : {std::pair{0.0, -50.0}, {1.0, -50.0 + 5e-12}, {2.0, -50.0 + 2e-11}, {3.0, -49.0}})
        choice.offer({turn, {turn, turn}}, cost);
    CHECK(choice.command.turn == 1);
    CHECK(choice.best == -50);
}

}  // namespace credence::test::criteria_test
