// Predictions and updates beside the formulas of the information filter and of plain sigma points, and in lanes.

#include "catch.hpp"

#include <credence/filters.hpp>

#include <cmath>
#include <random>
#include <vector>

namespace credence::test::filters_long_test {

namespace {

using Long = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

template <class Matrix>
Long exact(const Matrix& matrix) { return matrix.template cast<long double>(); }
/// Number of bits lost at most: the difference relative to the largest entry.
double distance(const Long& a, const Long& b) {
    return static_cast<double>((a - b).cwiseAbs().maxCoeff() / std::max(1.0L, b.cwiseAbs().maxCoeff()));
}

/// Random numbers, the same for every scalar: those of trial `lane` in lane `lane`.
struct Numbers {
    unsigned seed;
    template <class Matrix>
    Matrix matrix(int first, int purpose) const {
        using Real = typename Matrix::Scalar;
        Matrix all;
        for (int lane = 0; lane < lanes<Real>; ++lane) {
            std::seed_seq seeds{static_cast<int>(seed), purpose, first + lane};
            std::mt19937 random(seeds);
            std::normal_distribution<double> normal;
            for (Eigen::Index i = 0; i < all.size(); ++i) set_lane(all(i), lane, normal(random));
        }
        return all;
    }
    /// A covariance.
    template <class Matrix>
    Matrix covariance(int first, int purpose) const {
        const Matrix A = matrix<Matrix>(first, purpose);
        const int n = static_cast<int>(A.rows());
        return (A * A.transpose() + 0.3 * Eigen::MatrixXd::Identity(n, n)).eval();
    }
};

/// One of everything, for n = 4 states and m = 2 measurements.
template <class Real>
struct Everything {
    static constexpr int n = 4, m = 2;
    Eigen::Matrix<Real, n, n> F, P, Q;
    Eigen::Matrix<Real, m, n> H;
    Eigen::Matrix<Real, m, 1> nu;
    Eigen::Matrix<Real, m, m> R;
    Eigen::Matrix<Real, m, 1> variances;

    Everything(const Numbers& numbers, int first)
        : F(numbers.matrix<decltype(F)>(first, 0)),
          P(numbers.covariance<decltype(P)>(first, 1)),
          Q(numbers.covariance<decltype(Q)>(first, 2)),
          H(numbers.matrix<decltype(H)>(first, 3)),
          nu(numbers.matrix<decltype(nu)>(first, 4)),
          R(numbers.covariance<decltype(R)>(first, 5)),
          variances(R.diagonal()) {}

    auto predicted() const { return predicted_covariance(F, P, Q); }
    auto joint() const { return kalman_update(P, nu, H, R); }
    auto sequential() const { return sequential_update(P, nu, H, variances); }
    auto unscented(const SigmaPoints& points) const {
        const auto transformed = unscented_transform(P, points, [&](const auto& step) { return (H * step).eval(); });
        return unscented_update(P, transformed, nu, R);
    }
    /// Of a measurement that bends: H step + |step|^2/10.
    auto linearise() const {
        return [this](const Eigen::Matrix<Real, n, 1>& step) {
            Linearised<Real, n, m> about{nu - H * step, H};
            const Real bend = step.squaredNorm() * Real(0.1);
            for (int i = 0; i < m; ++i) about.innovation(i) -= bend;
            for (int i = 0; i < m; ++i) about.H.row(i) += Real(0.2) * step.transpose();
            return about;
        };
    }
    auto iterated(int passes) const { return iterated_update(P, R, passes, linearise()); }

