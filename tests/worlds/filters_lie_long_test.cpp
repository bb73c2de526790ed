// Rotations and poses beside SciPy's values, beside exponentials of their matrices, and in lanes.

#include "catch.hpp"

#include <credence/filters.hpp>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

namespace credence::test::filters_lie_long_test {

namespace {

/// A square matrix of long doubles, with the operations of a textbook: the oracle.
struct Square {
    int n;
    std::vector<long double> entry;
    explicit Square(int size) : n(size), entry(static_cast<std::size_t>(size * size)) {}
    long double& operator()(int i, int j) { return entry[static_cast<std::size_t>(i * n + j)]; }
    long double operator()(int i, int j) const { return entry[static_cast<std::size_t>(i * n + j)]; }
};

Square product(const Square& a, const Square& b) {
    Square c(a.n);
    for (int i = 0; i < a.n; ++i)
        for (int k = 0; k < a.n; ++k)
            for (int j = 0; j < a.n; ++j) c(i, j) += a(i, k) * b(k, j);
    return c;
}

/// e^A: the series of A/2^10, squared ten times.
Square exponential(Square a) {
    for (long double& entry : a.entry) entry /= 1024;
    Square sum(a.n), term(a.n);
    for (int i = 0; i < a.n; ++i) sum(i, i) = term(i, i) = 1;
    for (int order = 1; order <= 12; ++order) {
        term = product(term, a);
        for (std::size_t i = 0; i < sum.entry.size(); ++i) sum.entry[i] += (term.entry[i] /= order);
    }
    for (int i = 0; i < 10; ++i) sum = product(sum, sum);
    return sum;
}

/// What a group is to the oracle: dimension d and k vectors.
template <class Group>
struct Shape;
template <class Real>
struct Shape<SO2<Real>> { static constexpr int d = 2, k = 0; };
template <class Real>
struct Shape<SO3<Real>> { static constexpr int d = 3, k = 0; };
template <class Turn, int vectors>
struct Shape<PoseOf<Turn, vectors>> { static constexpr int d = Turn::dimension, k = vectors; };
template <class Group>
constexpr int rotations = Shape<Group>::d == 2 ? 1 : 3;

/// The tangent vector as a matrix of the Lie algebra, and back.
template <class Group>
Square hat(const std::vector<long double>& xi) {
    constexpr int d = Shape<Group>::d, k = Shape<Group>::k;
    Square X(d + k);
    if (d == 2) {
        X(1, 0) = xi[0];
        X(0, 1) = -xi[0];
    } else {
        const int next[] = {1, 2, 0};
        for (int i = 0; i < 3; ++i) {
            X(next[next[i]], next[i]) = xi[static_cast<std::size_t>(i)];
            X(next[i], next[next[i]]) = -xi[static_cast<std::size_t>(i)];
        }
    }
    for (int j = 0; j < k; ++j)
        for (int i = 0; i < d; ++i) X(i, d + j) = xi[static_cast<std::size_t>(rotations<Group> + d * j + i)];
    return X;
}
template <class Group>
std::vector<long double> vee(const Square& X) {
    constexpr int d = Shape<Group>::d, k = Shape<Group>::k;
    std::vector<long double> xi = d == 2 ? std::vector<long double>{X(1, 0)}
                                         : std::vector<long double>{X(2, 1), X(0, 2), X(1, 0)};
    for (int j = 0; j < k; ++j)
        for (int i = 0; i < d; ++i) xi.push_back(X(i, d + j));
    return xi;
}

template <class Tangent>
std::vector<long double> numbers(const Tangent& xi) { return {xi.data(), xi.data() + xi.size()}; }

/// The sum of ad^n/(n + 1)!, a block of e^[ad, I; 0, 0].
template <class Group>
Square left_jacobian_of(const std::vector<long double>& xi) {
    const int n = static_cast<int>(xi.size());
    const Square X = hat<Group>(xi);
    Square whole(2 * n), J(n);
    for (int c = 0; c < n; ++c) {
        std::vector<long double> unit(xi.size());
        unit[static_cast<std::size_t>(c)] = 1;
        const Square E = hat<Group>(unit), there = product(X, E), back = product(E, X);
        Square commutator(X.n);
        for (std::size_t i = 0; i < there.entry.size(); ++i) commutator.entry[i] = there.entry[i] - back.entry[i];
        const std::vector<long double> column = vee<Group>(commutator);
        for (int r = 0; r < n; ++r) whole(r, c) = column[static_cast<std::size_t>(r)];
        whole(c, n + c) = 1;
    }
    whole = exponential(whole);
    for (int r = 0; r < n; ++r)
        for (int c = 0; c < n; ++c) J(r, c) = whole(r, n + c);
    return J;
}

/// [R, vectors] of a group's element.
template <class Real>
auto matrix_of(const SO2<Real>& X) { return X.matrix; }
template <class Real>
auto matrix_of(const SO3<Real>& X) { return X.matrix; }
template <class Turn, int k>
auto matrix_of(const PoseOf<Turn, k>& X) {
    Eigen::Matrix<typename Turn::Real, Turn::dimension, Turn::dimension + k> both_parts;
    both_parts << X.rotation.matrix, X.vectors;
    return both_parts;
}

/// The largest difference, relative to the largest entry or 1.
template <class Matrix, class Expected>
double distance(const Matrix& matrix, const Expected& expected) {
    double worst = 0, size = 1;
    for (int i = 0; i < matrix.rows(); ++i)
        for (int j = 0; j < matrix.cols(); ++j) {
            const double wanted = static_cast<double>(expected(i, j)), miss = std::abs(matrix(i, j) - wanted);
            size = std::max(size, std::abs(wanted));
            if (!(miss <= worst)) worst = miss;
        }
    return worst / size;
}

/// Random tangent vectors, with angles from 1e-12 to pi, many of them near 0, 1 (where series end) and pi.
template <class Group>
typename Group::Tangent drawn(std::mt19937& random) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    typename Group::Tangent xi;
    for (double& entry : xi.reshaped()) entry = normal(random);
    constexpr int p = rotations<Group>;
    const double small = std::pow(10, -12 * uniform(random));
    const double sizes[] = {pi * uniform(random), small, 1 + 0.01 * (uniform(random) - 0.5), pi * (1 - small / 2)};
    xi.template head<p>() *= sizes[random() % 4] / xi.template head<p>().norm();
    if (random() % 50 == 0) xi.template head<p>().setZero();
    return xi;
}

/// Everything that a group does, of one tangent vector of each lane.
template <template <class> class Group, class Real>
std::vector<Real> all_of(const std::vector<typename Group<double>::Tangent>& xi) {
    using G = Group<Real>;
    typename G::Tangent x;
    for (int i = 0; i < x.size(); ++i)
        for (int lane = 0; lane < lanes<Real>; ++lane) set_lane(x(i), lane, xi[static_cast<std::size_t>(lane)](i));
    std::vector<Real> all;
    const auto add = [&](const auto& matrix) {
        for (Eigen::Index i = 0; i < matrix.size(); ++i) all.push_back(matrix(i));
    };
    const G X = G::exp(x);
    add(matrix_of(X));
    add(matrix_of(X.inverse() * X));
    add(G::left_jacobian(x));
    add(right_jacobian<G>(x));
    add(G::inverse_left_jacobian(x));
    add(X.adjoint());
    add(X.log());
    return all;
}

template <template <class> class Group>
void check_bits(const std::vector<typename Group<double>::Tangent>& xi) {
    const auto in_lanes = all_of<Group, Lane<8>>(xi);
    for (int lane = 0; lane < 8; ++lane) {
        const auto one = all_of<Group, Lane<1>>({xi[static_cast<std::size_t>(lane)]});
        for (std::size_t i = 0; i < one.size(); ++i) REQUIRE(lane_of(in_lanes[i], lane) == lane_of(one[i], 0));
        const auto plain = all_of<Group, double>({xi[static_cast<std::size_t>(lane)]});
        for (std::size_t i = 0; i < one.size(); ++i)
            REQUIRE(std::abs(plain[i] - lane_of(one[i], 0)) <= 1e-12 * std::max(1.0, std::abs(plain[i])));
    }
}

template <template <class> class Group>
void check_group(unsigned seed) {
    using G = Group<double>;
    std::mt19937 random(seed);
    for (int sample = 0; sample < 500; ++sample) {
        const typename G::Tangent xi = drawn<G>(random);
        CAPTURE(sample, xi.transpose());
        const G X = G::exp(xi);
        const auto exact = exponential(hat<G>(numbers(xi)));
        REQUIRE(distance(matrix_of(X), exact) < 1e-14);
        REQUIRE(distance(G::left_jacobian(xi), left_jacobian_of<G>(numbers(xi))) < 1e-14);
        REQUIRE(distance(right_jacobian<G>(xi), left_jacobian_of<G>(numbers((-xi).eval()))) < 1e-14);
        const auto identity = [](int i, int j) { return i == j ? 1 : 0; };
        REQUIRE(distance((G::inverse_left_jacobian(xi) * G::left_jacobian(xi)).eval(), identity) < 1e-13);
        // A rotation by nearly pi is as near to one by -pi.
        const typename G::Tangent back = X.log();
        REQUIRE(distance(matrix_of(G::exp(back)), exact) < 2e-14);
        if (xi.template head<rotations<G>>().norm() < pi - 1e-9) REQUIRE(distance(back, xi) < 1e-12);
        const typename G::Tangent other = drawn<G>(random);
        REQUIRE(distance(matrix_of(X * G::exp(other)),
                         matrix_of(G::exp(typename G::Tangent(X.adjoint() * other)) * X)) < 1e-13);
        REQUIRE(distance(matrix_of(X.inverse() * X), matrix_of(G())) < 1e-14);
    }
    for (int sample = 0; sample < 40; ++sample) {
        std::vector<typename G::Tangent> xi(8);
        for (auto& one : xi) one = drawn<G>(random);
        check_bits<Group>(xi);
    }
}

template <template <class> class Group>
void check_scipy(const char* name) {
    using G = Group<double>;
    static const auto all = nlohmann::json::parse(std::ifstream(CREDENCE_SOURCE "/tests/reference/lie_groups.json"));
    REQUIRE(all.at(name).size() == 9);
    for (const auto& one : all.at(name)) {
        typename G::Tangent xi;
        for (int i = 0; i < xi.size(); ++i) xi(i) = one.at("xi").at(static_cast<std::size_t>(i));
        const auto entries = [&](const char* of, int columns) {
            return [&one, of, columns](int i, int j) {
                return one.at(of).at(static_cast<std::size_t>(i * columns + j)).get<double>();
            };
        };
        CAPTURE(name, xi.transpose());
        const auto X = matrix_of(G::exp(xi));
        CHECK(distance(X, entries("exp", static_cast<int>(X.cols()))) < 1e-13);
        CHECK(distance(G::left_jacobian(xi), entries("left_jacobian", static_cast<int>(xi.size()))) < 1e-13);
        if (!one.contains("log")) continue;
        CHECK(distance(X, entries("rotation", 3)) < 1e-14);
        // A rotation is known to 1e-16, its angle near pi less.
        CHECK(distance(G::exp(xi).log(), entries("log", 1)) < 1e-9);
    }
}

}  // namespace

