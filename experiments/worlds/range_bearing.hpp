#pragma once
// Range and bearing of a place, for the worlds with a sensor that measures these.

#include <credence/filters.hpp>

namespace range_bearing {

/// (|q|, atan2(q_y, q_x)) of a place q, (m, rad).
template <class Real>
Eigen::Matrix<Real, 2, 1> of(const Eigen::Matrix<Real, 2, 1>& q) {
    return {credence::sqrt(q.squaredNorm()), credence::atan2(q(1), q(0))};
}

/// Its Jacobian.
template <class Real>
Eigen::Matrix<Real, 2, 2> jacobian(const Eigen::Matrix<Real, 2, 1>& q) {
    const Real square = q.squaredNorm(), range = credence::sqrt(square);
    Eigen::Matrix<Real, 2, 2> J;
    J << q(0) / range, q(1) / range, -q(1) / square, q(0) / square;
    return J;
}

/// a - b, the bearing wrapped.
struct Difference {
    template <class A, class B>
    auto operator()(const A& a, const B& b) const {
        return Eigen::Matrix<typename A::Scalar, 2, 1>(a(0) - b(0), credence::wrapped(a(1) - b(1)));
    }
};

}  // namespace range_bearing
