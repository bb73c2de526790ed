#pragma once
// Mistakes in writing a record that are applied to its steps: what was written of them is turned back, and NEES, every
// component and the correlations are computed again [docs/theory/statistics.md, Causes].

#include <credence/evidence.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace credence {

/// One of those steps at which all of some components are in the state.
struct SampledStep {
    std::int64_t unit = 0;           ///< the run or the segment that it is of
    int step = 0;                    ///< of its run
    Eigen::VectorXd e;               ///< [n]
    Eigen::MatrixXd P;               ///< [n, n]
    Eigen::MatrixXd before, after;   ///< P of the steps beside it; empty where there are none
};

struct SampledSteps {
    std::vector<SampledStep> steps;
    double tolerance = 0;  ///< within which a ratio is 1, however well it is known
};

/// What turns these steps right that are not: the simplest mistake, if no other does as well; else empty.
/// `components` [n]: names and units.
std::string applied_cause(const SampledSteps& sample, const std::vector<Component>& components);

}  // namespace credence
