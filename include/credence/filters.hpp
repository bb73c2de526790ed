#pragma once
// Module worlds: ready parts of filters for a world of one's own: templates on the scalar, which run in lanes and for
// plain doubles alike. Matrices have sizes that the compiler knows. The parts are functions of what they are given and
// keep nothing; what they take, give and rest on is said beside each.
//
//   predicted_covariance(F, P, Q)                       F P F' + Q
//   kalman_update(P, innovation, H, R)                  joint, in Joseph's form
//   sequential_update(P, innovation, H, variances)      one row after the other, independent noises
//   iterated_update(P, R, passes, linearise)            Gauss-Newton, of Bell and Cathey
//   unscented_transform(P, points, function)            by sigma points with van der Merwe's weights
//   unscented_update(P, predicted, z, R)
//   SO2, SO3, SE2, SE3, SE23                            exp, log, left_jacobian, inverse_left_jacobian, adjoint;
//                                                       right_jacobian<Group>(xi)
//   jacobian_mismatch(function, x, J)                   whether a Jacobian is that of the function
//
// Updates give {step, P, innovation, S}: x += step, or x = x [+] step on a manifold.

#include <credence/detail/lie_groups.hpp>
#include <credence/detail/unscented.hpp>

#include <cmath>

namespace credence {

/// dfunction/dx at x [n], by central differences of sixth order, with steps of 1e-3 in units of `scales` [n]: their
/// errors are below 1e-10 where the function is smooth over some hundredths of a scale. `function` takes and gives
/// vectors of doubles; on a manifold it takes a step, and gives the difference to its value at 0.
template <class Function, int n>
auto numerical_jacobian(Function function, const Eigen::Matrix<double, n, 1>& x,
                        const Eigen::Matrix<double, n, 1>& scales = Eigen::Matrix<double, n, 1>::Ones()) {
    using Y = typename std::remove_cvref_t<decltype(function(x))>::PlainObject;
    Eigen::Matrix<double, Y::RowsAtCompileTime, n> J;
    for (int i = 0; i < n; ++i) {
        const auto around = [&](double steps) -> Y {
            const Eigen::Matrix<double, n, 1> h = steps * 1e-3 * scales(i) * Eigen::Matrix<double, n, 1>::Unit(i);
            return function(Eigen::Matrix<double, n, 1>(x + h)) - function(Eigen::Matrix<double, n, 1>(x - h));
        };
        J.col(i) = (45 * around(1) - 9 * around(2) + around(3)) / (60e-3 * scales(i));
    }
    return J;
}

/// How far J is from the function's Jacobian at x: the largest difference of an entry, relative to the largest entry of
/// its row in units of `scales`. A right one gives less than 1e-8.
template <class Function, int n, class DerivedJ>
double jacobian_mismatch(Function function, const Eigen::Matrix<double, n, 1>& x, const Eigen::MatrixBase<DerivedJ>& J,
                         const Eigen::Matrix<double, n, 1>& scales = Eigen::Matrix<double, n, 1>::Ones()) {
    const auto expected = numerical_jacobian(function, x, scales);
    double worst = 0;
    for (int row = 0; row < expected.rows(); ++row) {
        const double size = (expected.row(row) * scales.asDiagonal()).cwiseAbs().maxCoeff();
        for (int i = 0; i < n; ++i) {
            const double miss = std::abs(J(row, i) - expected(row, i)) * scales(i) / (size > 0 ? size : 1);
            if (miss > worst || std::isnan(miss)) worst = miss;
        }
    }
    return worst;
}

}  // namespace credence
