// Packs as scalars of Eigen's matrices: what a filter writes is computed with every scalar, and compared.

#include "catch.hpp"

#include <credence/detail/symmetric.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace credence::test::eigen_lanes_long_test {

namespace {

/// Random numbers of eight trials, which every scalar takes in the same order.
class Numbers {
public:
    Numbers(unsigned seed, std::size_t count) : numbers_(8 * count) {
        std::mt19937 random(seed);
        std::normal_distribution<double> normal;
        for (double& number : numbers_) number = normal(random);
    }
    /// The next number of the trials first, first + 1 ...
    template <class Real>
    Real next(int first) {
        return load<Real>(&numbers_[8 * place_++ + static_cast<std::size_t>(first)]);
    }
    template <class Matrix>
    Matrix matrix(int first) {
        Matrix all;
        for (Eigen::Index i = 0; i < all.size(); ++i) all(i) = next<typename Matrix::Scalar>(first);
        return all;
    }

private:
    std::vector<double> numbers_;
    std::size_t place_ = 0;
};

/// What a filter writes, n states and two measurements: the entries of everything that comes out.
template <int n, class Real>
std::vector<Real> filter_steps(Numbers numbers, int first) {
    using Square = Eigen::Matrix<Real, n, n>;
    using State = Eigen::Matrix<Real, n, 1>;
    const Square A = numbers.matrix<Square>(first);
    const State x = numbers.matrix<State>(first);
    Eigen::Matrix<double, n, n> F = Eigen::Matrix<double, n, n>::Identity();
    F.template topRightCorner<1, 1>().setConstant(0.5);
    F.row(n - 1) *= 2;

    Square P = A * A.transpose() + Square::Identity();
    P = F * P * F.transpose() + 0.25 * Eigen::Matrix<double, n, n>::Identity();
    Eigen::Matrix<Real, 2, n> H;
    H << State::Ones().transpose(), x.transpose() / 2;
    const Eigen::Matrix<Real, 2, 2> S = H * P * H.transpose() + 0.5 * Eigen::Matrix2d::Identity();
    const Eigen::Matrix<Real, n, 2> K = P * H.transpose() * S.inverse(), K_too = P * H.transpose() * inverse(S);
    State e = F * x;
    e += K * (H * e);
    e(0) = credence::atan2(credence::sin(e(0)), credence::cos(e(0)));
    e = select(x(0) > 0.25, e, select(x(0) < x(1), 2 * e, 0));
    const Square kept = Square::Identity() - K * H, joseph = kept * P * kept.transpose() + K * K.transpose() * 0.5;
    P.template block<2, 2>(0, 0) += K_too.transpose() * K_too;
    P.template triangularView<Eigen::StrictlyUpper>() = P.transpose();

    std::vector<Real> all;
    const auto add = [&](const auto& matrix) {
        const auto value = matrix.eval();
        for (Eigen::Index i = 0; i < value.size(); ++i) all.push_back(value(i));
    };
    add(P);
    add(joseph);
    add(K_too);
    add(e);
    add(solve(P, e));
    add(inverse(P));
    add(cholesky(P).L);
    all.push_back(determinant(S));
    all.push_back(S.determinant());
    all.push_back(e.dot(solve(P, e)));
    all.push_back(e.norm() + P.trace() + e.cwiseAbs().maxCoeff());
    return all;
}

/// The results of the eight trials with this scalar, by trial.
template <int n, class Real>
std::vector<double> of_trials(unsigned seed) {
    const Numbers numbers(seed, n * n + n);
    std::vector<double> all;
    for (int first = 0; first < 8; first += lanes<Real>) {
        const std::vector<Real> results = filter_steps<n, Real>(numbers, first);
        for (int lane = 0; lane < lanes<Real>; ++lane)
            for (const Real& result : results) all.push_back(lane_of(result, lane));
    }
    return all;
}

template <int n>
void check_scalars(unsigned seed) {
    CAPTURE(n, seed);
    const std::vector<double> one = of_trials<n, Lane<1>>(seed);
    CHECK(of_trials<n, Lane<8>>(seed) == one);  // (Four are what the targets of worlds are tested with.)
    const std::vector<double> plain = of_trials<n, double>(seed);
    REQUIRE(plain.size() == one.size());
    double worst = 0;
    for (std::size_t i = 0; i < one.size(); ++i)
        worst = std::max(worst, std::abs(plain[i] - one[i]) / std::max(1.0, std::abs(one[i])));
    CHECK(worst < 1e-12);
}

template <class Real>
Eigen::Matrix<Real, 3, 3> with_last(double entry) {
    Eigen::Matrix<Real, 3, 3> S;
    S << 4, 2, 0, 2, 5, 1, 0, 1, entry;
    return S;
}

}  // namespace

