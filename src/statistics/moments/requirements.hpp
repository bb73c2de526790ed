#pragma once
// What must be shown for the verdict `consistent`, and from how many trials each of it is, in studies that are drawn.

#include <cmath>

#include "statistics/moments/advice.hpp"

namespace credence {

/// Number of studies that are drawn.
inline constexpr int advice_draws = 400;

/// One thing that must be shown: N trials are enough if scaled / sqrt(N) is at most the margin.
struct Requirement {
    double margin = 0;
    Eigen::VectorXd values;  ///< [trials] of this study
    Eigen::VectorXd scaled;  ///< by draw

    /// The least N of each draw.
    Eigen::VectorXd trials() const { return (scaled.cwiseMax(0) / margin).cwiseAbs2(); }

    /// The number's uncertainty as a factor, 90 %: sd^2 has the relative variance (kurtosis - 1)/T, the number is
    /// proportional to it, and 10 % are for what else is estimated.
    double uncertainty() const {
        const Eigen::ArrayXd squares = (values.array() - values.mean()).square();
        const double kurtosis = squares.square().mean() / (squares.mean() * squares.mean());
        return std::exp(1.645 * std::sqrt((kurtosis - 1) / static_cast<double>(values.size()) + 0.01));
    }
};

/// All requirements; every trial must have every component. Nothing where the mean of S or C is singular.
std::optional<std::vector<Requirement>> requirements_of(const TrialMoments& trials, const std::vector<int>& state,
                                                        std::uint64_t root_seed, const AdviceLimits& limits);

/// Quantile of type 7.
double quantile_of(const Eigen::VectorXd& values, double p);

}  // namespace credence
