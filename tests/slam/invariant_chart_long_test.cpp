// NEES with the error in the invariant chart, against a logarithm whose exponential is summed up, and its use.

#include "slam/trial/step_evaluation.hpp"

#include "catch.hpp"
#include "filter_samples.hpp"

#include <cmath>

namespace credence::test::invariant_chart_long_test {

namespace {

/// The group element of a state: heading as a rotation, position and features as translations beside it.
MatrixXd group_element(const VectorXd& x) {
    const Eigen::Index points = (x.size() - 1) / 2;
    MatrixXd chi = MatrixXd::Identity(2 + points, 2 + points);
    chi.topLeftCorner<2, 2>() = oracle::rotation(x[0]);
    for (Eigen::Index i = 0; i < points; ++i) chi.block<2, 1>(0, 2 + i) = x.segment<2>(1 + 2 * i);
    return chi;
}

/// The sum of A^n / (n + first)! from n = 0; for first = 0 the exponential of A.
MatrixXd series(const MatrixXd& A, int first) {
    MatrixXd sum = MatrixXd::Zero(A.rows(), A.cols()), power = MatrixXd::Identity(A.rows(), A.cols());
    for (int n = 0; n < 60; ++n) {
        sum += power;
        power = power * A / (n + 1 + first);
    }
    return sum;
}

/// xi = log(chi chi^^-1), as a vector.
VectorXd logarithm_of_error(const VectorXd& truth, const VectorXd& estimate) {
    const MatrixXd between = group_element(truth) * group_element(estimate).inverse();
    MatrixXd log = MatrixXd::Zero(between.rows(), between.cols());
    log.topLeftCorner<2, 2>() = std::atan2(between(1, 0), between(0, 0)) * oracle::quarter_turn();
    log.topRows<2>().rightCols(log.cols() - 2) =
        series(log.topLeftCorner<2, 2>(), 1).inverse() * between.topRows<2>().rightCols(log.cols() - 2);
    REQUIRE((series(log, 0) - between).norm() < 1e-12 * between.norm());
    VectorXd xi(truth.size());
    xi[0] = log(1, 0);
    for (Eigen::Index i = 0; i < (truth.size() - 1) / 2; ++i) xi.segment<2>(1 + 2 * i) = log.block<2, 1>(0, 2 + i);
    return xi;
}

/// xi' (T P T')^-1 xi, P the Euclidean covariance at the estimate: T = I with the column of the heading (1; -J p^).
double nees_in_group(const VectorXd& truth, const VectorXd& estimate, const MatrixXd& P, Eigen::Index size) {
    MatrixXd T = MatrixXd::Identity(truth.size(), truth.size());
    for (Eigen::Index i = 1; i < truth.size(); i += 2)
        T.block<2, 1>(i, 0) = -oracle::quarter_turn() * estimate.segment<2>(i);
    const MatrixXd own = (T * P * T.transpose()).topLeftCorner(size, size);
    const VectorXd xi = logarithm_of_error(truth, estimate).head(size);
    return xi.dot(own.ldlt().solve(xi));
}

DeformableSettings with_estimators(const std::string& sigma) {
    Settings settings = matched_world();
    settings.insert(settings.end(), {{"noise.heading", sigma}, {"arms.estimators", "ekf, riekf"}});
    return scenario_with(settings);
}

}  // namespace

TEST_CASE("invariant chart: NEES is that of the logarithm in the group, whole state and pose") {
    using HeadingLayout = Layout<Process::heading, 3>;
    for (unsigned seed = 1; seed <= 30; ++seed) {
        const Sample sample(9, seed);
        VectorXd error = 0.5 * Sample(9, seed + 100).x;
        error[0] = seed == 1 ? 0 : seed == 2 ? 1e-9 : 0.1 * error[0] * seed;  // headings off by up to some radians
        error[0] = std::remainder(error[0], 2 * M_PI);
        const VectorXd truth = sample.x - error;
        const auto belief = belief_of<HeadingLayout>(sample.x, sample.P);
        Elimination<double, HeadingLayout::capacity> work;
        const auto nees = nees_in_invariant_chart(belief, HeadingLayout(3), error.data(), work);
        CAPTURE(seed, error[0]);
        // Solving with P, whose condition is below 1e3, and a logarithm by series: 1e-10 of the value.
        CHECK(relative(nees.all, nees_in_group(truth, sample.x, sample.P, 9)) < 1e-10);
        CHECK(relative(nees.pose, nees_in_group(truth, sample.x, sample.P, 3)) < 1e-10);
    }
}

TEST_CASE(
    "invariant chart: without an error of the heading it is the Euclidean one, and the heading's own is the same") {
    using HeadingLayout = Layout<Process::heading, 3>;
    const Sample sample(9, 7);
    VectorXd error = Sample(9, 8).x;
    error[0] = 0;
    VectorXd invariant(9);
    invariant_error(HeadingLayout(3), error.data(), invariant.data());
    CHECK(same_bits(MatrixXd(invariant), MatrixXd(error)));
    error[0] = 0.7;
    invariant_error(HeadingLayout(3), error.data(), invariant.data());
    CHECK(invariant[0] == 0.7);
    CHECK((invariant - error).norm() > 0.1);
}

TEST_CASE("invariant chart: a trial reports it where other estimators run beside the process model's own") {
    const DeformableSettings scenario = with_estimators("0.1");
    const Run run = run_arm(scenario, Controller::fixed, keyed_noise(scenario, 2, 1), Form::any_number);
    double most = 0;
    for (int k = 1; k < 20; ++k) {
        const RunStep& step = run.steps[static_cast<std::size_t>(k)];
        CHECK(relative(run.figure("nees_invariant", k), nees_in_group(step.truth, step.mean, step.covariance, 9)) <
              1e-9);
        CHECK(relative(run.figure("nees_invariant_pose", k), nees_in_group(step.truth, step.mean, step.covariance, 3)) <
              1e-9);
        most = std::max(most, relative(run.figure("nees_invariant", k), run.figure("nees", k)));
    }
    CHECK(most > 0.01);  // the charts are not the same
    // The one that is written out has the same bits.
    const Run written = run_arm(scenario, Controller::fixed, keyed_noise(scenario, 2, 1));
    CHECK(same_bits(MatrixXd(written.figures), MatrixXd(run.figures)));
    // The reported P scales it.
    DeformableSettings scaled = scenario;
    scaled.filter.covariance = 4;
    const Run quarter = run_arm(scaled, Controller::fixed, keyed_noise(scaled, 2, 1));
    CHECK(relative(quarter.figure("nees_invariant", 5), run.figure("nees_invariant", 5) / 4) < 1e-14);
}

TEST_CASE("invariant chart: scenarios of the process model's own estimator have the series that they had") {
    const auto count = [](const Settings& settings) { return step_series(scenario_with(settings)).size(); };
    CHECK(count({{"arms.estimators", "ekf, riekf"}}) == count({}) + 2);
    CHECK(count({{"arms.estimators", "iekf"}}) == count({}) + 2);
    CHECK(count({{"arms.estimators", "ekf"}}) == count({}));
    for (const Series& figure : step_series(scenario_with({{"model.process", "translation"}})))
        CHECK(figure.role != SeriesRole::nees_in_chart);
}

}  // namespace credence::test::invariant_chart_long_test
