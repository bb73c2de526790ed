#include "worlds/slam_recorder.hpp"

#include <cmath>

namespace credence {

namespace {

using Variable = TrajectoryVariable;

/// The graph of the edges, which does not change from pose to pose.
void add_edges(Trajectory& trajectory, const std::vector<Edge>& edges) {
    if (edges.empty()) return;
    trajectory.dimensions.push_back({"edge", "edge of the constraint graph", edges.size()});
    const auto add_ends = [&](const std::string& name, const std::string& long_name, int Edge::* end) {
        const std::size_t place = trajectory.add({name, long_name, "1", {"edge"}, TrajectoryNumbers::integer});
        std::transform(edges.begin(), edges.end(), trajectory.variables[place].values.begin(),
                       [&](const Edge& edge) { return edge.*end; });
    };
    add_ends("edge_from", "feature that the edge leaves", &Edge::from);
    add_ends("edge_to", "feature that the edge goes to", &Edge::to);
}

void add_innovation(Trajectory& trajectory, const SlamState& state, std::size_t rows, SlamVariables& at) {
    at.has_innovation = rows <= largest_recorded_matrix;
    if (!at.has_innovation) {
        trajectory.notes.emplace_back("innovation_omitted", std::to_string(rows) + " rows, more than the " +
                                                                std::to_string(largest_recorded_matrix) +
                                                                " that are kept");
        return;
    }
    const std::string name = "row of the measurement: 2 feature + axis, then 2 (features + edge) + axis";
    trajectory.dimensions.push_back({"row", name, rows});
    trajectory.dimensions.push_back({"row_2", name + ", along columns", rows});
    at.innovation = trajectory.add({"innovation", "innovation: features in the body frame, then edges",
                                    state.length_unit, {"pose", "row"}});
    at.innovation_covariance = trajectory.add({"innovation_covariance", "covariance of the innovation",
                                               state.length_unit + "^2", {"pose", "row", "row_2"}});
}

}  // namespace

SlamVariables add_slam_variables(Trajectory& trajectory, const SlamState& state, const std::vector<Edge>& edges,
                                 const std::string& control) {
    const bool heading = state.process == Process::heading;
    const std::string length = state.length_unit, in_state = heading ? "see component_units" : length,
                      in_covariance = heading ? "products of component_units" : length + "^2";
    const auto features = static_cast<std::size_t>(state.features);
    trajectory.dimensions.push_back({"feature", "feature", features});
    trajectory.dimensions.push_back({"axis", "axis: 0 is x, 1 is y", 2});
    const auto add_state = [&](const std::string& name, const std::string& long_name) {
        return trajectory.add({name, long_name, in_state, {"pose", "component"}});
    };
    const auto add_matrix = [&](const std::string& name, const std::string& long_name) {
        return trajectory.add({name, long_name, in_covariance, {"pose", "component", "component_2"}});
    };
    SlamVariables at{};
    at.truth = add_state("truth", "true state");
    at.mean = add_state("mean", "estimated state, after the update");
    at.covariance = add_matrix("covariance", "covariance as reported, after the update");
    at.predicted_mean = add_state("predicted_mean", "estimated state, before the update");
    at.predicted_covariance =
        add_matrix("predicted_covariance", "covariance as the filter holds it, before the update");
    at.nees = trajectory.add({"nees", "normalised estimation error squared of the whole state", "1", {"pose"}});
    at.nis = trajectory.add({"nis", "normalised innovation squared over all rows", "1", {"pose"}});
    at.trace_P = trajectory.add(
        {"trace_P", "trace of the covariance as reported, after the update", trace_unit(state), {"pose"}});
    at.rows = trajectory.add({"rows", "measurement rows of the update", "1", {"pose"}, TrajectoryNumbers::integer});
    at.control_turn = trajectory.add({"control_turn", "turn " + control, "rad", {"pose"}});
    at.control_move = trajectory.add({"control_move",
                                      "displacement " + control + ", " + (heading ? "body" : "world") + " frame",
                                      length,
                                      {"pose", "axis"}});
    at.seen = trajectory.add({"seen", "whether the feature was seen", "1", {"pose", "feature"}, TrajectoryNumbers::flag,
                              "not_looked_for unseen seen"});
    at.measurement_sigma = trajectory.add({"measurement_sigma", "true standard deviation of the measurement, each axis",
                                           length, {"pose", "feature"}});
    at.measurement = trajectory.add({"measurement", "measured position of the feature, body frame", length,
                                     {"pose", "feature", "axis"}});
    add_edges(trajectory, edges);
    add_innovation(trajectory, state, 2 * (features + edges.size()), at);
    return at;
}

void JointMeasurement::write_covariance(const double* P, double* S) const {
    const auto size = static_cast<std::size_t>(n), m = innovation.size();
    std::vector<double> row(size);  // of H P
    for (std::size_t i = 0; i < m; ++i) {
        std::fill(row.begin(), row.end(), 0.0);
        for (std::size_t a = 0; a < size; ++a)
            for (std::size_t b = 0; H[i * size + a] != 0 && b < size; ++b) row[b] += H[i * size + a] * P[a * size + b];
        for (std::size_t j = 0; j < m; ++j) {
            double sum = i == j ? noise[i] : 0;
            for (std::size_t b = 0; b < size; ++b) sum += row[b] * H[j * size + b];
            S[i * m + j] = std::isnan(innovation[i]) || std::isnan(innovation[j]) ? nan : sum;
        }
    }
}

}  // namespace credence
