#pragma once
// Module worlds: rotations and poses of the plane and of space: SO(2), SO(3), SE(2), SE(3), and SE_2(3), which moves a
// velocity as well, for doubles and for packs, without branches. Where angles are small, series take over.
//
//   phi  rotation vector (rad); in the plane a number        [p], p = 1 or 3
//   rho  one or two vectors that are moved (length units)    [d, k]
//   xi = (phi, rho), by columns of rho                       [p + d k]
//
// The tangent vector begins with the rotation. exp and log are those of the matrix groups; the left Jacobian J_l has
// exp(xi + d) = exp(J_l d) exp(xi) to first order, the right one exp(xi + d) = exp(xi) exp(J_r d), J_r(xi) = J_l(-xi).
// log gives angles from -pi to pi; at pi itself either sign is right. Errors: 1e-14 relative to the largest entry, and
// of log 1e-14 rad; rotations stay so through some millions of products (tests/worlds/filters_lie_long_test.cpp).
// [Sola, Deray, Atchuthan 2018, A micro Lie theory for state estimation in robotics], [Barfoot 2017, 7.1, 7.3],
// [Barrau, Bonnabel 2017, The invariant extended Kalman filter as a stable observer] for SE_2(3)

#include <credence/detail/eigen_lanes.hpp>
#include <credence/detail/functions.hpp>

