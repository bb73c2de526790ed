#include "support.hpp"

#include <credence/error.hpp>
#include "slam/estimators/estimators.hpp"
#include "worlds/deformable/keys.hpp"
#include "slam/trial/trial.hpp"

#include <cmath>
#include <memory>

namespace credence::test {

DeformableSettings scenario_with(DeformableSettings base, const Settings& settings) {
    for (const auto& [key, value] : settings) set_key(base, key, value);
    const DeformableSettings scenario = resolved(base);
    validate(scenario);
    return scenario;
}

DeformableSettings scenario_with(const Settings& settings) { return scenario_with(DeformableSettings{}, settings); }

std::vector<Settings> seed_cells() {
    std::vector<Settings> cells;
    for (const char* process : {"heading", "translation"})
        for (const char* path : {"straight", "circle"})
            for (const char* noise : {"constant", "ranged"})
                cells.push_back({{"model.process", process}, {"features.path", path}, {"sensor.noise", noise}});
    return cells;
}

std::string described(const Settings& settings) {
    std::string text;
    for (const auto& [key, value] : settings) text += (text.empty() ? "" : ", ") + key + "=" + value;
    return text;
}

Settings matched_world() {
    return {{"truth.deformation", "walk"}, {"truth.edge_noise", "independent"}, {"sensor.range_min", "0"},
            {"sensor.range_max", "inf"}};
}

AnyNoise keyed_noise(const DeformableSettings& scenario, std::uint64_t root_seed, std::uint64_t trial) {
    const KeyedDraws<double> draws(root_seed, trial, scenario.noise.truncate.value_or(infinity));
    return {[draws](Source source, int pose, int index) { return draws.normal(source, pose, index); },
            [draws](Source source, int pose, int index) { return draws.uniform(source, pose, index); }};
}

AnyNoise silent_noise() {
    return {[](Source, int, int) { return Vector2<double>{}; }, [](Source, int, int) { return 0.0; }};
}

AnyNoise with_draw(AnyNoise noise, Source source, int pose, int index, Vector2<double> draw) {
    const auto others = noise.normal_draw;
    noise.normal_draw = [=](Source s, int p, int i) {
        return s == source && p == pose && i == index ? draw : others(s, p, i);
    };
    return noise;
}

oracle::Noise for_oracle(const AnyNoise& noise) {
    return {[noise](Source source, int pose, int index) {
                const Vector2<double> draw = noise.normal(source, pose, index);
                return Eigen::Vector2d(draw.x, draw.y);
            },
            noise.uniform_draw};
}

namespace {

Eigen::Vector2d eigen(const Vector2<double>& v) { return {v.x, v.y}; }

template <class Belief>
Eigen::MatrixXd dense(const Belief& belief, int n) {
    Eigen::MatrixXd P(n, n);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) P(i, j) = belief.covariance.at(i, j);
    return P;
}

template <class Layout, class Truth>
Eigen::VectorXd true_state(const Layout& layout, const Truth& truth) {
    Eigen::VectorXd x(static_cast<Eigen::Index>(layout.size()));
    if constexpr (Layout::has_heading) x[Layout::heading] = truth.heading;
    x.segment<2>(Layout::position) = eigen(truth.position);
    for (int j = 0; j < layout.features(); ++j) x.segment<2>(Layout::feature(j)) = eigen(truth.feature[j]);
    return x;
}

/// Records the quantities that run_trial passes to its observer.
class Scribe {
public:
    Scribe(Run& run, const ProblemView& view, Controller controller)
        : run_(run), view_(view), controller_(controller), edges_(view.filter.edge_count) {}

    template <class Layout, class Truth, class Belief>
    void started(const Layout& layout, const Truth& truth, const Belief& belief) {
        RunStep& step = run_.steps.front();
        step.truth = true_state(layout, truth);
        step.mean = Eigen::Map<const Eigen::VectorXd>(belief.mean, layout.size());
        step.covariance = dense(belief, layout.size());
    }

