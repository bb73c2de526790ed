#pragma once
// The observer of a single trial of EKF-SLAM that records its trajectory.

#include "slam/trial/problem.hpp"
#include "slam/trial/workspace.hpp"

#include <credence/detail/trajectory.hpp>

#include "base/nan.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace credence {

/// The variables of every such trajectory, as places in Trajectory::variables.
struct SlamVariables {
    std::size_t truth, mean, covariance, predicted_mean, predicted_covariance;
    std::size_t nees, nis, trace_P, rows;
    std::size_t control_turn, control_move;
    std::size_t seen, measurement_sigma, measurement;
    std::size_t innovation = 0, innovation_covariance = 0;
    bool has_innovation = false;  ///< false: a trial's would be too large
};

/// Adds dimensions and variables. `control` says what the recorded control is, such as `that led to this pose`.
SlamVariables add_slam_variables(Trajectory& trajectory, const SlamState& state, const std::vector<Edge>& edges,
                                 const std::string& control);

/// The innovation nu of the joint update and the rows H of its measurements [docs/model.md, Filter].
struct JointMeasurement {
    JointMeasurement(int rows, int columns)
        : n(columns), H(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns)),
          innovation(static_cast<std::size_t>(rows)), noise(static_cast<std::size_t>(rows)) {}

    /// Two rows of H in the columns `column` and `column` + 1.
    void set(int row, int column, double a00, double a01, double a10, double a11) {
        at(row, column) = a00, at(row, column + 1) = a01, at(row + 1, column) = a10, at(row + 1, column + 1) = a11;
    }
    double& at(int row, int column) { return H[static_cast<std::size_t>(row * n + column)]; }

    /// Writes H P H' + N, and NaN into rows and columns of innovations that are NaN. `P` [n, n], `S` [m, m].
    void write_covariance(const double* P, double* S) const;

    int n = 0;                       ///< components of the state
    std::vector<double> H;           ///< [m, n]
    std::vector<double> innovation;  ///< [m], NaN where not observed
    std::vector<double> noise;       ///< [m] diagonal of N
};

