#pragma once
// Trials of a world of SLAM that are run one by one: to record one, or to find what P counts for each source.

#include <credence/detail/world.hpp>

#include "engine/octets.hpp"
#include "slam/estimators/attributed.hpp"
#include "worlds/counted_trials.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace credence {

/// The parts of the filter's noises: `first_features` is the source of the first estimates of features.
inline std::vector<CountedSource> counted_sources(const FilterParameters& filter, double share_of_walk,
                                                  const std::string& first_features) {
    FilterParameters none = filter;
    none.variance_heading = none.variance_odometry = none.variance_feature = none.variance_edge = 0;
    none.variance_initial_heading = none.variance_initial_position = none.measurement_factor = 0;
    std::vector<CountedSource> sources;
    const auto add = [&](const std::string& name, auto&& set) {
        sources.push_back({name, none, name == "start", name == first_features});
        set(sources.back().filter);
    };
    add("start", [](FilterParameters&) {});
    add("odometry", [&](FilterParameters& own) { own.variance_odometry = filter.variance_odometry; });
    add("heading", [&](FilterParameters& own) { own.variance_heading = filter.variance_heading; });
    add("measurement", [&](FilterParameters& own) { own.measurement_factor = filter.measurement_factor; });
    add("walk", [&](FilterParameters& own) { own.variance_feature = share_of_walk * filter.variance_feature; });
    add("deformation",
        [&](FilterParameters& own) { own.variance_feature = (1 - share_of_walk) * filter.variance_feature; });
    if (filter.edge_count > 0) add("edges", [&](FilterParameters& own) { own.variance_edge = filter.variance_edge; });
    return sources;
}

