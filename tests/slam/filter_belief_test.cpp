// The invariants of a belief, and the quantities that are computed from it.

#include "catch.hpp"
#include "filter_samples.hpp"

#include "slam/update.hpp"

#include <random>

#include <array>

namespace credence::test::filter_belief_test {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The upper triangle of a matrix as the filter keeps it.
template <int capacity>
Symmetric<double, capacity> upper_triangle(const MatrixXd& P) {
    Symmetric<double, capacity> result{};
    for (int i = 0; i < P.rows(); ++i)
        for (int j = i; j < P.rows(); ++j) result.entry[i][j] = P(i, j);
    return result;
}

MatrixXd random_covariance(int n, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const MatrixXd A = MatrixXd::NullaryExpr(n, n, [&] { return normal(random); });
    return A * A.transpose() + 0.1 * MatrixXd::Identity(n, n);
}

}  // namespace

TEST_CASE("filter: update keeps the covariance symmetric and positive definite, and never adds to it") {
    for (const Settings& cell : seed_cells()) {
        const DeformableSettings scenario = scenario_with(cell);
        for (std::uint64_t trial = 0; trial < 5; ++trial) {
            const Run run = run_arm(scenario, Controller::fixed, keyed_noise(scenario, 1, trial));
            CAPTURE(described(cell), trial);
            for (std::size_t k = 1; k < run.steps.size(); ++k) {
                const RunStep& step = run.steps[k];
                REQUIRE(step.covariance == step.covariance.transpose());
                REQUIRE(smallest_eigenvalue(step.covariance) > 0);
                // Rounding of the difference of two matrices with norms below 10.
                REQUIRE(smallest_eigenvalue(step.prior_covariance - step.covariance) > -1e-14);
            }
        }
    }
}

TEST_CASE(
    "filter: starts at 0 with features where they were first seen, and of the factors the measurement's alone counts") {
    const DeformableSettings scenario = scenario_with({{"sensor.noise", "ranged"},
                                                       {"filter.measurement", "0.5"},
                                                       {"filter.heading", "3"},
                                                       {"filter.odometry", "3"},
                                                       {"filter.features", "3"},
                                                       {"filter.edges", "3"},
                                                       {"noise.initial_heading", "0.2"},
                                                       {"noise.initial_position", "0.3"}});
    const Run run = run_arm(scenario, Controller::fixed, keyed_noise(scenario, 1, 4));
    const RunStep& start = run.steps.front();
    CHECK(start.mean.head(3).norm() == 0);
    MatrixXd expected = MatrixXd::Zero(9, 9);
    expected.diagonal().head(3) << 0.2 * 0.2, 0.3 * 0.3, 0.3 * 0.3;
    for (int j = 0; j < 3; ++j) {
        const double q = (start.truth.segment<2>(3 + 2 * j) - start.truth.segment<2>(1)).norm();
        const double sigma = 0.5 * (0.01 + 0.08 * std::max(0.0, q - 0.1) / 1.9);
        expected.diagonal().segment<2>(3 + 2 * j).setConstant(sigma * sigma);
        const Vector2<double> draw = keyed_noise(scenario, 1, 4).normal(Source::measurement, 0, j);
        const Eigen::Vector2d error = start.mean.segment<2>(3 + 2 * j) - start.truth.segment<2>(3 + 2 * j);
        CHECK((error - 2 * sigma * Eigen::Vector2d(draw.x, draw.y)).norm() < 1e-15);  // rounding of positions near 1
    }
    CHECK((start.covariance - expected).norm() < 1e-16);
}

TEST_CASE("filter: without noise the translation model's estimate is the truth") {
    const DeformableSettings scenario = scenario_with({{"model.process", "translation"}, {"features.path", "circle"},
                                             {"features.sway_amplitude", "0.4"}});
    const Run run = run_arm(scenario, Controller::fixed, silent_noise());
    // Rounding of positions below 40.
    for (const RunStep& step : run.steps) CHECK((step.mean - step.truth).norm() < 1e-13);
    CHECK(run.columns[column_pose_error] < 1e-25);
}

