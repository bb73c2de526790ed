#include "worlds/deformable/deformable.hpp"

#include <credence/error.hpp>
#include "worlds/deformable/pack_trial.hpp"
#include "worlds/counted.hpp"
#include "worlds/slam_recorder.hpp"

#include <memory>

namespace credence {

namespace {

/// The costs of the planner's candidates: what they are, and in which unit.
TrajectoryVariable candidate_costs(const DeformableSettings& settings) {
    const Criterion criterion = settings.planner.criterion;
    const bool logarithm = scale_of(criterion) == CostScale::logarithmic;
    const std::string what = logarithm                                ? "log determinant"
                             : criterion == Criterion::max_eigenvalue ? "largest eigenvalue"
                                                                      : "trace",
                      of = criterion == Criterion::pose_trace || criterion == Criterion::pose_log_det ? "pose's "
                           : criterion == Criterion::features_trace                                   ? "features' "
                                                                                                      : "";
    return {"candidate_cost", what + " of the " + of + "covariance that the candidate promised",
            logarithm                                ? "1"
            : criterion == Criterion::features_trace ? settings.length_unit + "^2"
                                                     : trace_unit(settings),
            {"pose", "candidate"}};
}

/// The recorder of a trial with a planner.
class Recorder : public SlamRecorder {
public:
    Recorder(const ProblemView& problem, Controller controller, const SlamVariables& variables, std::size_t cost,
             Trajectory& trajectory)
        : SlamRecorder(problem, variables, trajectory), problem_(problem), controller_(controller), cost_(cost) {}

    /// Every candidate's cost: the trial's own planner computes few of them.
    template <class Layout, class Belief>
    void planned(int k, const Layout& layout, const Belief& belief) {
        const auto ahead = std::make_unique<HorizonWorkspace<Layout, double>>();
        const auto planner = std::make_unique<PlannerWorkspace<Layout, double>>();
        const Planning<Layout, double> given{problem_.control, problem_.filter, problem_.sensor, layout, *planner};
        price_candidates(belief, given, k, problem_.steps_ahead(controller_, k), *ahead,
                         [&](int candidate, double cost) { to(cost_, k)[candidate] = cost; });
    }

private:
    const ProblemView& problem_;
    Controller controller_;
    std::size_t cost_;
};

/// `choose`: gives the commands of a trial that a planner of one's own chooses, by its type.
template <class Noise, class Choose>
Trajectory replay(const Problem& problem, const Arm& arm, const Noise& noise, const std::string& source,
                  const Choose& choose) {
    const ProblemView& view = problem.view();
    const DeformableSettings& settings = problem.scenario();
    Trajectory trajectory = empty_trajectory(scenario_of(settings), arm_name(settings, arm), trial_columns(settings));
    trajectory.source = source;
    const SlamVariables variables =
        add_slam_variables(trajectory, settings, edge_list(settings), "that led to this pose");
    const std::size_t cost = plans(arm.controller) ? add_candidates(trajectory, settings) : 0;
    std::vector<double> all_series(static_cast<std::size_t>(view.series_count) *
                                   static_cast<std::size_t>(view.poses - 1));
    Recorder recorder(view, arm.controller, variables, cost, trajectory);
    const auto run = [&](auto process, auto estimator) {
        using StateLayout = Layout<process(), any_count>;
        using Estimating = typename decltype(estimator)::template type<StateLayout, double>;
        const auto work = std::make_unique<Workspace<StateLayout, double, Estimating>>();
        const std::vector<Command<double>> commands =
            choose(std::type_identity<DeformableTrial<StateLayout, double, decltype(estimator)>>{});
        run_trial(view, arm.controller, noise, recorder, *work, trajectory.column_values.data(), all_series.data(),
                  commands.empty() ? nullptr : commands.data());
    };
    const auto run_process = [&](auto process) {
        with_estimator<process()>(arm.estimator, [&](auto estimator) { run(process, estimator); });
    };
    if (view.process == Process::heading)
        run_process(std::integral_constant<Process, Process::heading>{});
    else
        run_process(std::integral_constant<Process, Process::translation>{});
    fill_failed(trajectory.columns, trajectory.column_values.data());
    return trajectory;
}

CountedVariances count(const Problem& problem, const Arm& arm, std::uint64_t root_seed, std::int64_t trials) {
    const ProblemView& view = problem.view();
    const NoiseSettings& noise = problem.scenario().noise;
    const double walk = noise.walk * noise.walk, feature = walk + noise.deformation * noise.deformation;
    const std::vector<CountedSource> sources =
        counted_sources(view.filter, feature > 0 ? walk / feature : 0, "measurement");
    std::vector<double> all_series(static_cast<std::size_t>(view.series_count) *
                                   static_cast<std::size_t>(view.poses - 1));
    const auto run_process = [&](auto process) {
        return with_estimator<process()>(arm.estimator, [&](auto estimator) {
            using StateLayout = Layout<process(), any_count>;
            using Estimating =
                Attributed<typename decltype(estimator)::template type<StateLayout, double>, StateLayout>;
            const auto work = std::make_unique<Workspace<StateLayout, double, Estimating>>();
            return count_variances(view, sources, work->estimator, trials, column_count,
                                   [&](std::int64_t trial, auto& observer, double* columns) {
                const KeyedDraws<double> draws(root_seed, static_cast<std::uint64_t>(trial), view.world.truncate,
                                               view.other);
                const auto commands = commands_of<DeformableTrial<StateLayout, double, decltype(estimator)>>(
                    view, arm.planner, root_seed, trial);
                run_trial(view, arm.controller, draws, observer, *work, columns, all_series.data(),
                          commands.empty() ? nullptr : commands.data());
            });
        });
    };
    return view.process == Process::heading ? run_process(std::integral_constant<Process, Process::heading>{})
                                            : run_process(std::integral_constant<Process, Process::translation>{});
}

}  // namespace

CountedVariances DeformableSimulation::counted(std::size_t arm, std::uint64_t root_seed, std::int64_t trials) const {
    return count(*problem_, arms_[arm], root_seed, trials);
}

std::size_t add_candidates(Trajectory& trajectory, const DeformableSettings& settings) {
    const std::vector<Control> candidates = planner_candidates(settings);
    trajectory.dimensions.push_back({"candidate", "candidate of the planner", candidates.size()});
    const std::size_t turn = trajectory.add({"candidate_turn", "turn of the candidate", "rad", {"candidate"}});
    const std::size_t move = trajectory.add({"candidate_move", "displacement of the candidate", settings.length_unit,
                                             {"candidate", "axis"}});
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        trajectory.variables[turn].values[i] = candidates[i].turn;
        trajectory.variables[move].values[2 * i] = candidates[i].move.x;
        trajectory.variables[move].values[2 * i + 1] = candidates[i].move.y;
    }
    return trajectory.add(candidate_costs(settings));
}

