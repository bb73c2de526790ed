#include "numeric/decompositions.hpp"

#include <Eigen/Eigenvalues>

#include <credence/detail/elementary.hpp>

namespace credence {

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

}  // namespace credence