inline namespace CREDENCE_TARGET {

/// Adds up the parts of one trial at the steps that its scenario keeps, and how far their sum is from P.
template <class Attributing>
class PartsOfTrial {
public:
    PartsOfTrial(const CommonView& view, const Attributing& estimator, CountedVariances& sum)
        : view_(view), estimator_(estimator), sum_(sum) {}

    template <class Layout, class Belief>
    void updated(int k, const Layout& layout, const Belief& belief) {
        const auto& P = belief.covariance;
        const int n = layout.size();
        for (int i = 0; i < n; ++i)
            for (int j = i; j < n; ++j) {
                double rest = P.entry[i][j];
                for (const auto& part : estimator_.parts()) rest -= part.covariance.entry[i][j];
                largest_rest_ = std::max(largest_rest_, std::abs(rest) / std::sqrt(P.entry[i][i] * P.entry[j][j]));
            }
        if (std::find(view_.kept_steps, view_.kept_steps + view_.kept_count, k - 1) ==
            view_.kept_steps + view_.kept_count)
            return;
        const double factor = view_.filter.covariance_factor / view_.kept_count;
        for (int i = 0; i < n; ++i) {
            if (P.entry[i][i] <= view_.growth.absent_variance) continue;
            ++there_[static_cast<std::size_t>(i)];
            for (std::size_t s = 0; s < estimator_.parts().size(); ++s)
                sum_.variance[s][static_cast<std::size_t>(i)] +=
                    factor * estimator_.parts()[s].covariance.entry[i][i];
        }
    }
    /// The largest |P - sum of P_s| of an entry, relative to the standard deviations of its components.
    double largest_rest() const { return largest_rest_; }
    /// The share of the steps at which component i is in the state.
    double there(std::size_t i) const { return 1.0 * there_[i] / view_.kept_count; }

private:
    const CommonView& view_;
    const Attributing& estimator_;
    CountedVariances& sum_;
    std::vector<int> there_ = std::vector<int>(static_cast<std::size_t>(view_.state_size));
    double largest_rest_ = 0;
};

/// The observer of single trials: the recorder of a trajectory, or where there is none the sums of the parts of P. One
/// type serves both, since the templates of a trial take long to compile.
template <class Recorder, class Attributing>
struct SingleObserver {
    Recorder* recorder = nullptr;
    PartsOfTrial<Attributing>* parts = nullptr;

#define CREDENCE_RECORDED(happened)                                  \
    template <class... Seen>                                         \
    void happened(const Seen&... seen) {                             \
        if (recorder != nullptr) recorder->happened(seen...);        \
    }
    CREDENCE_RECORDED(started)
    CREDENCE_RECORDED(planned)
    CREDENCE_RECORDED(priced)
    CREDENCE_RECORDED(explored)
    CREDENCE_RECORDED(predicted)
#undef CREDENCE_RECORDED
    template <class Layout, class Belief>
    void updated(int k, const Layout& layout, const Belief& belief, const double* all_series) {
        if (recorder != nullptr)
            recorder->updated(k, layout, belief, all_series);
        else
            parts->updated(k, layout, belief);
    }
};

/// The noise of a single trial, and its commands where a planner of one's own has chosen them.
template <class Draws>
struct TrialInputs {
    Draws draws;
    std::vector<Command<double>> commands;  ///< [K - 1] or none
};

/// Single trials of an arm. `Work`: the workspace of its world, whose estimator is Attributed.
template <class Recorder, class View, class Controller, class Work>
class SingleTrials {
public:
    SingleTrials(const View& view, Controller controller, std::unique_ptr<Work> work)
        : view_(view), controller_(controller), work_(std::move(work)),
          all_series_(static_cast<std::size_t>(view.series_count) * static_cast<std::size_t>(view.poses - 1)) {}

    template <class Draws>
    void record(const TrialInputs<Draws>& inputs, Recorder& recorder, double* columns) {
        run(inputs, {&recorder, nullptr}, columns);
    }

    /// What P counts: the mean over the first trials that complete, of a component over the steps at which it is in the
    /// state. A trial has so many columns, the status the last but one; `inputs_of(trial)` gives its inputs.
    template <class InputsOf>
    CountedVariances count(const std::vector<CountedSource>& sources, std::int64_t trials, int column_count,
                           const InputsOf& inputs_of) {
        const auto n = static_cast<std::size_t>(view_.state_size);
        CountedVariances none{{}, std::vector<std::vector<double>>(sources.size(), std::vector<double>(n)), 0},
            mean = none;
        for (const CountedSource& source : sources) mean.sources.push_back(source.name);
        std::vector<double> columns(static_cast<std::size_t>(column_count)), there(n);
        for (std::int64_t trial = 0; trial < counted_trials(view_, trials); ++trial) {
            CountedVariances one = none;
            work_->estimator.attribute(sources);
            PartsOfTrial<Attributing> parts(view_, work_->estimator, one);
            run(inputs_of(trial), {nullptr, &parts}, columns.data());
            if (columns.end()[-2] != 0) continue;
            check_rest(parts.largest_rest(), trial,
                       "An estimator may not condition P by take_in and turn_covariance alone");
            ++mean.trials;
            for (std::size_t i = 0; i < n; ++i) {
                const double share = parts.there(i);
                if (share == 0) continue;
                there[i] += share;
                for (std::size_t s = 0; s < sources.size(); ++s)
                    mean.variance[s][i] += (one.variance[s][i] - share * mean.variance[s][i]) / there[i];
            }
        }
        return mean;
    }

private:
    using Attributing = decltype(Work::estimator);
    using Observer = SingleObserver<Recorder, Attributing>;

    template <class Draws>
    void run(const TrialInputs<Draws>& inputs, Observer observer, double* columns) {
        run_trial(view_, controller_, inputs.draws, observer, *work_, columns, all_series_.data(),
                  inputs.commands.empty() ? nullptr : inputs.commands.data());
    }

    const View& view_;
    Controller controller_;
    std::unique_ptr<Work> work_;
    std::vector<double> all_series_;
};

}  // namespace CREDENCE_TARGET

/// The commands [K - 1] that a planner of one's own chooses in one trial, by functions of a target; none of other arms,
/// whose planner is -1.
template <class View, class Arm>
std::vector<Command<double>> commands_of(std::size_t (*workspace_size)(const View&, const Arm&),
                                         void (*simulate)(const View&, const Arm&, const Batch&), const View& problem,
                                         const Arm& arm, std::uint64_t root_seed, std::int64_t trial) {
    std::vector<Command<double>> commands;
    if (arm.planner < 0) return commands;
    WorkRoom room;
    std::vector<Control> controls(static_cast<std::size_t>(problem.poses - 1));
    Batch batch;
    batch.root_seed = root_seed;
    batch.first_trial = trial;
    batch.trials = 1;
    batch.workspace = room.of_size(workspace_size(problem, arm));
    batch.commands = controls.data();
    simulate(problem, arm, batch);
    for (const Control& control : controls) commands.push_back(command_from<double>(control));
    return commands;
}

}  // namespace credence
