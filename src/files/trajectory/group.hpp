#pragma once
// The group of one arm in a trajectory file: its dimensions, and variables that have a value for each pose.

#include "worlds/deformable/deformable.hpp"

#include "files/results/format.hpp"

namespace credence {

/// Dimensions and units of one arm's trajectory.
struct TrajectoryGroup {
    TrajectoryGroup(const hdf5::Handle& scenario_group, const Trajectory& recorded)
        : trajectory(recorded),
          group(hdf5::new_group(scenario_group, arm_name(recorded.arm))),
          edges(edge_list(recorded.scenario)),
          pose(number("pose", recorded.steps.size(), "pose")),
          feature(number("feature", recorded.scenario.features.positions.size(), "feature")),
          axis(number("axis", 2, "axis: 0 is x, 1 is y")),
          component(new_component_dimension(group, state_components(recorded.scenario), "component", "component of the state")),
          component_2(new_component_dimension(group, state_components(recorded.scenario), "component_2",
                                              "component of the state, along columns")),
          length_unit(recorded.scenario.length_unit),
          state_unit(state_units(state_components(recorded.scenario))),
          covariance_unit(recorded.scenario.process == Process::heading ? "products of component_units"
                                                                        : length_unit + "^2") {}

    /// A dimension 0 ... count - 1.
    hdf5::Dimension number(const std::string& name, std::size_t count, const std::string& long_name) const {
        return numbered<std::int32_t>(group, name, 0, count, long_name);
    }

    /// Writes a variable [pose, dimensions...] with the value of `get` for each pose, a matrix or vector; NaN where
    /// that is empty.
    template <class Get>
    void per_pose(const std::string& name, hdf5::Dimensions dimensions, const hdf5::Description& description,
                  Get get) const {
        std::size_t cells = 1;
        for (const hdf5::Dimension* dimension : dimensions) cells *= dimension->size;
        std::vector<double> values;
        values.reserve(trajectory.steps.size() * cells);
        for (const TrajectoryStep& step : trajectory.steps) {
            const auto& given = get(step);
            for (Eigen::Index i = 0; i < given.rows(); ++i)
                for (Eigen::Index j = 0; j < given.cols(); ++j) values.push_back(one_nan(given(i, j)));
            if (given.size() == 0) values.insert(values.end(), cells, one_nan(NAN));
        }
        dimensions.insert(dimensions.begin(), &pose);
        const hdf5::Handle variable = hdf5::new_variable(group, name, values, dimensions, description);
        hdf5::write_numbers<double>(variable, "_FillValue", {one_nan(NAN)});
    }

    /// The same for a scalar at each pose.
    template <class Get>
    void per_pose_number(const std::string& name, const hdf5::Description& description, Get get) const {
        per_pose(name, {}, description, [&](const TrajectoryStep& s) { return Eigen::Matrix<double, 1, 1>(get(s)); });
    }

    const Trajectory& trajectory;
    hdf5::Handle group;
    std::vector<Edge> edges;
    hdf5::Dimension pose, feature, axis, component, component_2;
    std::string length_unit, state_unit, covariance_unit;
};

/// Whether a step led to this pose: none leads to pose 0.
inline bool arrived(const TrajectoryStep& step) { return step.predicted_mean.size() > 0; }

}  // namespace credence
