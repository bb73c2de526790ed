#pragma once
// Module numeric: sums without rounding, so that a total has the same bits in whatever order its parts arrive, and can
// be merged, extended and reduced again.

#include <vector>

namespace credence {

/// An exact sum of doubles, kept as an expansion of parts that do not overlap [Shewchuk, Adaptive Precision
/// Floating-Point Arithmetic, 1997]. Finite values below 1e300 in size; anything else makes the sum NaN for good.
class ExactSum {
public:
    void add(double value);
    /// Adds another sum, or subtracts it.
    void add(const ExactSum& other, int sign = 1);

    /// The sum, rounded once to nearest, ties to even; NaN where it is not below 1e300 in size, as its values are.
    double rounded() const;

    /// The sum as parts that add up to it exactly: the first is `rounded()`, each further one what rounding left. The
    /// same for every order of adding. At least one part; {NaN} for a sum that is not finite.
    std::vector<double> parts() const;

    /// The sum with these parts.
    static ExactSum from_parts(const std::vector<double>& parts);

private:
    std::vector<double> expansion_;  ///< increasing in size, without zeros
    bool finite_ = true;
};

}  // namespace credence
