#include "statistics/moments/conditioning.hpp"

#include <Eigen/Eigenvalues>
#include <limits>
#include <vector>

namespace credence {

double rounding_bound(const Eigen::MatrixXd& P, double epsilon) {
    std::vector<Eigen::Index> there;
    for (Eigen::Index j = 0; j < P.rows(); ++j)
        if (P(j, j) > 0) there.push_back(j);
    if (there.empty()) return 0;
    const Eigen::MatrixXd part = P(there, there);
    const Eigen::VectorXd scale = part.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd correlation = scale.asDiagonal() * part * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation, Eigen::EigenvaluesOnly);
    const double smallest = solver.eigenvalues()[0], d = static_cast<double>(there.size());
    return smallest > 0 ? d * epsilon / smallest : std::numeric_limits<double>::infinity();
}

}  // namespace credence
