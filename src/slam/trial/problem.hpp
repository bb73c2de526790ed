#pragma once
// The tables that a scenario's equations read, computed once for all trials.

#include "slam/planning/horizon.hpp"
#include <credence/slam_columns.hpp>

#include <memory>

namespace credence {

class Planner;

/// s (cos angle, sin angle), by our own sincos: the same bits everywhere.
Point polar(double s, double angle);

/// A state whose features enter it one by one. Those that are absent have errors of 0 and a variance below that of
/// anything known, and NEES of a group that is there in part are those of its part, times the group's dimension over
/// that of the part.
struct Growth {
    int series = -1;                  ///< that counts the components that are there; -1: all are, always
    int features = 0;                 ///< the group of all features, which lacks what the whole state lacks
    int pose_size = 0;
    double absent_variance = 0;       ///< of a component that is absent
    const double* bounds = nullptr;   ///< [2 (whole state, features), n + 1, coverage_level_count] by dimension
};

/// The data that a trial of any built-in world reads: plain numbers, and pointers into its problem.
struct CommonView {
    int poses = 0, features = 0, state_size = 0;
    SensorParameters sensor;
    FilterParameters filter;
    int group_count = 0;
    int series_count = 0;
    Charts charts = Charts::euclidean;
    const double* coverage_bounds = nullptr;  ///< [group_count, coverage_level_count] quantiles of chi-square
    Growth growth;
    std::uint32_t other = 0;                  ///< sources whose draws are another world's [draws.hpp]
    int kept_steps[most_kept_steps] = {}, kept_count = 0;  ///< steps of which the errors are columns [columns.hpp]
    bool keeps_variances = false;

    /// The columns of errors and variances.
    int error_columns() const { return kept_count * state_size * (keeps_variances ? 2 : 1); }
};

/// Fills in what is kept for a budget, after poses and state_size.
void set_budget(CommonView& view, const BudgetSettings& budget);

/// The further data that a trial in the deformable world reads.
struct ProblemView : CommonView {
    Process process = Process::heading;
    WorldParameters world;
    ControlParameters control;
    const Planner* const* planners = nullptr;  ///< [planners of the scenario's arms]

    /// Number of steps that a controller plans ahead on the way to pose k: a horizon ends no later than at the last
    /// pose.
    int steps_ahead(Controller controller, int k) const {
        if (controller != Controller::horizon) return 1;
        return control.horizon < poses - k ? control.horizon : poses - k;
    }
};

/// Owns the tables of one resolved, validated scenario. World geometry uses the project's own sincos, so that the
/// truth is the same bits everywhere.
class Problem {
public:
    explicit Problem(const DeformableSettings& resolved_scenario);
    Problem(const Problem&) = delete;
    Problem& operator=(const Problem&) = delete;

    const DeformableSettings& scenario() const { return scenario_; }
    const ProblemView& view() const { return view_; }

private:
    void factor_edges();
    void fill_world();
    void fill_filter();
    void fill_control();

    DeformableSettings scenario_;
    std::vector<Point> translation_, sway_, sway_increment_;
    std::vector<Edge> edges_;
    std::vector<Control> fixed_, waypoints_, candidates_;
    std::unique_ptr<bool[]> repeated_;
    std::vector<double> contrast_coefficients_;
    std::vector<Contrast> contrasts_;
    std::vector<double> coverage_bounds_;
    std::vector<std::shared_ptr<const Planner>> planners_;
    std::vector<const Planner*> planner_list_;
    ProblemView view_;
};

/// Translation t_k of the features, k = 0 ... K - 2 [docs/model.md, Truth].
std::vector<Point> feature_translations(const DeformableSettings& scenario);
/// Known local deformation o_{k,j}, [K, M] row-major [docs/model.md, Truth].
std::vector<Point> sway_offsets(const DeformableSettings& scenario);
/// Control of the fixed path from pose k to k + 1, k = 0 ... K - 2 [docs/model.md, Controllers].
std::vector<Control> fixed_controls(const DeformableSettings& scenario);
/// Control along control.waypoints from pose k to k + 1, k = 0 ... K - 2; no motion where there are none
/// [docs/model.md, Controllers].
std::vector<Control> waypoint_controls(const DeformableSettings& scenario);
/// The planners' candidates in the order that decides ties [docs/model.md, Controllers].
std::vector<Control> planner_candidates(const DeformableSettings& scenario);

}  // namespace credence
