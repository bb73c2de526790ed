#pragma once
// Whether symmetric matrices are positive definite beyond rounding, of values with the relative spacing `epsilon`.

#include "numeric/decompositions.hpp"

#include <string>

namespace credence {

/// Factors S; what is wrong with it, where it is not positive definite. Pivots that are not small need no eigenvalues.
/// `rounding` becomes the bound on the relative error of nu'S^-1nu [statistics/moments/conditioning.hpp]; 0 for such
/// pivots.
std::string factor_checked(const Eigen::Ref<const Eigen::MatrixXd>& S, double epsilon, CholeskyFactor& factor,
                           double& rounding);

bool is_positive_definite(const Eigen::Ref<const Eigen::MatrixXd>& matrix, double epsilon);

}  // namespace credence
