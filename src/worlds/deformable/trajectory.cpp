#include <credence/trajectory.hpp>

#include <credence/error.hpp>
#include "slam/estimators/estimators.hpp"
#include "slam/trial/trial.hpp"

#include "base/nan.hpp"

#include <memory>

namespace credence {

namespace {

template <int capacity>
Eigen::MatrixXd dense(const Symmetric<double, capacity>& P, int n) {
    Eigen::MatrixXd matrix(n, n);
    for (int i = 0; i < n; ++i)
        for (int j = i; j < n; ++j) matrix(i, j) = matrix(j, i) = P.entry[i][j];
    return matrix;
}

Eigen::Vector2d eigen(const Vector2<double>& v) { return {v.x, v.y}; }

/// Collects what run_trial passes by.
class Recorder {
public:
    Recorder(const ProblemView& problem, Controller controller, Trajectory& trajectory)
        : problem_(problem), controller_(controller), trajectory_(trajectory) {
        trajectory_.steps.resize(static_cast<std::size_t>(problem.poses));
    }

    template <class Layout, class Truth, class Belief>
    void started(const Layout& layout, const Truth& truth, const Belief& belief) {
        note_state(layout, truth, belief, trajectory_.steps.front());
    }

    /// Every candidate's cost: the trial's own planner prices few of them.
    template <class Layout, class Belief>
    void planned(int k, const Layout& layout, const Belief& belief) {
        const auto ahead = std::make_unique<HorizonWorkspace<Layout, double>>();
        const auto last_step = std::make_unique<PlannerWorkspace<Layout, double>>();
        price_candidates(belief, problem_.control, problem_.filter, problem_.sensor, layout, k, problem_.steps_ahead(controller_, k),
                         *ahead, *last_step, [&](int, double cost) { at(k).candidate_cost.push_back(cost); });
    }

    template <class Layout, class Truth, class Belief, class EdgeMeasurement, class Linearisation>
    void predicted(int k, const Layout& layout, const Truth& truth, const Command<double>& command,
                   const Belief& belief, const Sighting<double>* sightings, const EdgeMeasurement& edge_measurement,
                   const Linearisation& linearised) {
        TrajectoryStep& step = at(k);
        const int n = layout.size();
        step.control = {command.turn, {command.move.x, command.move.y}};
        step.truth = true_state(layout, truth);
        step.predicted_mean = Eigen::Map<const Eigen::VectorXd>(belief.mean, n);
        step.predicted_covariance = dense(belief.covariance, n);
        note_sightings(layout.features(), sightings, step);
        if (2 * (layout.features() + problem_.filter.edge_count) <= Trajectory::largest_innovation)
            note_innovation(layout, belief, sightings, edge_measurement, linearised, step);
    }

    template <class Layout, class Belief>
    void updated(int k, const Layout& layout, const Belief& belief, const double* all_series) {
        TrajectoryStep& step = at(k);
        note_belief(layout, belief, step);
        const auto series = [&](int f) { return all_series[f * (problem_.poses - 1) + k - 1]; };
        step.nees = series(0);
        step.nis = series(problem_.group_count);
        step.rows = static_cast<int>(series(problem_.group_count + 1));
    }

private:
    TrajectoryStep& at(int k) { return trajectory_.steps[static_cast<std::size_t>(k)]; }

    template <class Layout, class Truth>
    static Eigen::VectorXd true_state(const Layout& layout, const Truth& truth) {
        Eigen::VectorXd state(static_cast<Eigen::Index>(layout.size()));
        if constexpr (Layout::has_heading) state[Layout::heading] = truth.heading;
        state.segment<2>(Layout::position) = eigen(truth.position);
        for (int j = 0; j < layout.features(); ++j)
            state.segment<2>(Layout::feature(j)) = eigen(truth.feature[j]);
        return state;
    }

    template <class Layout, class Belief>
    void note_belief(const Layout& layout, const Belief& belief, TrajectoryStep& step) {
        step.mean = Eigen::Map<const Eigen::VectorXd>(belief.mean, layout.size());
        step.covariance = problem_.filter.covariance_factor * dense(belief.covariance, layout.size());
        step.trace_P = problem_.filter.covariance_factor * trace(belief.covariance, layout.size());
    }

    template <class Layout, class Truth, class Belief>
    void note_state(const Layout& layout, const Truth& truth, const Belief& belief, TrajectoryStep& step) {
        step.truth = true_state(layout, truth);
        note_belief(layout, belief, step);
    }

    static void note_sightings(int features, const Sighting<double>* sightings, TrajectoryStep& step) {
        step.measurement_sigma.resize(features);
        step.measurement.resize(features, 2);
        for (int j = 0; j < features; ++j) {
            step.seen.push_back(sightings[j].seen);
            step.measurement_sigma[j] = sightings[j].sigma;
            step.measurement.row(j) = sightings[j].seen ? eigen(sightings[j].z) : Eigen::Vector2d(nan, nan);
        }
    }

