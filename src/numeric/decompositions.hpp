#pragma once
// Decompositions of symmetric matrices by Eigen, whose templates are compiled once here: every source that called them
// would compile them again.

#include <Eigen/Cholesky>

#include <string>

namespace credence {

/// P = L L', L lower triangular, of P [n, n].
class CholeskyFactor {
public:
    CholeskyFactor() = default;
    explicit CholeskyFactor(const Eigen::MatrixXd& P) { compute(P); }

    /// Whether P is positive definite.
    bool compute(const Eigen::Ref<const Eigen::MatrixXd>& P);
    bool succeeded() const { return factor_.info() == Eigen::Success; }
    /// Whether every squared diagonal entry of L exceeds `share` of P's.
    bool pivots_exceed(double share, const Eigen::Ref<const Eigen::MatrixXd>& P) const;
    double log_determinant() const;
    /// An estimate of 1 / (|P| |P^-1|), in the norm of column sums.
    double rcond() const;

    /// L^-1 B
    Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& B) const;
    /// L'^-1 B
    Eigen::MatrixXd solve_upper(const Eigen::MatrixXd& B) const;
    /// Replaces b [n] by L^-1 b.
    void whiten(Eigen::VectorXd& b) const;

private:
    Eigen::LLT<Eigen::MatrixXd> factor_;
};

/// Below this `rcond` only rounding keeps a matrix whose diagonal is about 1 positive definite.
inline constexpr double least_rcond = 1e-13;

struct Eigenpairs {
    Eigen::VectorXd values;   ///< [n], ascending
    Eigen::MatrixXd vectors;  ///< [n, n], a column each, of length 1
    bool found;               ///< false where the iteration does not converge, as for a NaN
};

/// Those of a symmetric matrix.
Eigenpairs eigenpairs(const Eigen::MatrixXd& symmetric);
Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& symmetric);

// Whether symmetric matrices are positive definite beyond rounding, of values with the relative spacing `epsilon`.

/// Factors S; what is wrong with it, where it is not positive definite. Pivots that are not small need no eigenvalues.
/// `rounding` becomes the bound on the relative error of nu'S^-1nu [rounding_bound]; 0 for such
/// pivots.
std::string factor_checked(const Eigen::Ref<const Eigen::MatrixXd>& S, double epsilon, CholeskyFactor& factor,
                           double& rounding);

bool is_positive_definite(const Eigen::Ref<const Eigen::MatrixXd>& matrix, double epsilon);

// Conditioning: how much rounding alone may change a number that needs the inverse of a covariance.

/// A claim is made only where rounding may change its number by at most this share of the claim's margin.
inline constexpr double rounding_share = 0.1;

/// Bound on the relative error of e'P^-1e for a covariance P [d, d] whose numbers have the relative spacing `epsilon`:
/// d epsilon over the smallest eigenvalue of its correlation matrix, whatever the units [Higham 2002, 7.2 and 10.1].
/// Components without variance are left out. Infinite where P is singular.
double rounding_bound(const Eigen::MatrixXd& P, double epsilon);

}  // namespace credence
