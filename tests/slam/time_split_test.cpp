// Time that is split: a trial that goes on from one of its poses is the whole trial. All that it needs there is the
// truth, the belief, the estimator's own state, and the draws of the poses to come. (step_parts_test.cpp splits a
// step.)

#include "catch.hpp"
#include "continued.hpp"
#include "metamorphic.hpp"

namespace credence::test::time_split_test {

namespace {

/// Whether the poses after `pose` have the same bits.
bool same_after(int pose, const Run& run, const Run& other) {
    bool same = true;
    for (std::size_t k = static_cast<std::size_t>(pose) + 1; k < run.steps.size(); ++k)
        same = same && same_bits(MatrixXd(run.steps[k].mean), MatrixXd(other.steps[k].mean)) &&
               same_bits(run.steps[k].covariance, other.steps[k].covariance);
    const Eigen::Index later = run.figures.cols() - pose;
    return same && same_bits(MatrixXd(run.figures.rightCols(later)), MatrixXd(other.figures.rightCols(later)));
}

/// The world with everything that a trial may remember or draw.
DeformableSettings eventful(const std::string& process, const std::string& deformation) {
    return scenario_with({{"model.process", process}, {"truth.deformation", deformation}, {"scenario.poses", "12"},
                          {"features.path", "circle"}, {"features.sway_amplitude", "0.4"}, {"sensor.detection", "0.8"},
                          {"sensor.every", "2"}, {"truth.edge_noise", "independent"}, {"noise.odometry_bias", "0.05"},
                          {"noise.measurement_tails", "student"}, {"filter.gate", "0.99"}, {"noise.heading", "0.05"}});
}

/// Compares a trial with itself, continued from each of its poses with its estimator, or with one that starts there.
/// Returns the number of poses from which the bits are the same.
int same_continuations(const DeformableSettings& scenario, Estimator estimator, bool anew) {
    const Problem problem(scenario);
    const ProblemView& view = problem.view();
    const AnyNoise noise = keyed_noise(scenario, 9, 0);
    const Run run = run_arm(scenario, Arm{Controller::fixed, estimator}, noise, Form::any_number);
    int same = 0;
    with_workspace(scenario.process, estimator, [&](auto& work) {
        for (int pose = 0; pose < view.poses - 1; ++pose) {
            const auto start = kept(view, noise, pose, work);
            if (anew) start.held->estimator.start(start.layout, start.held->belief, start.held->truth);
            same += same_after(pose, run, continued(view, noise, pose, start.commands, *start.held).run);
        }
    });
    return same;
}

}  // namespace

TEST_CASE("time split: a trial goes on from every pose with the same bits") {
    for (const char* deformation : {"jitter", "walk"})
        for (const char* process : {"heading", "translation"}) {
            const DeformableSettings scenario = eventful(process, deformation);
            for (const Estimator estimator : estimators_of(scenario.process)) {
                CAPTURE(deformation, estimator);
                CHECK(same_continuations(scenario, estimator, false) == 11);
                // One that starts there goes on alike, but for the first estimates, which no belief holds.
                const int anew = same_continuations(scenario, estimator, true);
                CHECK((estimator == Estimator::fej ? anew < 11 : anew == 11));
            }
        }
}

}  // namespace credence::test::time_split_test
