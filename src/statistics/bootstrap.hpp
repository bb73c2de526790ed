#pragma once
// The bootstrap of a mean: an interval without the assumption of a normal distribution, for columns with a heavy tail.

#include <credence/statistics.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace credence {

/// Number of resamples.
inline constexpr int bootstrap_resamples = 2000;

/// Percentile bootstrap interval of the mean [Efron and Tibshirani 1993, 13.3; docs/statistics.md]: the quantiles
/// alpha/2 and 1 - alpha/2 (type 7) of the means of `bootstrap_resamples` samples drawn with replacement.
///
/// `by_trial[i]` is the value of trial i; NaN, a failed trial, is left out. Trials are resampled or, where at least 100
/// blocks of 256 trials (256 b ... 256 b + 255) hold a value and there are at least 100 * 256 trials, blocks: the mean
/// is then the sum of the drawn blocks' sums over the sum of their counts, so that a partial last block or failed
/// trials do not bias it.
///
/// Draws are a function of (root seed, column, resample, position) alone: the same bits for any number of threads. They
/// are independent of the trials' noise. An index is floor(w size / 2^32) of a 32-bit word w: its bias is below size /
/// 2^32.
///
/// Equal values give {value, value}; fewer than two, or one that is infinite, give {NaN, NaN}.
Interval bootstrap_mean_interval(const std::vector<double>& by_trial, std::uint64_t root_seed,
                                 const std::string& column, double alpha = 0.05);

}  // namespace credence
