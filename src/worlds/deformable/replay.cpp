#include "worlds/deformable/deformable.hpp"

#include <credence/error.hpp>
#include "slam/trial/trial.hpp"
#include "worlds/single_trials.hpp"
#include "worlds/slam_recorder.hpp"

#include <memory>
#include <optional>

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

/// The noise of a single trial, keyed or, where there is a record, recorded: one type, since the templates of a trial
/// take long to compile.
class SingleDraws {
public:
    SingleDraws(const ProblemView& view, std::uint64_t root_seed, std::int64_t trial)
        : keyed_(root_seed, static_cast<std::uint64_t>(trial), view.world.truncate, view.other) {}
    SingleDraws(const ProblemView& view, const NoiseRecord& record) : SingleDraws(view, 0, 0) {
        recorded_.emplace(record);
    }
    Vector2<double> normal(Source source, int pose, int index) const {
        return recorded_ ? recorded_->normal(source, pose, index) : keyed_.normal(source, pose, index);
    }
    double uniform(Source source, int pose, int index) const {
        return recorded_ ? recorded_->uniform(source, pose, index) : keyed_.uniform(source, pose, index);
    }

private:
    KeyedDraws<double> keyed_;
    std::optional<RecordedDraws> recorded_;
};

/// Calls use(single) with the SingleTrials of an arm.
template <class Use>
auto with_single_trials(const ProblemView& view, const Arm& arm, const Use& use) {
    const auto of_process = [&](auto process) {
        return with_estimator<process()>(arm.estimator, [&](auto estimator) {
            using StateLayout = Layout<process(), any_count>;
            using Estimating =
                Attributed<typename decltype(estimator)::template type<StateLayout, double>, StateLayout>;
            using Work = Workspace<StateLayout, double, Estimating>;
            SingleTrials<Recorder, ProblemView, Controller, Work> single(view, arm.controller,
                                                                         std::make_unique<Work>());
            return use(single);
        });
    };
    return view.process == Process::heading ? of_process(std::integral_constant<Process, Process::heading>{})
                                            : of_process(std::integral_constant<Process, Process::translation>{});
}

TrialInputs<SingleDraws> inputs_of(const ProblemView& view, const Arm& arm, const Target& target,
                                   std::uint64_t root_seed, std::int64_t trial) {
    return {SingleDraws(view, root_seed, trial),
            commands_of(target.workspace_size, target.simulate, view, arm, root_seed, trial)};
}

Trajectory replay(const Problem& problem, const Arm& arm, const TrialInputs<SingleDraws>& inputs,
                  const std::string& source) {
    const ProblemView& view = problem.view();
    const DeformableSettings& settings = problem.scenario();
    Trajectory trajectory = empty_trajectory(scenario_of(settings), arm_name(settings, arm), trial_columns(settings));
    trajectory.source = source;
    const SlamVariables variables =
        add_slam_variables(trajectory, settings, edge_list(settings), "that led to this pose");
    const std::size_t cost = plans(arm.controller) ? add_candidates(trajectory, settings) : 0;
    Recorder recorder(view, arm.controller, variables, cost, trajectory);
    with_single_trials(view, arm, [&](auto& single) {
        single.record(inputs, recorder, trajectory.column_values.data());
    });
    fill_failed(trajectory.columns, trajectory.column_values.data());
    return trajectory;
}

}  // namespace

CountedVariances DeformableSimulation::counted(std::size_t arm, std::uint64_t root_seed, std::int64_t trials) const {
    const ProblemView& view = problem_->view();
    const NoiseSettings& noise = problem_->scenario().noise;
    const double walk = noise.walk * noise.walk, feature = walk + noise.deformation * noise.deformation;
    const std::vector<CountedSource> sources =
        counted_sources(view.filter, feature > 0 ? walk / feature : 0, "measurement");
    return with_single_trials(view, arms_[arm], [&](auto& single) {
        return single.count(sources, trials, column_count, [&](std::int64_t trial) {
            return inputs_of(view, arms_[arm], target_, root_seed, trial);
        });
    });
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

Trajectory replay_trial(const Problem& problem, const Arm& arm, std::uint64_t root_seed, std::int64_t trial,
                        const Target& target) {
    return replay(problem, arm, inputs_of(problem.view(), arm, target, root_seed, trial),
                  source_text(root_seed, trial));
}

std::vector<Trajectory> replay_record(const Scenario& scenario, const NoiseRecord& record, const std::string& file) {
    const DeformableSettings settings = settings_of(scenario);
    check_covers(record, settings, file);
    const Problem problem(settings);
    std::vector<Trajectory> trajectories;
    for (const Arm& arm : arms_of(settings))
        trajectories.push_back(replay(problem, arm, {SingleDraws(problem.view(), record), {}}, "noise record"));
    return trajectories;
}

}  // namespace credence