TEST_CASE("filters: exponentials and Jacobians of the groups are SciPy's") {
    check_scipy<SO2>("SO2");
    check_scipy<SE2>("SE2");
    check_scipy<SO3>("SO3");
    check_scipy<SE3>("SE3");
    check_scipy<SE23>("SE23");
}

TEST_CASE("filters: the groups of the plane are those of their matrices, and the same bits in every lane") {
    check_group<SO2>(1);
    check_group<SE2>(2);
}

TEST_CASE("filters: rotations of space are those of their matrices, and the same bits in every lane") {
    check_group<SO3>(3);
}

TEST_CASE("filters: poses of space are those of their matrices, and the same bits in every lane") {
    check_group<SE3>(4);
    check_group<SE23>(5);
}

TEST_CASE("filters: a wrong Jacobian is found, and a right one is not") {
    const SE3<double>::Tangent xi{0.3, -1.2, 0.4, 1, -2, 3};
    const auto change = [&](const SE3<double>::Tangent& other) {
        return (SE3<double>::exp(other) * SE3<double>::exp(xi).inverse()).log();
    };
    SE3<double>::Jacobian J = SE3<double>::left_jacobian(xi);
    CHECK(jacobian_mismatch(change, xi, J) < 1e-9);
    CHECK(jacobian_mismatch(change, xi, right_jacobian<SE3<double>>(xi)) > 0.1);
    J(4, 1) *= 1 + 1e-5;
    CHECK(jacobian_mismatch(change, xi, J) > 1e-7);
    J(4, 1) = std::nan("");
    CHECK(std::isnan(jacobian_mismatch(change, xi, J)));
}

}  // namespace credence::test::filters_lie_long_test
