#include <credence/store.hpp>

#include "files/trajectory/group.hpp"

#include <map>

namespace credence {

namespace {

using hdf5::Dimension;
using hdf5::Handle;
using Step = TrajectoryStep;

/// Writes the trial's columns, and the source of its noise, as attributes of the group.
void write_columns(const TrajectoryGroup& to) {
    hdf5::write_text(to.group, "source", to.trajectory.source);
    const std::vector<Column> columns = trial_columns(to.trajectory.scenario);
    for (std::size_t c = 0; c < columns.size(); ++c) {
        const std::string& name = columns[c].name;
        const double value = to.trajectory.columns[c];
        switch (columns[c].type) {
            case ColumnType::real: hdf5::write_number(to.group, name, one_nan(value)); break;
            case ColumnType::integer: hdf5::write_number(to.group, name, static_cast<std::int32_t>(value)); break;
            case ColumnType::status:
                hdf5::write_number(to.group, name, static_cast<std::int8_t>(value));
                hdf5::write_text(to.group, name + "_text", status_names().at(static_cast<std::size_t>(value)));
        }
    }
}

void write_states(const TrajectoryGroup& to) {
    const auto state = [&](const char* name, const char* long_name, auto get) {
        to.per_pose(name, {&to.component}, {long_name, to.state_unit}, get);
    };
    const auto matrix = [&](const char* name, const char* long_name, auto get) {
        to.per_pose(name, {&to.component, &to.component_2}, {long_name, to.covariance_unit}, get);
    };
    state("truth", "true state", [](const Step& s) -> auto& { return s.truth; });
    state("mean", "estimated state, after the update", [](const Step& s) -> auto& { return s.mean; });
    matrix("covariance", "covariance as reported, after the update",
           [](const Step& s) -> auto& { return s.covariance; });
    state("predicted_mean", "estimated state, before the update",
          [](const Step& s) -> auto& { return s.predicted_mean; });
    matrix("predicted_covariance", "covariance as the filter holds it, before the update",
           [](const Step& s) -> auto& { return s.predicted_covariance; });
}

void write_judgement(const TrajectoryGroup& to) {
    to.per_pose_number("nees", {"normalised estimation error squared of the whole state", "1"},
                       [](const Step& s) { return arrived(s) ? s.nees : NAN; });
    to.per_pose_number("nis", {"normalised innovation squared over all rows", "1"},
                       [](const Step& s) { return arrived(s) ? s.nis : NAN; });
    to.per_pose_number("trace_P",
                       {"trace of the covariance as reported, after the update", trace_unit(to.trajectory.scenario)},
                       [](const Step& s) { return s.mean.size() > 0 ? s.trace_P : NAN; });
    std::vector<std::int32_t> rows;
    for (const Step& step : to.trajectory.steps) rows.push_back(arrived(step) ? step.rows : -1);
    const Handle variable =
        hdf5::new_variable(to.group, "rows", rows, {&to.pose}, {"measurement rows of the update", "1"});
    hdf5::write_numbers<std::int32_t>(variable, "_FillValue", {-1});
}

void write_control(const TrajectoryGroup& to) {
    const std::string frame = to.trajectory.scenario.process == Process::heading ? "body" : "world";
    to.per_pose_number("control_turn", {"turn that led to this pose", "rad"},
                       [](const Step& s) { return arrived(s) ? s.control.turn : NAN; });
    to.per_pose("control_move", {&to.axis}, {"displacement that led to this pose, " + frame + " frame", to.length_unit},
                [](const Step& s) {
                    const Point move = arrived(s) ? s.control.move : Point{NAN, NAN};
                    return Eigen::Vector2d(move.x, move.y);
                });
}

void write_sensing(const TrajectoryGroup& to) {
    std::vector<std::int8_t> seen;
    for (const Step& step : to.trajectory.steps) {
        seen.insert(seen.end(), step.seen.begin(), step.seen.end());
        if (step.seen.empty()) seen.insert(seen.end(), to.feature.size, -1);
    }
    const Handle variable =
        hdf5::new_variable(to.group, "seen", seen, {&to.pose, &to.feature}, {"whether the feature was seen", "1"});
    hdf5::write_numbers<std::int8_t>(variable, "flag_values", {-1, 0, 1});
    hdf5::write_text(variable, "flag_meanings", "not_looked_for unseen seen");
    to.per_pose("measurement_sigma", {&to.feature},
                {"true standard deviation of the measurement, each axis", to.length_unit},
                [](const Step& s) -> auto& { return s.measurement_sigma; });
    to.per_pose("measurement", {&to.feature, &to.axis},
                {"measured position of the feature, body frame", to.length_unit},
                [](const Step& s) -> auto& { return s.measurement; });
}

void write_edges(const TrajectoryGroup& to) {
    if (to.edges.empty()) return;
    std::vector<std::int32_t> from, ends;
    for (const Edge& edge : to.edges) from.push_back(edge.from), ends.push_back(edge.to);
    const Dimension edge = to.number("edge", to.edges.size(), "edge of the constraint graph");
    hdf5::new_variable(to.group, "edge_from", from, {&edge}, {"feature that the edge leaves", "1"});
    hdf5::new_variable(to.group, "edge_to", ends, {&edge}, {"feature that the edge goes to", "1"});
}

void write_innovation(const TrajectoryGroup& to) {
    const std::size_t rows = 2 * (to.feature.size + to.edges.size());
    if (rows > Trajectory::largest_innovation)
        return hdf5::write_text(to.group, "innovation_omitted",
                                std::to_string(rows) + " rows, more than the " +
                                    std::to_string(Trajectory::largest_innovation) + " that are kept");
    const std::string name = "row of the measurement: 2 feature + axis, then 2 (features + edge) + axis";
    const Dimension row = to.number("row", rows, name), row_2 = to.number("row_2", rows, name + ", along columns");
    to.per_pose("innovation", {&row}, {"innovation: features in the body frame, then edges", to.length_unit},
                [](const Step& s) -> auto& { return s.innovation; });
    to.per_pose("innovation_covariance", {&row, &row_2}, {"covariance of the innovation", to.length_unit + "^2"},
                [](const Step& s) -> auto& { return s.innovation_covariance; });
}

void write_candidates(const TrajectoryGroup& to) {
    const std::vector<Control>& candidates = to.trajectory.candidates;
    if (candidates.empty()) return;
    std::vector<double> turns, moves;
    for (const Control& control : candidates) {
        turns.push_back(control.turn);
        moves.insert(moves.end(), {control.move.x, control.move.y});
    }
    const Dimension candidate = to.number("candidate", candidates.size(), "candidate of the planner");
    hdf5::new_variable(to.group, "candidate_turn", turns, {&candidate}, {"turn of the candidate", "rad"});
    hdf5::new_variable(to.group, "candidate_move", moves, {&candidate, &to.axis},
                       {"displacement of the candidate", to.length_unit});
    to.per_pose("candidate_cost", {&candidate},
                {"trace of the covariance that the candidate promised", trace_unit(to.trajectory.scenario)},
                [](const Step& s) {
                    const auto count = static_cast<Eigen::Index>(s.candidate_cost.size());
                    return Eigen::Map<const Eigen::VectorXd>(s.candidate_cost.data(), count);
                });
}

void write_trajectory(const Handle& scenario_group, const Trajectory& trajectory) {
    const TrajectoryGroup to(scenario_group, trajectory);
    write_columns(to);
    write_states(to);
    write_judgement(to);
    write_control(to);
    write_sensing(to);
    write_edges(to);
    write_innovation(to);
    write_candidates(to);
}

}  // namespace

void write_trajectories(const Output& output, const std::vector<Trajectory>& trajectories, const RunFacts& run) {
    for (const Trajectory& trajectory : trajectories) refuse_reserved_name(scenario_of(trajectory.scenario));
    write_file(output, [&](const Handle& root) {
        write_header(root, trajectories_format, "Single trials of EKF-SLAM with everything that happened in them");
        std::map<std::string, Handle> groups;
        for (const Trajectory& trajectory : trajectories) {
            const std::string& name = trajectory.scenario.name;
            if (groups.count(name) == 0) groups.emplace(name, new_scenario_group(root, scenario_of(trajectory.scenario)));
            write_trajectory(groups.at(name), trajectory);
        }
        write_run_facts(root, run);
    });
}

}  // namespace credence
