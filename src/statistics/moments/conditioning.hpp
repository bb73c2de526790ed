#pragma once
// Conditioning: how much rounding alone may change a number that needs the inverse of a covariance.

#include <Eigen/Core>

namespace credence {

/// A claim is made only where rounding may change its number by at most this share of the claim's margin.
inline constexpr double rounding_share = 0.1;

/// Bound on the relative error of e'P^-1e for a covariance P [d, d] whose numbers have the relative spacing `epsilon`:
/// d epsilon over the smallest eigenvalue of its correlation matrix, whatever the units [Higham 2002, 7.2 and 10.1].
/// Components without variance are left out. Infinite where P is singular.
double rounding_bound(const Eigen::MatrixXd& P, double epsilon);

}  // namespace credence
