#include "numeric/decompositions.hpp"

#include <Eigen/Eigenvalues>

#include <credence/detail/elementary.hpp>

#include <cmath>
#include <limits>
#include <vector>

namespace credence {

namespace {

enum class Definiteness { positive, singular, indefinite };

/// The smallest eigenvalue of the correlation matrix, which does not depend on units.
double smallest_eigenvalue(const Eigen::MatrixXd& S) {
    const Eigen::VectorXd size = S.diagonal().cwiseAbs().cwiseSqrt();
    const Eigen::VectorXd scale = (size.array() > 0).select(size.cwiseInverse(), 1.0);
    const Eigen::MatrixXd correlation = scale.asDiagonal() * S * scale.asDiagonal();
    return eigenvalues(correlation).minCoeff();
}

/// Rounding alone, of values with the relative spacing `epsilon`, makes up to 2 n epsilon of an eigenvalue of 0.
Definiteness definiteness(double smallest, Eigen::Index n, double epsilon) {
    const double zero = 2 * static_cast<double>(n) * epsilon;
    if (smallest > zero) return Definiteness::positive;
    return smallest < -zero ? Definiteness::indefinite : Definiteness::singular;
}

}  // namespace

bool CholeskyFactor::compute(const Eigen::Ref<const Eigen::MatrixXd>& P) {
    factor_.compute(P);
    return succeeded();
}

bool CholeskyFactor::pivots_exceed(double share, const Eigen::Ref<const Eigen::MatrixXd>& P) const {
    return (factor_.matrixLLT().diagonal().array().square() > share * P.diagonal().array()).all();
}

double CholeskyFactor::log_determinant() const {
    ScaledProduct<double> root;
    for (Eigen::Index i = 0; i < factor_.rows(); ++i) root.multiply(factor_.matrixLLT()(i, i));
    return 2 * root.log();
}

double CholeskyFactor::rcond() const { return factor_.rcond(); }

Eigen::MatrixXd CholeskyFactor::solve_lower(const Eigen::MatrixXd& B) const { return factor_.matrixL().solve(B); }

Eigen::MatrixXd CholeskyFactor::solve_upper(const Eigen::MatrixXd& B) const { return factor_.matrixU().solve(B); }

void CholeskyFactor::whiten(Eigen::VectorXd& b) const { factor_.matrixL().solveInPlace(b); }

Eigenpairs eigenpairs(const Eigen::MatrixXd& symmetric) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
    return {solver.eigenvalues(), solver.eigenvectors(), solver.info() == Eigen::Success};
}

Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& symmetric) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
}

std::string factor_checked(const Eigen::Ref<const Eigen::MatrixXd>& S, double epsilon, CholeskyFactor& factor,
                           double& rounding) {
    rounding = 0;
    const bool factored = factor.compute(S);
    if (factored && factor.pivots_exceed(10 * std::sqrt(epsilon), S)) return {};
    const double smallest = smallest_eigenvalue(S);
    const Definiteness found = definiteness(smallest, S.rows(), epsilon);
    rounding = static_cast<double>(S.rows()) * epsilon / smallest;
    if (factored && found == Definiteness::positive) return {};
    return found == Definiteness::singular ? "is singular" : "is not positive definite";
}

bool is_positive_definite(const Eigen::Ref<const Eigen::MatrixXd>& matrix, double epsilon) {
    CholeskyFactor any;
    double rounding = 0;
    return factor_checked(matrix, epsilon, any, rounding).empty();
}

double rounding_bound(const Eigen::MatrixXd& P, double epsilon) {
    std::vector<Eigen::Index> there;
    for (Eigen::Index j = 0; j < P.rows(); ++j)
        if (P(j, j) > 0) there.push_back(j);
    if (there.empty()) return 0;
    const double smallest = smallest_eigenvalue(P(there, there)), d = static_cast<double>(there.size());
    return smallest > 0 ? d * epsilon / smallest : std::numeric_limits<double>::infinity();
}

}  // namespace credence