    template <class Layout, class Belief>
    void planned(int k, const Layout& layout, const Belief& belief) {
        const auto ahead = std::make_unique<HorizonWorkspace<Layout, double>>();
        const auto planner = std::make_unique<PlannerWorkspace<Layout, double>>();
        const Planning<Layout, double> given{view_.control, view_.filter, view_.sensor, layout, *planner};
        price_candidates(belief, given, k, view_.steps_ahead(controller_, k), *ahead,
                         [&](int, double cost) { at(k).candidate_cost.push_back(cost); });
    }

    template <class Layout, class Truth, class Belief, class EdgeMeasurement>
    void predicted(int k, const Layout& layout, const Truth& truth, const Command<double>& command,
                   const Belief& belief, const Sighting<double>* sightings, const EdgeMeasurement& edge, const auto&) {
        RunStep& step = at(k);
        step.truth = true_state(layout, truth);
        step.control = {command.turn, {command.move.x, command.move.y}};
        step.prior_mean = Eigen::Map<const Eigen::VectorXd>(belief.mean, layout.size());
        step.prior_covariance = dense(belief, layout.size());
        step.sigma.resize(layout.features());
        step.sighting.resize(layout.features(), 2);
        for (int j = 0; j < layout.features(); ++j) {
            step.seen.push_back(sightings[j].seen);
            step.sigma[j] = sightings[j].sigma;
            step.sighting.row(j) = eigen(sightings[j].z);
        }
        step.edge.resize(edges_, 2);
        for (int e = 0; e < edges_; ++e) step.edge.row(e) = eigen(edge(e));
    }

    template <class Layout, class Belief>
    void updated(int k, const Layout& layout, const Belief& belief, const double*) {
        at(k).mean = Eigen::Map<const Eigen::VectorXd>(belief.mean, layout.size());
        at(k).covariance = dense(belief, layout.size());
    }

private:
    RunStep& at(int k) { return run_.steps[static_cast<std::size_t>(k)]; }

    Run& run_;
    const ProblemView& view_;
    Controller controller_;
    int edges_;
};

template <Process process>
void run_process(const ProblemView& view, const Arm& arm, const AnyNoise& noise, Form form, Scribe& scribe,
                 double* columns, double* figures) {
    const auto run = [&](auto layout, auto estimator) {
        using Estimating = typename decltype(estimator)::template type<decltype(layout), double>;
        const auto work = std::make_unique<Workspace<decltype(layout), double, Estimating>>();
        run_trial(view, arm.controller, noise, scribe, *work, columns, figures);
    };
    if (view.features == 3 && form == Form::engine && arm.estimator == own_estimator(process))
        run(Layout<process, 3>(3), EstimatorTag<KalmanFilter>{});
    else
        with_estimator<process>(arm.estimator,
                                [&](auto estimator) { run(Layout<process, any_count>(view.features), estimator); });
}

}  // namespace

Run run_arm(const DeformableSettings& scenario, Controller controller, const AnyNoise& noise, Form form) {
    return run_arm(scenario, Arm{controller, own_estimator(scenario.process)}, noise, form);
}

Run run_arm(const DeformableSettings& scenario, const Arm& arm, const AnyNoise& noise, Form form) {
    const Problem problem(scenario);
    const ProblemView& view = problem.view();
    Run run;
    run.columns.resize(column_count);
    run.steps.resize(static_cast<std::size_t>(view.poses));
    for (const Series& figure : step_series(scenario)) run.names.push_back(figure.name);
    Eigen::MatrixXd by_step(view.poses - 1, view.series_count);  // Eigen's columns are the engine's rows
    Scribe scribe(run, view, arm.controller);
    if (view.process == Process::heading)
        run_process<Process::heading>(view, arm, noise, form, scribe, run.columns.data(), by_step.data());
    else
        run_process<Process::translation>(view, arm, noise, form, scribe, run.columns.data(), by_step.data());
    run.figures = by_step.transpose();
    return run;
}

}  // namespace credence::test