TEST_CASE("lanes: a filter written in Eigen has the same bits in every width, and agrees with plain doubles to 1e-12") {
    for (unsigned seed = 1; seed <= 80; ++seed) check_scalars<5>(seed);
}

TEST_CASE("lanes: Cholesky factors, solutions, inverses and determinants are those of Eigen's LLT") {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (int sample = 0; sample < 200; ++sample) {
        Eigen::Matrix<double, 5, 5> A;
        for (double& entry : A.reshaped()) entry = normal(random);
        const Eigen::Matrix<double, 5, 5> S = A * A.transpose() + 0.1 * Eigen::Matrix<double, 5, 5>::Identity();
        const Eigen::Matrix<double, 5, 2> B = A.leftCols<2>();
        const Eigen::LLT<Eigen::Matrix<double, 5, 5>> llt(S);
        // Their condition numbers are below 1e4, and rounding is 1e-16.
        const auto close = [](const auto& a, const auto& b) { return (a - b).norm() <= 1e-11 * b.norm(); };
        CHECK(close(cholesky(S).L, Eigen::Matrix<double, 5, 5>(llt.matrixL())));
        CHECK(close(cholesky(S).whitened(B), llt.matrixL().solve(B)));
        CHECK(close(solve(S, B), llt.solve(B)));
        CHECK(close(inverse(S), Eigen::Matrix<double, 5, 5>(S.inverse())));
        CHECK(determinant(S) == Approx(S.determinant()).epsilon(1e-11));
        CHECK(inverse(S) == inverse(S).transpose());
        CHECK(cholesky(S).positive_definite);
        // Packs take right-hand sides of doubles.
        const Eigen::Matrix<Lane<2>, 5, 2> in_lanes = solve(S.cast<Lane<2>>().eval(), B);
        CHECK(lane_of(in_lanes(3, 1), 1) == solve(S, B)(3, 1));
        // The upper triangle is not read.
        Eigen::Matrix<double, 5, 5> lower = S;
        lower.triangularView<Eigen::StrictlyUpper>().setConstant(std::nan(""));
        CHECK(cholesky(lower).L == cholesky(S).L);
    }
}

TEST_CASE("lanes: a matrix that is not positive definite is so in its lane alone") {
    Eigen::Matrix<Lane<4>, 3, 3> S = with_last<Lane<4>>(3);
    set_lane(S(2, 2), 1, -1);
    const auto factor = cholesky(S);
    CHECK(lane_bits(factor.positive_definite) == 0b1101);
    const Eigen::Matrix<double, 3, 3> good = inverse(with_last<double>(3));
    const auto all = factor.inverse();
    for (int lane = 0; lane < 4; ++lane)
        CHECK((lane == 1 ? std::isnan(lane_of(all(2, 2), lane)) : lane_of(all(2, 2), lane) == good(2, 2)));
}

TEST_CASE("lanes: matrices are selected by lane") {
    const Eigen::Matrix<Lane<2>, 2, 1> yes = Eigen::Vector2d(1, 2).cast<Lane<2>>();
    const Eigen::Matrix<Lane<2>, 2, 1> no = Eigen::Vector2d(3, 4).cast<Lane<2>>();
    const LaneMask<2> first = mask_of_bits<Lane<2>>(1);
    const auto both_sides = select(first, yes, no), or_zero = select(first, 2 * yes, 0);
    CHECK(lane_of(both_sides(1), 0) == 2);
    CHECK(lane_of(both_sides(1), 1) == 4);
    CHECK(lane_of(or_zero(0), 0) == 2);
    CHECK(lane_of(or_zero(0), 1) == 0);
    CHECK(select(false, Eigen::Vector2d(1, 2), 0) == Eigen::Vector2d::Zero());
}

}  // namespace credence::test::eigen_lanes_long_test
