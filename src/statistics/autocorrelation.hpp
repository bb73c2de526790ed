#pragma once
// How far the steps of one run depend on each other.

#include <cstddef>
#include <vector>

namespace credence {

/// The autocorrelation of a series about `mean`.
struct Autocorrelation {
    /// The integrated autocorrelation time, in steps: 1/2 + rho_1 + ... + rho_M, with the first window M of at least 5
    /// times that [Sokal 1997, section 3]; 1/2 of independent values. Infinite where no window of up to half of the
    /// series is long enough: then it does not decorrelate.
    double time = 0.5;
    std::size_t window = 0;      ///< M; 0 where there is none
    std::vector<double> by_lag;  ///< rho_0 = 1, rho_1 ... up to half of the series; empty of a constant one
};
Autocorrelation autocorrelation(const std::vector<double>& values, double mean);

/// Steps of a part of a run that is nearly independent of the next: ten times that. With fewer, intervals of few parts
/// are too narrow.
double independent_steps(double autocorrelation_time);

/// The quantile of F with `above` and `below` degrees of freedom above which `p` lies.
double f_upper_quantile(double p, double above, double below);

}  // namespace credence
