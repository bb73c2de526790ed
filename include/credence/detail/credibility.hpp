#pragma once
// Module statistics: the discrepancy between the filter's covariance and its actual errors, on a logarithmic scale [Li
// and Zhao, Measuring Estimator's Credibility: Noncredibility Index].

#include <cstdint>
#include <vector>

namespace credence {

/// With eps_i = e_i' P_i^-1 e_i, eps*_i = e_i' M^-1 e_i, M = 1/N sum e_i e_i' and rho_i = eps_i / eps*_i:
struct Credibility {
    double nci = 0;          ///< noncredibility index, 10/N sum |log10 rho_i|; near 0 for a credible filter
    double inclination = 0;  ///< I2, 10/N sum log10 rho_i; > 0: optimistic, P too small
    std::int64_t count = 0;  ///< N, the trials that were used
};

/// Credibility at one step: `nees` [N] the normalised squared errors eps_i that the filter claims, `errors` [N, n] the
/// errors. Trials whose NEES is NaN are left out. NaN where N <= n or M is not positive definite (in double precision,
/// each component in units of its own root mean square).
Credibility credibility(const std::vector<double>& nees, const std::vector<double>& errors, int n);

}  // namespace credence