    std::vector<Real> numbers() const {
        std::vector<Real> all;
        const auto add = [&](const auto& matrix) {
            for (Eigen::Index i = 0; i < matrix.size(); ++i) all.push_back(matrix(i));
        };
        add(predicted());
        for (const auto& update : {joint(), sequential(), unscented({0.5, 2, 1}), iterated(4)}) {
            add(update.step);
            add(update.P);
            add(update.S);
        }
        return all;
    }
};

}  // namespace

TEST_CASE("filters: predictions and updates are those of the information filter") {
    for (unsigned seed = 1; seed <= 1000; ++seed) {
        const Everything<double> all({seed}, 0);
        CAPTURE(seed);
        const auto check = [&](const auto& update, const Long& R) {
            const Long P = exact(all.P), H = exact(all.H), nu = exact(all.nu);
            const Long posterior = (P.inverse() + H.transpose() * R.inverse() * H).inverse();
            CHECK(distance(exact(update.P), posterior) < 1e-11);
            CHECK(distance(exact(update.step), posterior * H.transpose() * R.inverse() * nu) < 1e-11);
            CHECK(distance(exact(update.S), H * P * H.transpose() + R) < 1e-13);
            CHECK(update.P == update.P.transpose());
            CHECK(update.innovation == all.nu);
        };
        check(all.joint(), exact(all.R));
        check(all.sequential(), exact(all.variances).asDiagonal());
        check(all.unscented({}), exact(all.R));
        check(all.unscented({0.1, 2, -1}), exact(all.R));
        check(iterated_update(all.P, all.R, 3, [&](const Eigen::Vector4d& step) {
                  return Linearised<double, 4, 2>{all.nu - all.H * step, all.H};
              }), exact(all.R));
        CHECK(distance(exact(all.predicted()), exact(all.F) * exact(all.P) * exact(all.F).transpose() + exact(all.Q)) <
              1e-14);
        CHECK(all.predicted() == all.predicted().transpose());
    }
}

TEST_CASE("filters: the iterated update ends where the posterior is largest") {
    int converged = 0;
    for (unsigned seed = 1; seed <= 300; ++seed) {
        const Everything<double> all({seed}, 0);
        const auto once = all.iterated(1), update = all.iterated(60);
        CHECK(once.step == all.joint().step);
        if ((update.step - all.iterated(61).step).norm() > 1e-12) continue;  // Gauss-Newton's steps may be too long
        ++converged;
        // The gradient of |step|^2 in P + |z - h|^2 in R is 0 there.
        const auto about = all.linearise()(update.step);
        const Eigen::Vector4d pull = all.P.inverse() * update.step,
                              push = about.H.transpose() * all.R.inverse() * about.innovation;
        CHECK((pull - push).norm() < 1e-9 * std::max(1.0, push.norm()));
        CHECK((update.P - all.joint().P).norm() > 1e-9);
        CHECK(update.S == all.joint().S);
    }
    CHECK(converged > 250);
}

TEST_CASE("filters: the unscented transform is that of plain sigma points, and right for squares of normal numbers") {
    for (unsigned seed = 1; seed <= 300; ++seed) {
        const Everything<double> all({seed}, 0);
        const SigmaPoints points{0.3 + 0.002 * seed, 2, seed % 3 - 1.0};
        const auto function = [&](const auto& step) {
            Eigen::Vector2d y = all.H * step;
            y(0) += std::sin(step(0)) * step(1);
            return y;
        };
        const auto transformed = unscented_transform(all.P, points, function);
        // [van der Merwe 2004, table 3.2], word for word.
        const double n = 4, lambda = points.alpha * points.alpha * (n + points.kappa) - n;
        const Eigen::Matrix4d L = all.P.llt().matrixL();
        Eigen::Vector2d mean = lambda / (n + lambda) * function(Eigen::Vector4d::Zero().eval());
        std::vector<Eigen::Vector4d> sigma{Eigen::Vector4d::Zero()};
        for (int i = 0; i < 4; ++i)
            for (const double sign : {1.0, -1.0}) sigma.push_back(sign * std::sqrt(n + lambda) * L.col(i));
        for (std::size_t i = 1; i < sigma.size(); ++i) mean += 1 / (2 * (n + lambda)) * function(sigma[i]);
        Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
        Eigen::Matrix<double, 4, 2> cross = Eigen::Matrix<double, 4, 2>::Zero();
        for (std::size_t i = 0; i < sigma.size(); ++i) {
            const double middle = lambda / (n + lambda) + 1 - points.alpha * points.alpha + points.beta;
            const double weight = i == 0 ? middle : 1 / (2 * (n + lambda));
            covariance += weight * (function(sigma[i]) - mean) * (function(sigma[i]) - mean).transpose();
            cross += weight * sigma[i] * (function(sigma[i]) - mean).transpose();
        }
        const double lost = 1e-13 * (1 + n / (n + lambda));  // of large weights that cancel
        CHECK(distance(exact(transformed.mean), exact(mean)) < 10 * lost);
        CHECK(distance(exact(transformed.covariance), exact(covariance)) < 100 * lost);
        CHECK(distance(exact(transformed.cross), exact(cross)) < 100 * lost);
    }
    // x^2 of x ~ N(0, s^2) has mean s^2 and variance 2 s^4, which points at +-sqrt(3) s with beta = 0 give.
    const Eigen::Matrix<double, 1, 1> P(1.7);
    const auto square = unscented_transform(P, {1, 0, 2}, [](const auto& step) { return step.cwiseAbs2().eval(); });
    CHECK(square.mean(0) == Approx(1.7).epsilon(1e-14));
    CHECK(square.covariance(0) == Approx(2 * 1.7 * 1.7).epsilon(1e-14));
}

TEST_CASE("filters: predictions and updates have the same bits in every lane, and plain doubles agree to 1e-12") {
    for (unsigned seed = 1; seed <= 100; ++seed) {
        const Numbers numbers{seed};
        const auto eight = Everything<Lane<8>>(numbers, 0).numbers();
        for (int trial = 0; trial < 8; ++trial) {
            const auto one = Everything<Lane<1>>(numbers, trial).numbers();
            const auto plain = Everything<double>(numbers, trial).numbers();
            for (std::size_t i = 0; i < one.size(); ++i) {
                REQUIRE(lane_of(eight[i], trial) == lane_of(one[i], 0));
                // Gauss-Newton's steps multiply what rounding makes of its numbers.
                REQUIRE(std::abs(plain[i] - lane_of(one[i], 0)) <= 1e-12 * std::max(100.0, std::abs(plain[i])));
            }
        }
    }
}

}  // namespace credence::test::filters_long_test
