// Trials in a world that is turned and shifted, and the robot with it. No scenario has such a world, because the robot
// starts at the origin and heads along x; so the engine's own functions go on from the turned and shifted truth and
// belief. Features' motions, commands of the translation model and draws are turned where they belong to the world
// frame; what the heading model's sensor measures belongs to the body frame, and must stay as it is.

#include "catch.hpp"
#include "metamorphic.hpp"
#include "rigid_motion.hpp"

namespace credence::test::rigid_motion_test {

namespace {

/// Greatest difference of the innovations of what is in sight, in standard deviations of the measurements.
double innovation_difference(const Continued& trial, const Continued& other, std::size_t k) {
    const RunStep& step = trial.run.steps[k];
    const MatrixXd difference = other.innovation[k] - trial.innovation[k];
    double greatest = 0;
    for (Eigen::Index j = 0; j < difference.rows(); ++j)
        if (step.seen[static_cast<std::size_t>(j)])
            raise(greatest, difference.row(j).cwiseAbs().maxCoeff() / step.sigma[j]);
    return greatest;
}

double difference(const Continued& trial, const Continued& other, const Image& same) {
    double greatest = 0;
    for (std::size_t k = 1; k < trial.innovation.size(); ++k) {
        raise(greatest, state_difference(trial.run.steps[k], other.run.steps[k], same.map));
        raise(greatest, series_difference(trial.run, other.run, same, static_cast<int>(k)));
        raise(greatest, innovation_difference(trial, other, k));
    }
    return greatest;
}

/// Greatest difference of a moved trial, taken back, from the trial; and what rounding may do to it.
struct Moved {
    double found, allowed;
    bool lost;
};

template <class Layout, class Estimating>
Moved move_trial(const Problem& problem, const AnyNoise& noise, const RigidMotion& motion,
                 Workspace<Layout, double, Estimating>& work) {
    const ProblemView& view = problem.view();
    const Layout layout(view.features);
    auto start = kept(view, noise, 0, work);
    const auto moved = std::make_unique<CommonWorkspace<Layout, double, Estimating>>(*start.held);
    move(motion, layout, *moved);
    Continued trial = continued(view, noise, 0, start.commands, *start.held);
    for (const Series& series : step_series(problem.scenario())) trial.run.names.push_back(series.name);

    const TurnedProblem image(view, motion);
    if (!Layout::has_heading)
        for (Command<double>& command : start.commands) command.move = motion.direction(command.move);
    Continued other = continued(image.view, turned(motion, view.process, noise), 0, start.commands, *moved);
    other.run.names = trial.run.names;
    return {difference(trial, taken_back(motion, layout, other), Image(problem.scenario(), noise)),
            std::max(rounding_of(trial.run), rounding_of(other.run)), is_lost(trial.run)};
}

/// What random scenarios do not have by themselves.
const Settings more{{"features.sway_amplitude", "0.3"}, {"noise.odometry_bias", "0.05"}, {"filter.gate", "0.999"}};

/// Moves trials of random scenarios under every estimator.
void compare(unsigned scenarios) {
    int trials = 0, left_out = 0;
    double closest = 0;
    for (unsigned seed = 0; seed < scenarios; ++seed) {
        const std::optional<DeformableSettings> scenario = random_scenario(seed, more);
        if (!scenario) continue;
        const Problem problem(*scenario);
        const AnyNoise noise = keyed_noise(*scenario, 8, seed);
        for (const Estimator estimator : estimators_of(scenario->process))
            with_workspace(scenario->process, estimator, [&](auto& work) {
                const auto [found, allowed, lost] = move_trial(problem, noise, random_motion(seed), work);
                CAPTURE(seed, estimator, found, allowed);
                if (lost || allowed > 1e-5) return void(++left_out);
                REQUIRE(found <= allowed);
                raise(closest, found / allowed);
                ++trials;
            });
    }
    CHECK(trials > left_out);
    CHECK(closest > 1e-4);  // or the bound would say little
}

/// A truth and a belief of three features, drawn at random.
template <class Layout, class Estimating>
void stand(unsigned seed, const Layout& layout, CommonWorkspace<Layout, double, Estimating>& work) {
    const Sample at(layout.size(), seed), believed(layout.size(), seed + 1000);
    work.truth.heading = at.x[0];
    work.truth.rotation = rotation(at.x[0]);
    work.truth.position = {at.x[1], at.x[2]};
    for (int j = 0; j < layout.features(); ++j) work.truth.feature[j] = {at.x[3 + 2 * j], at.x[4 + 2 * j]};
    work.belief = belief_of<Layout>(believed.x, believed.P);
    work.estimator.start(layout, work.belief, work.truth);
}

/// Greatest difference of a first sight in the moved world from the first sight, moved.
template <class Layout, class Estimating>
double first_sight_difference(unsigned seed, CommonWorkspace<Layout, double, Estimating>& work) {
    const Layout layout(3);
    const FilterParameters filter;
    const RigidMotion motion = random_motion(seed);
    const auto moved = std::make_unique<CommonWorkspace<Layout, double, Estimating>>();
    stand(seed, layout, work);
    stand(seed, layout, *moved);
    move(motion, layout, *moved);
    RunStep steps[2];
    for (auto* of : {&work, moved.get()}) {
        of->estimator.initialise(of->belief, filter, layout, 1, {true, {2, -1}, 0.1}, of->truth);
        if (of == &work) move(motion, layout, work);
        RunStep& step = steps[of != &work];
        step.mean = step.truth = mean_of(of->belief, layout.size());
        step.covariance = dense(of->belief, layout.size());
    }
    return state_difference(steps[0], steps[1], MatrixXd::Identity(layout.size(), layout.size()));
}

}  // namespace

TEST_CASE("metamorphic: in a turned and shifted world a trial is the same to rounding, under every estimator") {
    compare(60);
}

TEST_CASE("metamorphic: thousands of trials are the same in turned and shifted worlds", "[long]") { compare(1200); }

TEST_CASE("metamorphic: in a turned and shifted world a first sight is the same to rounding, under every estimator") {
    for (const Estimator estimator : estimators_of(Process::heading))
        with_workspace(Process::heading, estimator,
                       []<class Layout, class Estimating>(Workspace<Layout, double, Estimating>& work) {
                           if constexpr (Layout::has_heading)
                               for (unsigned seed = 0; seed < 100; ++seed) {
                                   // Coordinates of up to 50, standard deviations above 0.1, sums of few terms.
                                   const double found = first_sight_difference<Layout, Estimating>(seed, work);
                                   CAPTURE(seed);
                                   CHECK(found < 1e-12);
                               }
                       });
}

}  // namespace credence::test::rigid_motion_test