TEST_CASE("filter: without noise the heading model's estimate is the truth") {
    const DeformableSettings scenario =
        scenario_with({{"features.path", "circle"}, {"features.sway_amplitude", "0.4"}});
    const Run run = run_arm(scenario, Controller::fixed, silent_noise());
    for (const RunStep& step : run.steps) CHECK((step.mean - step.truth).norm() < 1e-13);  // as above
    CHECK(run.steps.back().truth[0] == Approx(19 * 0.31415926535897931).epsilon(1e-14));
}

/// The squared error of one component group.
template <int n>
SquaredError<double> squared_error(const Symmetric<double, n>& P, const VectorXd& e, int first, int count) {
    Elimination<double, n> work;
    SquaredError<double> result;
    nested_squared_errors<false>(P, e.data(), first, first + count, work,
                                 [&](int i, const SquaredError<double>& so_far) {
                                     if (i == first) result = so_far;
                                 });
    return result;
}

TEST_CASE("filter: squared errors of the whole state and of its groups are e' P^-1 e") {
    constexpr int n = 9;
    for (unsigned seed = 1; seed < 50; ++seed) {
        const MatrixXd P = random_covariance(n, seed);
        const VectorXd e = random_covariance(n, seed + 100).col(0);
        const Symmetric<double, n> kept = upper_triangle<n>(P);
        for (const auto& [first, count] : {std::pair{0, 9}, {0, 3}, {0, 1}, {1, 2}, {3, 6}, {5, 2}}) {
            const SquaredError<double> nees = squared_error(kept, e, first, count);
            const VectorXd part = e.segment(first, count);
            CHECK(nees.positive_definite);
            // cond(P) is below 1e3: 9 * 1e3 * 2^-53.
            CHECK(relative(nees.value, part.dot(P.block(first, first, count, count).inverse() * part)) < 1e-12);
        }
    }
}

TEST_CASE("filter: in the translation model one axis gives the same bits as both") {
    using Flat = Layout<Process::translation, 3>;
    constexpr int n = Flat::capacity;
    const std::array<double, 3> coefficient{1, -0.4, -0.6};
    const auto ignored = [](const auto&, int, const auto&) {};
    for (unsigned seed = 1; seed < 500; ++seed) {
        const MatrixXd P = on_both_axes(random_covariance(n / 2, seed));
        const VectorXd e = random_covariance(n, seed + 1000).col(0);
        const bool used = seed % 8 != 0;
        const auto compare = [&](const auto& rows) {
            Symmetric<double, n> both = upper_triangle<n>(P), one_axis = both;
            const auto S = condition_both_axes(both, Flat(3), rows, 0.1, used, ignored);
            const auto S_axis = condition_by_axis(one_axis, Flat(3), rows, 0.1, used, ignored);
            CHECK(S.positive_definite == S_axis.positive_definite);
            CHECK(S.slope == S_axis.slope);
            CHECK(S.precision.x == S_axis.precision.x);
            CHECK(S.precision.y == S_axis.precision.y);
            for (int i = 0; i < n; ++i)
                for (int j = i; j < n; ++j) CHECK(both.entry[i][j] == one_axis.entry[i][j]);
            Elimination<double, n> work, work_axis;
            std::vector<double> whole, by_axis;
            nested_squared_errors<false>(both, e.data(), 0, n, work,
                                         [&](int, const auto& error) { whole.push_back(error.value); });
            nested_squared_errors<true>(both, e.data(), 0, n, work_axis,
                                        [&](int, const auto& error) { by_axis.push_back(error.value); });
            CHECK(whole == by_axis);
        };
        compare(ContrastRows<Flat, double, int>{Flat(3), 0, coefficient.data()});
        compare(SightingRows<Flat, double, int>{static_cast<int>(seed % 3), {0.3, -0.7}});
    }
}

