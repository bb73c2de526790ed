#pragma once
// A trial that goes on from one of its poses: what it holds there, and the engine's own functions in the order in which
// run_trial calls them.

#include "filter_samples.hpp"

#include "slam/estimators/estimators.hpp"
#include "slam/trial/trial.hpp"

#include <memory>

namespace credence::test {

/// Takes down what a trial holds at one pose, and the commands that it takes.
template <class Layout, class Estimating>
struct Keeper {
    const Workspace<Layout, double, Estimating>& work;
    int pose;
    Layout layout;
    std::unique_ptr<CommonWorkspace<Layout, double, Estimating>> held{};
    std::vector<Command<double>> commands{};  ///< [K - 1]

    void started(const auto&...) { keep(0); }
    void planned(const auto&...) {}
    void predicted(int, const auto&, const auto&, const Command<double>& command, const auto&...) {
        commands.push_back(command);
    }
    void updated(int k, const auto&...) { keep(k); }

private:
    void keep(int k) {
        if (k != pose) return;
        held = std::make_unique<CommonWorkspace<Layout, double, Estimating>>();
        held->truth = work.truth, held->belief = work.belief, held->estimator = work.estimator;
    }
};

/// The poses after the one from which a trial goes on. Its commands and measurements are not written down.
struct Continued {
    Run run;
    std::vector<MatrixXd> innovation;  ///< [K][M, 2], of features in sight or not; body frame
};

template <class Layout, class Estimating>
class Continuation {
public:
    using Work = CommonWorkspace<Layout, double, Estimating>;

    Continuation(const ProblemView& view, const AnyNoise& noise, Work& work)
        : view_(view), noise_(noise), work_(work), layout_(view.features), draws_(layout_),
          by_step_(view.poses - 1, view.series_count) {
        made_.run.steps.resize(static_cast<std::size_t>(view.poses));
        made_.innovation.resize(made_.run.steps.size());
    }

    /// From pose k - 1 to k, as run_trial does it.
    void go_to(int k, const Command<double>& command) {
        auto& [truth, belief, sightings, update, elimination, estimator] = work_;
        RunStep& step = made_.run.steps[static_cast<std::size_t>(k)];
        Vector2<double>* measurement = draws_.template of_features<Source::measurement>();
        draws_.draw(noise_, k);
        shape_tails(view_.sensor, layout_.features(), k, noise_, measurement);
        move_features(truth, view_.world, layout_, k, draws_);
        move_robot(truth, view_.world, command, draws_);
        estimator.predict(belief, view_.filter, layout_, command, truth, k);
        step.prior_mean = mean_of(belief, layout_.size());
        step.prior_covariance = dense(belief, layout_.size());
        look(truth, view_.sensor, layout_, k, measurement, noise_, sightings);
        const auto edge = [&, &at = truth](int e) {
            return measure_edge(at, view_.sensor, view_.filter.edges[e], k, e, noise_);
        };
        const auto linearised = estimator.linearised(belief, layout_, truth);
        gate_sightings(belief, view_.filter, layout_, linearised, sightings);
        keep_measurements(k, linearised);
        estimator.update(belief, view_.filter, layout_, sightings, edge, linearised, update);
        evaluate_step(view_, layout_, belief, truth, update, k, elimination, sums_, outcome_, by_step_.data());
        step.truth = true_state();
        step.mean = mean_of(belief, layout_.size());
        step.covariance = dense(belief, layout_.size());
    }

    Continued finished() {
        made_.run.figures = by_step_.transpose();
        return std::move(made_);
    }

private:
    template <class Linearisation>
    void keep_measurements(int k, const Linearisation& linearised) {
        const auto at = static_cast<std::size_t>(k);
        RunStep& step = made_.run.steps[at];
        step.sigma.resize(layout_.features());
        made_.innovation[at].resize(layout_.features(), 2);
        for (int j = 0; j < layout_.features(); ++j) {
            const auto innovation = rotate_back(linearised.frame, linearised(j, work_.sightings[j]).innovation);
            made_.innovation[at].row(j) << innovation.x, innovation.y;
            step.sigma[j] = work_.sightings[j].sigma;
            step.seen.push_back(work_.sightings[j].seen);
        }
    }

    VectorXd true_state() const {
        const auto& truth = work_.truth;
        VectorXd x(static_cast<Eigen::Index>(layout_.size()));
        if constexpr (Layout::has_heading) x[0] = truth.heading;
        x.segment<2>(Layout::position) << truth.position.x, truth.position.y;
        for (int j = 0; j < layout_.features(); ++j)
            x.segment<2>(Layout::feature(j)) << truth.feature[j].x, truth.feature[j].y;
        return x;
    }

    const ProblemView& view_;
    const AnyNoise& noise_;
    Work& work_;
    Layout layout_;
    WorldDraws<Layout, double> draws_;
    MatrixXd by_step_;  ///< [K - 1, series_count]: Eigen's columns are the engine's rows
    Sums<double> sums_;
    Outcome<double> outcome_;
    Continued made_;
};

/// Goes on from what `work` holds at `pose`, by commands[k - 1] to each pose k after it.
template <class Layout, class Estimating>
Continued continued(const ProblemView& view, const AnyNoise& noise, int pose,
                    const std::vector<Command<double>>& commands, CommonWorkspace<Layout, double, Estimating>& work) {
    Continuation<Layout, Estimating> continuation(view, noise, work);
    for (int k = pose + 1; k < view.poses; ++k) continuation.go_to(k, commands[static_cast<std::size_t>(k - 1)]);
    return continuation.finished();
}

/// A trial up to its end on the fixed path, and what it held at `pose`.
template <class Layout, class Estimating>
Keeper<Layout, Estimating> kept(const ProblemView& view, const AnyNoise& noise, int pose,
                                Workspace<Layout, double, Estimating>& work) {
    Keeper<Layout, Estimating> keeper{work, pose, Layout(view.features)};
    std::vector<double> columns(column_count), series(static_cast<std::size_t>(view.series_count * (view.poses - 1)));
    run_trial(view, Controller::fixed, noise, keeper, work, columns.data(), series.data());
    return keeper;
}

/// Calls use(work), an empty workspace of the estimator.
template <class Use>
void with_workspace(Process process, Estimator estimator, const Use& use) {
    const auto of = [&](auto layout, auto tag) {
        using Layout = decltype(layout);
        using Estimating = typename decltype(tag)::template type<Layout, double>;
        use(*std::make_unique<Workspace<Layout, double, Estimating>>());
    };
    if (process == Process::heading)
        with_estimator<Process::heading>(estimator, [&](auto tag) { of(Layout<Process::heading, any_count>(1), tag); });
    else
        of(Layout<Process::translation, any_count>(1), EstimatorTag<KalmanFilter>{});
}

}  // namespace credence::test
