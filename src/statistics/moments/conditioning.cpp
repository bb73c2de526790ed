#include "statistics/moments/conditioning.hpp"

#include <limits>
#include <vector>

#include "numeric/decompositions.hpp"

namespace credence {

double rounding_bound(const Eigen::MatrixXd& P, double epsilon) {
    std::vector<Eigen::Index> there;
    for (Eigen::Index j = 0; j < P.rows(); ++j)
        if (P(j, j) > 0) there.push_back(j);
    if (there.empty()) return 0;
    const Eigen::MatrixXd part = P(there, there);
    const Eigen::VectorXd scale = part.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd correlation = scale.asDiagonal() * part * scale.asDiagonal();
    const double smallest = eigenvalues(correlation)[0], d = static_cast<double>(there.size());
    return smallest > 0 ? d * epsilon / smallest : std::numeric_limits<double>::infinity();
}

}  // namespace credence