namespace credence {
inline namespace CREDENCE_TARGET {

/// The functions of an angle of which exponentials, logarithms and Jacobians of rotations are made, Stumpff's
/// c_k(s) = 1/k! - s/(k + 2)! + s^2/(k + 4)! - ..., s = angle^2: c_0 = cos, c_1 = sin(angle)/angle, c_2 = (1 - cos)/s
/// and so on [Battin 1999, 4.5]. c_k = 1/k! - s c_{k+2}, which loses nothing downwards below s = 1, where the last two
/// come from their series, and next to nothing upwards beyond, where the first two are sine and cosine.
template <RealNumber Real>
struct Stumpff {
    Real c0, c1, c2, c3, c4, c5;

    explicit Stumpff(Real s) {
        const Real angle = sqrt(s), inverse = Real(1) / s;
        const Rotation<Real> of_angle = rotation(angle);
        const Mask<Real> near_zero = s < Real(1);
        c4 = select(near_zero, series(s, 4), (Real(0.5) - (Real(1) - of_angle.cosine) * inverse) * inverse);
        c5 = select(near_zero, series(s, 5), (Real(1.0 / 6) - (Real(1) - of_angle.sine / angle) * inverse) * inverse);
        c2 = Real(0.5) - s * c4;
        c3 = Real(1.0 / 6) - s * c5;
        c1 = Real(1) - s * c3;
        c0 = Real(1) - s * c2;
    }

private:
    /// c_k by its first ten terms: below s = 1 the next one is less than 1e-20 of it.
    static Real series(Real s, int k) {
        constexpr int terms = 10;
        double factorial = 1;
        for (int i = 2; i <= k + 2 * (terms - 1); ++i) factorial *= i;
        Real sum = Real(1 / factorial);
        for (int term = terms - 2; term >= 0; --term) {
            factorial /= (k + 2 * term + 1) * (k + 2 * term + 2);
            sum = fnma(s, sum, Real(1 / factorial));
        }
        return sum;
    }
};

/// SO(2): the rotation by an angle.
template <class Scalar>
struct SO2 {
    using Real = Scalar;
    static constexpr int dimension = 2, degrees = 1;
    using Tangent = Eigen::Matrix<Real, 1, 1>;
    using Matrix = Eigen::Matrix<Real, 2, 2>;
    using Vector = Eigen::Matrix<Real, 2, 1>;

    Matrix matrix = Matrix::Identity();

    static SO2 exp(const Tangent& phi) {
        const Rotation<Real> r = rotation(phi(0));
        SO2 result;
        result.matrix << r.cosine, -r.sine, r.sine, r.cosine;
        return result;
    }
    static SO2 exp(const Real& angle) { return exp(Tangent(angle)); }
    Tangent log() const { return Tangent(credence::atan2(matrix(1, 0), matrix(0, 0))); }
    static Tangent left_jacobian(const Tangent&) { return Tangent(Real(1)); }
    static Tangent inverse_left_jacobian(const Tangent&) { return Tangent(Real(1)); }
    Tangent adjoint() const { return Tangent(Real(1)); }

    SO2 inverse() const { return {matrix.transpose()}; }
    friend SO2 operator*(const SO2& a, const SO2& b) { return {a.matrix * b.matrix}; }
    friend Vector operator*(const SO2& a, const Vector& v) { return a.matrix * v; }

    /// V(phi): exp(phi, rho) moves by V rho.
    static Matrix mean_rotation(const Tangent& phi) {
        const Stumpff<Real> c(phi(0) * phi(0));
        return of(c.c1, phi(0) * c.c2);
    }
    static Matrix inverse_mean_rotation(const Tangent& phi) {
        const Stumpff<Real> c(phi(0) * phi(0));
        const Real scale = Real(0.5) / c.c2;  // V V' = 2 c_2 I
        return of(c.c1 * scale, -phi(0) * c.c2 * scale);
    }
    /// The part of a pose's left Jacobian beside V: the sum over n of ad^(n-1) crossed(rho)/(n + 1)!. [d, p]
    static Vector coupling(const Tangent& phi, const Vector& rho) {
        const Stumpff<Real> c(phi(0) * phi(0));
        const Real along = phi(0) * c.c3;
        return Vector(along * rho(0) + c.c2 * rho(1), along * rho(1) - c.c2 * rho(0));
    }
    /// The part of a pose's adjoint beside R: minus what a small rotation does to v. [d, p]
    static Vector crossed(const Vector& v) { return Vector(v(1), -v(0)); }

private:
    static Matrix of(const Real& cosine, const Real& sine) {
        Matrix result;
        result << cosine, -sine, sine, cosine;
        return result;
    }
};

/// v^: v^ w = v x w.
template <class Derived>
auto cross_matrix(const Eigen::MatrixBase<Derived>& v) {
    using Real = typename Derived::Scalar;
    Eigen::Matrix<Real, 3, 3> result;
    result << Real(0), -v(2), v(1), v(2), Real(0), -v(0), -v(1), v(0), Real(0);
    return result;
}

/// SO(3): the rotation about phi by |phi|.
template <class Scalar>
struct SO3 {
    using Real = Scalar;
    static constexpr int dimension = 3, degrees = 3;
    using Tangent = Eigen::Matrix<Real, 3, 1>;
    using Matrix = Eigen::Matrix<Real, 3, 3>;
    using Vector = Tangent;

    Matrix matrix = Matrix::Identity();

    static SO3 exp(const Tangent& phi) {
        const Stumpff<Real> c(phi.squaredNorm());
        return {of(phi, c.c0, c.c1, c.c2)};
    }
    /// By the unit quaternion (w, v), of which the largest entry is a square root and the others are quotients by it
    /// [Shepperd 1978]; phi = 2 atan2(|v|, w) v/|v|.
    Tangent log() const {
        const Matrix& R = matrix;
        const Real trace = R.trace();
        Eigen::Matrix<Real, 4, 1> q(Real(1) + trace, R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
        Real largest = trace;
        const auto consider = [&](int i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            Eigen::Matrix<Real, 4, 1> other;
            other(0) = R(k, j) - R(j, k);
            other(1 + i) = Real(1) + Real(2) * R(i, i) - trace;
            other(1 + j) = R(j, i) + R(i, j);
            other(1 + k) = R(k, i) + R(i, k);
            q = select(R(i, i) > largest, other, q);
            largest = max(largest, R(i, i));
        };
        for (int i = 0; i < 3; ++i) consider(i);
        q = select(q(0) < Real(0), (-q).eval(), q);
        const Real size = sqrt(q.template tail<3>().squaredNorm()), smallest = Real(1e-150);
        // |v| = 0 has phi = 2 v / w: the ratio below is 2 there.
        const Mask<Real> turned = size > smallest * q(0);
        const Real ratio = select(turned, Real(2) * credence::atan2(size, q(0)) / select(turned, size, Real(1)),
                                  Real(2) / q(0));
        return ratio * q.template tail<3>();
    }
    static Matrix left_jacobian(const Tangent& phi) {
        const Stumpff<Real> c(phi.squaredNorm());
        return of(phi, c.c1, c.c2, c.c3);
    }
    static Matrix inverse_left_jacobian(const Tangent& phi) {
        const Real s = phi.squaredNorm();
        const Stumpff<Real> c(s);
        const Real squared = (c.c3 - Real(2) * c.c4) / (Real(2) * c.c2);
        return of(phi, Real(1) - s * squared, Real(-0.5), squared);
    }
    Matrix adjoint() const { return matrix; }

    SO3 inverse() const { return {matrix.transpose()}; }
    friend SO3 operator*(const SO3& a, const SO3& b) { return {a.matrix * b.matrix}; }
    friend Vector operator*(const SO3& a, const Vector& v) { return a.matrix * v; }

    static Matrix mean_rotation(const Tangent& phi) { return left_jacobian(phi); }
    static Matrix inverse_mean_rotation(const Tangent& phi) { return inverse_left_jacobian(phi); }
    /// The derivative of J_l(phi) in the direction rho, as J_l = I + c_2 phi^ + c_3 phi^ phi^; it is Q of
    /// [Barfoot 2017, 7.86].
    static Matrix coupling(const Tangent& phi, const Vector& rho) {
        const Stumpff<Real> c(phi.squaredNorm());
        const Matrix turn = cross_matrix(phi), move = cross_matrix(rho), both_ways = turn * move;
        const Real along = phi.dot(rho), first = along * (Real(2) * c.c4 - c.c3),
                   second = along * (Real(3) * c.c5 - c.c4);
        return c.c2 * move + c.c3 * (both_ways + both_ways.transpose()) + first * turn + second * (turn * turn);
    }
    static Matrix crossed(const Vector& v) { return cross_matrix(v); }

private:
    /// one I + first phi^ + second phi phi'. (phi^ phi^ = phi phi' - |phi|^2 I.)
    static Matrix of(const Tangent& phi, const Real& one, const Real& first, const Real& second) {
        Matrix result = (second * phi) * phi.transpose() + first * cross_matrix(phi);
        for (int i = 0; i < 3; ++i) result(i, i) += one;
        return result;
    }
};

/// A rotation R and k vectors t moved with it: (R, t) (S, u) = (R S, R u + t). SE(2) and SE(3) with one vector, SE_2(3)
/// with velocity and position.
template <class Turn, int k>
struct PoseOf {
    using Real = typename Turn::Real;
    static constexpr int d = Turn::dimension, p = Turn::degrees, degrees = p + d * k;
    using Tangent = Eigen::Matrix<Real, degrees, 1>;
    using Jacobian = Eigen::Matrix<Real, degrees, degrees>;
    using Vector = typename Turn::Vector;
    using Vectors = Eigen::Matrix<Real, d, k>;

    Turn rotation;
    Vectors vectors = Vectors::Zero();

    static PoseOf exp(const Tangent& xi) {
        const typename Turn::Tangent phi = xi.template head<p>();
        return {Turn::exp(phi), Turn::mean_rotation(phi) * moved(xi)};
    }
    Tangent log() const {
        Tangent xi;
        const typename Turn::Tangent phi = rotation.log();
        const Vectors rho = Turn::inverse_mean_rotation(phi) * vectors;
        xi.template head<p>() = phi;
        for (int j = 0; j < k; ++j) xi.template segment<d>(p + d * j) = rho.col(j);
        return xi;
    }
    static Jacobian left_jacobian(const Tangent& xi) {
        const typename Turn::Tangent phi = xi.template head<p>();
        return blocks(Turn::left_jacobian(phi), Turn::mean_rotation(phi),
                      [&](int j) { return Turn::coupling(phi, moved(xi).col(j)); });
    }
    static Jacobian inverse_left_jacobian(const Tangent& xi) {
        const typename Turn::Tangent phi = xi.template head<p>();
        const auto V = Turn::inverse_mean_rotation(phi);
        const auto J = Turn::inverse_left_jacobian(phi);
        return blocks(J, V, [&](int j) { return (-V * Turn::coupling(phi, moved(xi).col(j)) * J).eval(); });
    }
    /// a exp(xi) = exp(adjoint xi) a
    Jacobian adjoint() const {
        return blocks(rotation.adjoint(), rotation.matrix,
                      [&](int j) { return (Turn::crossed(vectors.col(j)) * rotation.adjoint()).eval(); });
    }

    PoseOf inverse() const { return {rotation.inverse(), -(rotation.matrix.transpose() * vectors)}; }
    friend PoseOf operator*(const PoseOf& a, const PoseOf& b) {
        return {a.rotation * b.rotation, a.rotation.matrix * b.vectors + a.vectors};
    }

private:
    static Vectors moved(const Tangent& xi) { return Eigen::Map<const Vectors, Eigen::Unaligned>(xi.data() + p); }
    /// [turn, 0; beside_j, along], one row of blocks for each vector.
    template <class A, class B, class Beside>
    static Jacobian blocks(const A& turn, const B& along, Beside beside) {
        Jacobian result = Jacobian::Zero();
        result.template topLeftCorner<p, p>() = turn;
        for (int j = 0; j < k; ++j) {
            result.template block<d, p>(p + d * j, 0) = beside(j);
            result.template block<d, d>(p + d * j, p + d * j) = along;
        }
        return result;
    }
};

template <class Real>
using SE2 = PoseOf<SO2<Real>, 1>;
template <class Real>
using SE3 = PoseOf<SO3<Real>, 1>;
template <class Real>
using SE23 = PoseOf<SO3<Real>, 2>;

/// J_r(xi) = J_l(-xi), of any of these groups.
template <class Group>
auto right_jacobian(const typename Group::Tangent& xi) { return Group::left_jacobian(-xi); }
template <class Group>
auto inverse_right_jacobian(const typename Group::Tangent& xi) { return Group::inverse_left_jacobian(-xi); }

}  // namespace CREDENCE_TARGET
}  // namespace credence
