#pragma once
// Room 8: a scenario made ready: the tables that its equations read, computed once.

#include <credence/planner.hpp>
#include <credence/slam_record.hpp>

namespace credence {

/// What a trial reads: plain numbers and pointers into a Problem.
struct ProblemView {
    Process process = Process::heading;
    int poses = 0, features = 0, state_size = 0;
    WorldParameters world;
    SensorParameters sensor;
    FilterParameters filter;
    ControlParameters control;
    int block_count = 0;
    int figure_count = 0;
    const double* coverage_bounds = nullptr;  ///< [block_count, coverage_level_count] quantiles of chi-square
};

/// Owns the tables of one resolved, validated scenario. World geometry uses the project's own sincos, so that the
/// truth is the same bits everywhere.
class Problem {
public:
    explicit Problem(const Scenario& resolved_scenario);
    Problem(const Problem&) = delete;
    Problem& operator=(const Problem&) = delete;

    const Scenario& scenario() const { return scenario_; }
    const ProblemView& view() const { return view_; }

private:
    void factor_edges();
    void fill_world();
    void fill_filter();
    void fill_control();

    Scenario scenario_;
    std::vector<Point> translation_, sway_, sway_increment_;
    std::vector<Edge> edges_;
    std::vector<Control> fixed_, candidates_;
    std::vector<double> contrast_coefficients_;
    std::vector<Contrast> contrasts_;
    std::vector<double> coverage_bounds_;
    ProblemView view_;
};

/// Translation t_k of the features, k = 0 ... K - 2 [model.md, Truth].
std::vector<Point> feature_translations(const Scenario& scenario);
/// Known local deformation o_{k,j}, [K, M] row-major [model.md, Truth].
std::vector<Point> sway_offsets(const Scenario& scenario);
/// Control of the fixed path from pose k to k + 1, k = 0 ... K - 2 [model.md, Controllers].
std::vector<Control> fixed_controls(const Scenario& scenario);
/// The greedy planner's candidates in the order that decides ties [model.md, Controllers].
std::vector<Control> planner_candidates(const Scenario& scenario);

}  // namespace credence
