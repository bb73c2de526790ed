#pragma once
// Directions: the linear combinations of the state whose squared error is largest and smallest against what P predicts
// [docs/theory/statistics.md, Verdict]. NEES alone sees only the trace of P^-1 E[e e'].
//
// A direction is a generalised eigenvector, sum S v = lambda sum C v. For a finding, the one for the trials of a part
// is found on the other parts: it has no bias of selection, whatever the distribution. For an acceptance it is that of
// all trials: selection then errs on the safe side.

#include <limits>

#include "statistics/mean_bounds.hpp"
#include "statistics/moments/trial_moments.hpp"

namespace credence {

/// Least number of trials for a claim about directions.
inline constexpr double direction_trials = 20;

struct DirectionLimits {
    double margin = 0.05;                                     ///< findings lie outside 1 -+ margin
    double epsilon = std::numeric_limits<double>::epsilon();  ///< of the data's type; 2^-23 for 32 bits
    double steps = 1;                                         ///< of a trial
    bool of_segments = false;                                 ///< trials are segments of runs [PositiveSample]
};

/// One component's share in a direction, in units of its sigma.
struct DirectionEntry {
    int component = 0;  ///< of the state
    double weight = 0;
};

/// A direction with the ratio of its squared error to what P predicts, 1 for a consistent filter.
struct Direction {
    std::vector<DirectionEntry> entries;  ///< by component; of unit length, the largest positive, small ones left out
    bool approximate =
        false;             ///< the direction of some part of the trials is far from it: say "in about the direction"
    PositiveSample ratio;  ///< over all trials, each in the direction that the other parts give
    Interval bounds;       ///< of the ratio, each end at the corrected one-sided level
    bool finding = false;  ///< the bounds lie outside the margin
};

/// The directions of one group. Not known, with the reason, where they cannot be computed.
struct GroupDirections {
    enum class State { known, few_trials, singular };
    State state = State::few_trials;
    double trials = 0;
    int left_out = 0;             ///< dimensions in which P cannot be distinguished from 0: `consistent` is withheld
    Direction largest, smallest;  ///< findings above and below
};

/// Directions of a group of at least two components. `sums` may be over more trials than `group`, whose numbers give
/// the spread. `level`: one-sided, corrected for groups and for both directions.
GroupDirections find_directions(const GroupMoments& group, const FoldSums& sums, double level,
                                const DirectionLimits& limits = {});

/// Within which margin all directions of the whole state, and so of all its groups, are shown to lie.
struct DirectionsAccepted {
    GroupDirections::State state = GroupDirections::State::few_trials;
    double shown = std::numeric_limits<double>::infinity();  ///< the smallest margin within which they are
    int left_out = 0;
    std::vector<double> spectrum;  ///< ratios of all trials, rising, d - left_out: their range is too wide on average
    Interval bounds;               ///< lower bound of the smallest to upper bound of the largest, 95 %
};
DirectionsAccepted accept_directions(const GroupMoments& state, const FoldSums& sums,
                                     const DirectionLimits& limits = {});

/// The coordinates in which rounding may change a ratio by a tenth of the margin at most: an orthonormal basis
/// [d, d - left_out] of the eigenvectors of the mean standardised P whose eigenvalue is at least
/// d epsilon / (rounding_share margin) [numeric/decompositions.hpp].
Eigen::MatrixXd resolved_basis(const Eigen::MatrixXd& sum_of_C, const DirectionLimits& limits);

}  // namespace credence