    /// nu and S of the joint update [model.md, Filter]: features in the body frame, then edges; NaN where not observed.
    template <class Layout, class Belief, class EdgeMeasurement, class Linearisation>
    void note_innovation(const Layout& layout, const Belief& belief, const Sighting<double>* sightings,
                         const EdgeMeasurement& edge_measurement, const Linearisation& linearised,
                         TrajectoryStep& step) {
        const FilterParameters& filter = problem_.filter;
        const int features = layout.features(), m = 2 * (features + filter.edge_count);
        Eigen::MatrixXd H = Eigen::MatrixXd::Zero(m, layout.size());
        Eigen::VectorXd N(m);
        step.innovation.resize(m);
        const Rotation<double> frame = linearised.frame;
        Eigen::Matrix2d into_body;
        into_body << frame.cosine, frame.sine, -frame.sine, frame.cosine;
        for (int j = 0; j < features; ++j) {
            const auto [rows, innovation] = linearised(j, sightings[j]);
            step.innovation.segment<2>(2 * j) = into_body * eigen(innovation);
            if constexpr (Layout::has_heading) H.block<2, 1>(2 * j, Layout::heading) = into_body * eigen(rows.lever);
            H.block<2, 2>(2 * j, Layout::position) = -into_body;
            H.block<2, 2>(2 * j, Layout::feature(j)) = into_body;
            N.segment<2>(2 * j).setConstant(believed_variance(filter, sightings[j].sigma));
        }
        for (int e = 0; e < filter.edge_count; ++e) {
            const int row = 2 * (features + e);
            const int from = Layout::feature(filter.edges[e].from), to = Layout::feature(filter.edges[e].to);
            step.innovation.segment<2>(row) =
                eigen(edge_measurement(e)) - eigen(point_at(belief.mean, to) - point_at(belief.mean, from));
            H.block<2, 2>(row, from) = -Eigen::Matrix2d::Identity();
            H.block<2, 2>(row, to) = Eigen::Matrix2d::Identity();
            N.segment<2>(row).setConstant(filter.variance_edge);
        }
        step.innovation_covariance = H * step.predicted_covariance * H.transpose();
        step.innovation_covariance.diagonal() += N;
        for (int j = 0; j < features; ++j) {
            if (sightings[j].seen) continue;
            step.innovation.segment<2>(2 * j).setConstant(nan);
            step.innovation_covariance.middleRows<2>(2 * j).setConstant(nan);
            step.innovation_covariance.middleCols<2>(2 * j).setConstant(nan);
        }
    }

    const ProblemView& problem_;
    Controller controller_;
    Trajectory& trajectory_;
};

template <class Noise>
Trajectory replay(const Problem& problem, const Arm& arm, const Noise& noise, const std::string& source) {
    const ProblemView& view = problem.view();
    const DeformableSettings& scenario = problem.scenario();
    Trajectory trajectory;
    trajectory.scenario = scenario;
    trajectory.source = source;
    trajectory.arm = arm;
    trajectory.columns.resize(column_count);
    if (arm.controller != Controller::fixed) trajectory.candidates = planner_candidates(scenario);
    std::vector<double> all_series(static_cast<std::size_t>(view.series_count) * static_cast<std::size_t>(view.poses - 1));
    Recorder recorder(view, arm.controller, trajectory);
    const auto run = [&](auto process, auto estimator) {
        using StateLayout = Layout<process(), any_count>;
        using Estimating = typename decltype(estimator)::template type<StateLayout, double>;
        const auto work = std::make_unique<Workspace<StateLayout, double, Estimating>>();
        run_trial(view, arm.controller, noise, recorder, *work, trajectory.columns.data(), all_series.data());
    };
    const auto run_process = [&](auto process) {
        with_estimator<process()>(arm.estimator, [&](auto estimator) { run(process, estimator); });
    };
    if (view.process == Process::heading)
        run_process(std::integral_constant<Process, Process::heading>{});
    else
        run_process(std::integral_constant<Process, Process::translation>{});
    fill_failed(trial_columns(scenario), trajectory.columns.data());
    return trajectory;
}

}  // namespace

void check_covers(const NoiseRecord& record, const DeformableSettings& scenario, const std::string& file) {
    const auto refuse = [&](const std::string& why, const std::string& remedy) {
        throw InputError("noise record " + file + " does not fit scenario " + scenario.name + " (" + why + "). " +
                         remedy + ".");
    };
    const int features = static_cast<int>(scenario.features.positions.size());
    const int edges = static_cast<int>(edge_list(scenario).size());
    if (record.poses < scenario.poses)
        refuse("it has " + std::to_string(record.poses) + " poses, the scenario " + std::to_string(scenario.poses),
               "Lower scenario.poses or record more");
    if (record.features < features)
        refuse("it has " + std::to_string(record.features) + " features, the scenario " + std::to_string(features),
               "Give fewer features.positions or record more");
    if (scenario.truth.edge_noise == EdgeNoise::independent && record.edges != edges)
        refuse("truth.edge_noise=independent needs `edge` [poses, " + std::to_string(edges) + ", 2]",
               "Record it, in graph order");
    if (scenario.sensor.detection < 1)
        refuse("a record has no detection draws", "Set sensor.detection=1");
}

Trajectory replay_trial(const Problem& problem, const Arm& arm, std::uint64_t root_seed, std::int64_t trial) {
    return replay(problem, arm,
                  KeyedDraws<double>(root_seed, static_cast<std::uint64_t>(trial), problem.view().world.truncate),
                  "root seed " + std::to_string(root_seed) + ", trial " + std::to_string(trial));
}

Trajectory replay_record(const Problem& problem, const Arm& arm, const NoiseRecord& record) {
    return replay(problem, arm, RecordedDraws(record), "noise record");
}

}  // namespace credence
