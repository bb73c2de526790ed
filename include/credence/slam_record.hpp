#pragma once
// Module slam: the declaration of what the trials of a SLAM scenario report: columns, series, components and their
// groups.

#include <credence/columns.hpp>
#include <credence/deformable_settings.hpp>

namespace credence {

/// all, pose, heading and position (heading model), features, feature_0 ...
std::vector<ComponentGroup> state_blocks(const DeformableSettings& scenario);

/// The components of the state: theta, r_x, r_y, f0_x, f0_y ...
std::vector<Component> state_components(const DeformableSettings& scenario);

/// Unit of trace(P): length^2, and in the heading model + rad^2.
std::string trace_unit(const DeformableSettings& scenario);

/// The charts of the error in which NEES are reported. Where all estimators are the process model's own, this is its
/// own chart alone.
enum class Charts { euclidean, euclidean_and_invariant };

Charts charts_of(const DeformableSettings& scenario);

/// Positions in the list of `trial_columns`.
enum ColumnIndex { column_trace_P, column_unseen, column_pose_error, column_nees_ratio, column_nis_ratio,
                   column_mean_trace_P, column_status, column_status_pose, column_count };

/// The per-trial columns, in the order of ColumnIndex.
std::vector<Column> trial_columns(const DeformableSettings& scenario);

/// The per-step series, in the order in which src/slam/trial/step_evaluation.hpp writes them.
std::vector<Series> step_series(const DeformableSettings& scenario);

}  // namespace credence
