#pragma once
// How many trials a verdict needs [docs/theory/statistics.md, Verdict].

#include <cstdint>
#include <optional>

#include "statistics/mean_bounds.hpp"
#include "statistics/moments/trial_moments.hpp"

namespace credence {

/// Least number of trials for an advice.
inline constexpr double advice_trials = 30;

struct AdviceLimits {
    double margin = 0.05;     ///< of mean NEES/dimension
    double direction = 0.10;  ///< of directions
    double bias = 0.1;        ///< sigmas
};

/// The number of trials at which an exactly consistent filter with the spread seen is shown consistent in 80 % of
/// studies.
struct Advice {
    double trials = 0;
    Interval range;  ///< that holds the number with 90 %
};

/// The trials' numbers are centred on what an exactly consistent filter has, and samples of N are drawn from them with
/// normal multipliers g: the normal approximation of a resampled mean, mean + sum g_i (x_i - mean) / sqrt(T N). Trials
/// in which a component is absent are left out. `state`: the components of the whole state that are not known exactly.
/// A draw is a function of (root seed, index of the trial, draw) alone. Nothing for fewer than 30 trials, and where the
/// mean of S or C is singular.
std::optional<Advice> trials_for_consistent(const TrialMoments& trials, const std::vector<int>& state,
                                            std::uint64_t root_seed, const AdviceLimits& limits = {});

/// Number of trials at which a finding at `level` would be made if mean and deviation stay: for a mean that lies
/// outside 1 -+ margin; infinite for one inside.
double trials_to_show(const PositiveSample& sample, double level, double margin);

/// The same for a bias beyond `margin`, `level` one-sided.
double trials_to_show_bias(const Moments& z, double level, double margin);

}  // namespace credence
