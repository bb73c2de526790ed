#pragma once
// Sums over the components of a record that share a unit: squares of different units are not added.

#include <cmath>
#include <string>
#include <vector>

#include "record/step.hpp"

namespace credence {

/// Index of the group `pose`, or 0, the whole state, if there is no such group.
std::size_t pose_group(const RecordShape& shape);

/// The components of a group that have the unit of most of them; the group itself where a unit is not known or all have
/// the same.
ComponentGroup alike(const RecordShape& shape, const ComponentGroup& group);

/// Of the squares of a group's alike components.
std::string unit_of_squares(const RecordShape& shape, std::size_t group);

/// The variance of the whole state and the squared error of the pose at the steps of a trial, over the alike
/// components.
class AlikeSums {
public:
    explicit AlikeSums(const RecordShape& shape);

    void keep(std::size_t k, const CheckedStep& step);
    /// `all` is the sum over all components; NaN where the step has none.
    double variance(std::size_t k, double all) const {
        return variances_.empty() || std::isnan(all) ? all : variances_[k];
    }
    double error(std::size_t k, double all) const { return errors_.empty() || std::isnan(all) ? all : errors_[k]; }

private:
    ComponentGroup of_state_, of_pose_;
    std::vector<double> variances_, errors_;  ///< [steps]; empty where all components are alike
};

}  // namespace credence