inline namespace CREDENCE_TARGET {

/// The base of the worlds' observers.
class SlamRecorder {
public:
    SlamRecorder(const CommonView& problem, const SlamVariables& variables, Trajectory& trajectory)
        : problem_(problem), at_(variables), trajectory_(trajectory) {}

    template <class Layout, class Truth, class Belief>
    void started(const Layout& layout, const Truth& truth, const Belief& belief) {
        write_truth(layout, truth, 0);
        write_belief(layout, belief, 0);
    }

    template <class Layout, class Truth, class Belief, class EdgeMeasurement, class Linearisation>
    void predicted(int k, const Layout& layout, const Truth& truth, const Command<double>& command,
                   const Belief& belief, const Sighting<double>* sightings, const EdgeMeasurement& edge_measurement,
                   const Linearisation& linearised) {
        *to(at_.control_turn, k) = command.turn;
        write_vector(command.move, to(at_.control_move, k));
        write_truth(layout, truth, k);
        std::copy_n(belief.mean, layout.size(), to(at_.predicted_mean, k));
        write_matrix(belief, layout.size(), 1, to(at_.predicted_covariance, k));
        write_sightings(layout.features(), sightings, k);
        if (at_.has_innovation) write_innovation(layout, belief, sightings, edge_measurement, linearised, k);
    }

    template <class Layout, class Belief>
    void updated(int k, const Layout& layout, const Belief& belief, const double* all_series) {
        const auto series = [&](int f) { return all_series[f * (problem_.poses - 1) + k - 1]; };
        write_belief(layout, belief, k);
        *to(at_.nees, k) = series(0);
        *to(at_.nis, k) = series(problem_.group_count);
        *to(at_.rows, k) = series(problem_.group_count + 1);
    }

protected:
    double* to(std::size_t variable, int pose) { return trajectory_.at(variable, pose); }

private:
    static void write_vector(const Vector2<double>& v, double* out) { out[0] = v.x, out[1] = v.y; }

    template <class Layout, class Truth>
    void write_truth(const Layout& layout, const Truth& truth, int k) {
        double* out = to(at_.truth, k);
        if constexpr (Layout::has_heading) out[Layout::heading] = truth.heading;
        write_vector(truth.position, out + Layout::position);
        for (int j = 0; j < layout.features(); ++j) write_vector(truth.feature[j], out + Layout::feature(j));
    }

    template <class Belief>
    static void write_matrix(const Belief& belief, int n, double factor, double* out) {
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) *out++ = factor * belief.covariance.at(i, j);
    }

    template <class Layout, class Belief>
    void write_belief(const Layout& layout, const Belief& belief, int k) {
        std::copy_n(belief.mean, layout.size(), to(at_.mean, k));
        write_matrix(belief, layout.size(), problem_.filter.covariance_factor, to(at_.covariance, k));
        *to(at_.trace_P, k) = problem_.filter.covariance_factor * trace(belief.covariance, layout.size());
    }

    void write_sightings(int features, const Sighting<double>* sightings, int k) {
        for (int j = 0; j < features; ++j) {
            to(at_.seen, k)[j] = sightings[j].seen;
            to(at_.measurement_sigma, k)[j] = sightings[j].sigma;
            write_vector(sightings[j].seen ? sightings[j].z : Vector2<double>{nan, nan},
                         to(at_.measurement, k) + 2 * j);
        }
    }

    /// Features in the body frame, then edges.
    template <class Layout, class Belief, class EdgeMeasurement, class Linearisation>
    void write_innovation(const Layout& layout, const Belief& belief, const Sighting<double>* sightings,
                          const EdgeMeasurement& edge_measurement, const Linearisation& linearised, int k) {
        const FilterParameters& filter = problem_.filter;
        const int features = layout.features(), m = 2 * (features + filter.edge_count);
        JointMeasurement joint(m, layout.size());
        const Rotation<double> frame = linearised.frame;
        const double c = frame.cosine, s = frame.sine;
        const auto into_body = [&](const Vector2<double>& v) {
            return Vector2<double>{c * v.x + s * v.y, c * v.y - s * v.x};
        };
        const auto observed = [&](int row, const Vector2<double>& innovation, double variance) {
            write_vector(innovation, &joint.innovation[static_cast<std::size_t>(row)]);
            std::fill_n(&joint.noise[static_cast<std::size_t>(row)], 2, variance);
        };
        for (int j = 0; j < features; ++j) {
            const auto [rows, innovation] = linearised(j, sightings[j]);
            observed(2 * j, sightings[j].seen ? into_body(innovation) : Vector2<double>{nan, nan},
                     believed_variance(filter, sightings[j].sigma));
            if constexpr (Layout::has_heading) {
                const Vector2<double> lever = into_body(rows.lever);
                joint.at(2 * j, Layout::heading) = lever.x;
                joint.at(2 * j + 1, Layout::heading) = lever.y;
            }
            joint.set(2 * j, Layout::position, -c, -s, s, -c);
            joint.set(2 * j, Layout::feature(j), c, s, -s, c);
        }
        for (int e = 0; e < filter.edge_count; ++e) {
            const int row = 2 * (features + e);
            const int from = Layout::feature(filter.edges[e].from), end = Layout::feature(filter.edges[e].to);
            const Vector2<double> z = edge_measurement(e), a = point_at(belief.mean, from),
                                  b = point_at(belief.mean, end);
            observed(row, {z.x - (b.x - a.x), z.y - (b.y - a.y)}, filter.variance_edge);
            joint.set(row, from, -1, 0, 0, -1);
            joint.set(row, end, 1, 0, 0, 1);
        }
        std::copy(joint.innovation.begin(), joint.innovation.end(), to(at_.innovation, k));
        joint.write_covariance(to(at_.predicted_covariance, k), to(at_.innovation_covariance, k));
    }

    const CommonView& problem_;
    SlamVariables at_;
    Trajectory& trajectory_;
};

}  // namespace CREDENCE_TARGET

}  // namespace credence
