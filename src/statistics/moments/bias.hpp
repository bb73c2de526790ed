#pragma once
// Bias: the mean standardised error of a component, one number a trial, against a margin [docs/statistics.md, Verdict].

#include <credence/statistics.hpp>

namespace credence {

/// An error of at most this size in every trial and step is that of rounding numbers of size 16: 2^-48.
inline constexpr double rounding_error = 0x1p-48;

struct BiasClaim {
    double value = 0;            ///< mean error in sigmas
    Interval interval;           ///< corrected for the number of components, two-sided
    bool known_exactly = false;  ///< no bias; S and C of the component are no evidence and are to be left out
    bool finding = false;        ///< outside the margin
    bool accepted = false;       ///< inside the margin, at 95 %
    double shown = 0;            ///< the smallest margin inside which it is, at 95 %
};

/// `z`: moments over the trials of the component's mean standardised error; `largest_error`: |e| over all trials and
/// steps, in the component's unit; `components`: over which the level is shared; `margin` in sigmas.
BiasClaim claim_on_bias(const Moments& z, double largest_error, int components, double margin);

}  // namespace credence
