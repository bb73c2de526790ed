#pragma once
// Module slam: the declaration of what the trials of a SLAM scenario report: columns, series, components and their
// groups.

#include <credence/columns.hpp>
#include <credence/detail/deformable_settings.hpp>

namespace credence {

/// What the columns and series of a SLAM trial depend on, whatever world it is of.
struct SlamState {
    Process process = Process::heading;
    int features = 0;
    int edges = 0;
    std::string length_unit;
    std::vector<Estimator> estimators{};  ///< of all arms

    /// Of a scenario whose defaults may be unresolved.
    SlamState(const DeformableSettings& settings);

    int pose_size() const { return process == Process::heading ? 3 : 2; }
    int size() const { return pose_size() + 2 * features; }
};

/// all, pose, heading and position (heading model), features, feature_0 ...
std::vector<ComponentGroup> state_groups(const SlamState& state);

/// The components of the state: theta, r_x, r_y, f0_x, f0_y ...
std::vector<Component> state_components(const SlamState& state);

/// Unit of trace(P): length^2, and in the heading model + rad^2.
std::string trace_unit(const SlamState& state);

/// The charts of the error in which NEES are reported. Where all estimators are the process model's own, this is its
/// own chart alone.
enum class Charts { euclidean, euclidean_and_invariant };

Charts charts_of(const SlamState& state);

/// Positions in the list of `trial_columns`.
enum ColumnIndex { column_trace_P, column_unseen, column_pose_error, column_nees_ratio, column_nis_ratio,
                   column_mean_trace_P, column_log_score, column_path_length, column_status, column_status_pose,
                   column_count };

/// The per-trial columns, in the order of ColumnIndex.
std::vector<Column> trial_columns(const SlamState& state);

/// The per-step series, in the order in which src/slam/trial/step_evaluation.hpp writes them.
std::vector<Series> step_series(const SlamState& state);

}  // namespace credence
