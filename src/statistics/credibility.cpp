#include <cmath>
#include <credence/detail/credibility.hpp>

#include "base/nan.hpp"
#include "numeric/decompositions.hpp"

namespace credence {

namespace {

/// Errors of the trials that are used, a column each, every component divided by its root mean square: eps* does not
/// depend on the units, and the decomposition becomes more accurate.
Eigen::MatrixXd scaled_errors(const std::vector<double>& nees, const std::vector<double>& errors, int n,
                              std::int64_t count) {
    Eigen::MatrixXd scaled(n, count);
    Eigen::Index column = 0;
    for (std::size_t i = 0; i < nees.size(); ++i)
        if (!std::isnan(nees[i]))
            scaled.col(column++) =
                Eigen::Map<const Eigen::VectorXd>(errors.data() + i * static_cast<std::size_t>(n), n);
    const Eigen::VectorXd size = scaled.rowwise().norm() / std::sqrt(static_cast<double>(count));
    return size.cwiseInverse().asDiagonal() * scaled;
}

}  // namespace

Credibility credibility(const std::vector<double>& nees, const std::vector<double>& errors, int n) {
    Credibility result{nan, nan, 0};
    for (const double value : nees) result.count += !std::isnan(value);
    if (result.count <= n) return result;
    const double count = static_cast<double>(result.count);
    const Eigen::MatrixXd e = scaled_errors(nees, errors, n, result.count);
    const CholeskyFactor mean_square(e * e.transpose() / count);
    // M has a unit diagonal: where only rounding keeps it positive definite, its inverse is meaningless.
    if (!mean_square.succeeded() || !(mean_square.rcond() > least_rcond)) return result;
    const Eigen::RowVectorXd actual = mean_square.solve_lower(e).colwise().squaredNorm();
    double sizes = 0, sum = 0;
    Eigen::Index column = 0;
    for (const double claimed : nees) {
        if (std::isnan(claimed)) continue;
        const double decade = std::log10(claimed / actual[column++]);
        sizes += std::abs(decade);
        sum += decade;
    }
    result.nci = 10 * sizes / count;
    result.inclination = 10 * sum / count;
    return result;
}

}  // namespace credence
