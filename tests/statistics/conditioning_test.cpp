// The bound on what rounding may do to e'P^-1e.

#include "numeric/decompositions.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <random>

#include "catch.hpp"

namespace credence::test::conditioning_test {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Long = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

constexpr double single = 0x1p-23;

/// A covariance of d components whose correlation matrix has a smallest eigenvalue of about `smallest`.
MatrixXd nearly_singular(std::mt19937_64& random, int d, double smallest) {
    std::normal_distribution<double> normal;
    const MatrixXd any = MatrixXd::NullaryExpr(d, d, [&] { return normal(random); });
    const MatrixXd Q = any.householderQr().householderQ();
    VectorXd values = VectorXd::Ones(d);
    values[0] = smallest;
    return Q * values.asDiagonal() * Q.transpose();
}

double nees(const MatrixXd& P, const VectorXd& e) {
    const Long exact = P.cast<long double>();
    const auto error = e.cast<long double>().eval();
    return static_cast<double>(error.dot(exact.ldlt().solve(error)));
}

}  // namespace

TEST_CASE(
    "conditioning: rounding a covariance to singles changes NEES by no more than the bound, and by a good part of it") {
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    for (const double smallest : {1e-1, 1e-2, 1e-3, 1e-4}) {
        double worst = 0;
        for (int i = 0; i < 300; ++i) {
            const MatrixXd P = nearly_singular(random, 5, smallest);
            const MatrixXd rounded = P.cast<float>().cast<double>();
            const VectorXd e = VectorXd::NullaryExpr(5, [&] { return normal(random); });
            const double change = std::abs(nees(rounded, e) / nees(P, e) - 1), bound = rounding_bound(P, single);
            CAPTURE(smallest, change, bound);
            CHECK(change <= bound);
            worst = std::max(worst, change / bound);
        }
        CHECK(worst > 0.02);  // the bound is for the worst of all errors, and these are drawn
    }
}

TEST_CASE(
    "conditioning: units change no bound, a component without variance none, and a singular P has no finite one") {
    std::mt19937_64 random(4);
    const MatrixXd P = nearly_singular(random, 4, 1e-6);
    const Eigen::Vector4d units(1e6, 1, 1e-6, 30);
    const double bound = rounding_bound(P, single),
                 in_units = rounding_bound(units.asDiagonal() * P * units.asDiagonal(), single);
    CHECK(std::abs(in_units / bound - 1) < 1e-6);  // the products are rounded: 1e-16 over the eigenvalue
    MatrixXd larger = MatrixXd::Zero(5, 5);
    larger.topLeftCorner(4, 4) = P;
    CHECK(std::abs(rounding_bound(larger, single) / bound - 1) < 1e-6);
    CHECK(std::isinf(rounding_bound(-MatrixXd::Ones(3, 3) + 2 * MatrixXd::Identity(3, 3), single)));
    CHECK(rounding_bound(MatrixXd::Identity(3, 3), single) == 3 * single);
    CHECK(rounding_bound(MatrixXd::Zero(2, 2), single) == 0);
}

}  // namespace credence::test::conditioning_test