TEST_CASE("filter: a covariance that is not positive definite is noticed") {
    MatrixXd P = random_covariance(5, 3);
    const VectorXd e = VectorXd::Ones(5);
    CHECK(squared_error(upper_triangle<5>(P), e, 0, 5).positive_definite);
    P -= (smallest_eigenvalue(P) + 1e-3) * MatrixXd::Identity(5, 5);
    CHECK_FALSE(squared_error(upper_triangle<5>(P), e, 0, 5).positive_definite);
    MatrixXd singular = MatrixXd::Identity(3, 3);
    singular(1, 1) = 0;
    CHECK_FALSE(squared_error(upper_triangle<3>(singular), e, 0, 3).positive_definite);
    CHECK(squared_error(upper_triangle<3>(singular), e, 2, 1).positive_definite);
    singular(1, 1) = not_a_number;
    CHECK_FALSE(squared_error(upper_triangle<3>(singular), e, 0, 3).positive_definite);
}

TEST_CASE("filter: an innovation covariance that is not positive definite is noticed where it is used") {
    using Flat = Layout<Process::translation, 3>;
    const Symmetric<double, 8> negative = upper_triangle<8>(-MatrixXd::Identity(8, 8));
    const std::array<double, 3> coefficient{1, -1, 0};
    const ContrastRows<Flat, double, int> rows{Flat(3), 0, coefficient.data()};
    for (const bool used : {true, false}) {
        Symmetric<double, 8> P = negative;
        const auto ignored = [](const auto&, int, const auto&) {};
        CHECK(condition(P, Flat(3), rows, 0.1, used, ignored).positive_definite == !used);
        if (!used) CHECK(trace(P, 8) == trace(negative, 8));
    }
}

TEST_CASE("filter: three features known to the compiler give the same bits as any number") {
    for (const Settings& cell : seed_cells())
        for (const Controller controller : {Controller::fixed, Controller::greedy}) {
            const DeformableSettings scenario = scenario_with(cell);
                CAPTURE(described(cell), static_cast<int>(controller));
            for (std::uint64_t trial = 0; trial < 3; ++trial) {
                const AnyNoise noise = keyed_noise(scenario, 2, trial);
                const Run three = run_arm(scenario, controller, noise),
                          any = run_arm(scenario, controller, noise, Form::any_number);
                CHECK(same_bits(three.columns, any.columns));
                CHECK(same_bits(three.figures, any.figures));
                CHECK(same_bits(three.steps.back().covariance, any.steps.back().covariance));
            }
        }
}

TEST_CASE("filter: the covariance factor scales what is reported and touches nothing else") {
    for (const Controller controller : {Controller::fixed, Controller::greedy}) {
        const Settings cell{{"features.path", "circle"}, {"sensor.noise", "ranged"}};
        const DeformableSettings plain = scenario_with(cell),
                                 scaled = scenario_with(plain, {{"filter.covariance", "4"}});
        const Run one = run_arm(plain, controller, keyed_noise(plain, 2, 1));
        const Run four = run_arm(scaled, controller, keyed_noise(plain, 2, 1));
        // Powers of two, so to the bit.
        CHECK(four.columns[column_trace_P] == 4 * one.columns[column_trace_P]);
        // One more rounding a step.
        CHECK(four.columns[column_nees_ratio] == Approx(one.columns[column_nees_ratio] / 4).epsilon(1e-14));
        for (const int same : {column_unseen, column_pose_error, column_nis_ratio, column_status})
            CHECK(four.columns[static_cast<std::size_t>(same)] == one.columns[static_cast<std::size_t>(same)]);
        for (std::size_t k = 0; k < one.steps.size(); ++k) {
            CHECK(same_bits(four.steps[k].mean, one.steps[k].mean));
            CHECK(same_bits(four.steps[k].covariance, one.steps[k].covariance));
            CHECK(four.steps[k].candidate_cost == one.steps[k].candidate_cost);
        }
        CHECK(same_bits(four.series("nees_pose"), one.series("nees_pose") / 4));
        CHECK(same_bits(four.series("trace_P_step"), one.series("trace_P_step") * 4));
        CHECK(same_bits(four.series("standardised_error_r_x"), one.series("standardised_error_r_x") / 2));
        CHECK(same_bits(four.series("nis"), one.series("nis")));
    }
}

}  // namespace credence::test::filter_belief_test