void check_covers(const NoiseRecord& record, const DeformableSettings& scenario, const std::string& file) {
    const auto refuse = [&](const std::string& why, const std::string& remedy) {
        throw InputError("noise record " + file + " does not fit scenario " + scenario.name, why, remedy);
    };
    const int features = feature_count(scenario);
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
    if (scenario.sensor.detection < 1) refuse("a record has no detection draws", "Set sensor.detection=1");
    if (scenario.features.placement != Placement::given)
        refuse("a record has no draws of places", "Set features.placement=given");
    if (scenario.noise.odometry_bias > 0) refuse("a record has no bias of the odometry", "Set noise.odometry_bias=0");
    if (scenario.noise.measurement_tails == Tails::contaminated)
        refuse("a record has no draws of outliers", "Set noise.measurement_tails=normal");
    if (scenario.budget.other != 0) refuse("a record has the draws of one world", "Set draws.other=none");
    for (const Controller controller : scenario.arms.controllers)
        if (controller == Controller::random)
            refuse("a record has no draws of candidates", "Leave random out of arms.controllers");
    if (!scenario.arms.planners.empty())
        refuse("planners of one's own run on draws alone", "Set arms.planners=none");
}

Trajectory replay_trial(const Problem& problem, const Arm& arm, std::uint64_t root_seed, std::int64_t trial) {
    return replay(problem, arm,
                  KeyedDraws<double>(root_seed, static_cast<std::uint64_t>(trial), problem.view().world.truncate,
                                     problem.view().other),
                  source_text(root_seed, trial), [&](auto type) {
                      return commands_of<typename decltype(type)::type>(problem.view(), arm.planner, root_seed, trial);
                  });
}

std::vector<Trajectory> replay_record(const Scenario& scenario, const NoiseRecord& record, const std::string& file) {
    const DeformableSettings settings = settings_of(scenario);
    check_covers(record, settings, file);
    const Problem problem(settings);
    std::vector<Trajectory> trajectories;
    for (const Arm& arm : arms_of(settings))
        trajectories.push_back(replay(problem, arm, RecordedDraws(record), "noise record",
                                      [](auto) { return std::vector<Command<double>>{}; }));
    return trajectories;
}

}  // namespace credence
