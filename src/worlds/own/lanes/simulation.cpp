// Trials of a user's own world in lanes: what the chosen target runs and reads.

#include <credence/detail/draws.hpp>
#include <credence/detail/lanes_of.hpp>
#include "engine/octets.hpp"
#include "numeric/decompositions.hpp"
#include "scenario/state_series.hpp"
#include "worlds/counted_trials.hpp"
#include "worlds/own/lanes/one_by_one.hpp"
#include "worlds/own/lanes/recorder.hpp"
#include "worlds/own/trial_ends.hpp"
#include "worlds/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace credence {

void refuse(const LanePack& pack, const char* what) { throw WorldMistake("world " + *pack.world + ": " + what + "."); }

void leave(const LanePack&) { throw TrialEnds(); }

/// Diagonals of P_s by source, [K - 1, n], and of P.
class CountedTrial {
public:
    std::vector<double> of_source[source_count], whole;

    std::vector<double>& of(int source) { return source == whole_of_P ? whole : of_source[source]; }
    bool none() const {
        return std::ranges::all_of(of_source, [](const std::vector<double>& one) { return one.empty(); });
    }
    /// How far they are from adding up to P, relative to it; infinite where steps or sources are left out.
    double rest() const {
        std::vector<double> sum(whole.size());
        for (const std::vector<double>& one : of_source) {
            if (!one.empty() && one.size() != whole.size()) return std::numeric_limits<double>::infinity();
            std::ranges::transform(one, sum, sum.begin(), std::plus());
        }
        double largest = 0;
        for (std::size_t i = 0; i < sum.size(); ++i)
            largest = std::max(largest, std::abs(sum[i] - whole[i]) / whole[i]);
        return largest;
    }
};

int rare_index(const std::string& world, int source, int pose, int index) {
    const auto check = [&](const char* what, int value, int largest) {
        if (value < 0 || value > largest)
            throw WorldMistake("world " + world + ": invalid " + what + " of a draw " + std::to_string(value) +
                               " (must be 0 to " + std::to_string(largest) + ").");
    };
    check("source", source, source_count - 1);
    check("pose", pose, std::numeric_limits<int>::max());
    check("index", index, largest_wide_index);
    return wide_index(index);
}

namespace {

bool positive_definite(const double* matrix, int n) {
    return is_positive_definite(Eigen::Map<const Eigen::MatrixXd>(matrix, n, n),
                                std::numeric_limits<double>::epsilon());
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    const auto bits = [](double number) { return bits_of(number); };
    return std::ranges::equal(a, b, {}, bits, bits);
}

/// Of a trial that failed nothing counts but its status.
bool same_trial(const ArmBlock& a, const ArmBlock& b) {
    return same_bits(a.columns, b.columns) && same_bits(a.sums, b.sums) && same_bits(a.square_sums, b.square_sums) &&
           same_bits(a.moments, b.moments);
}

void run_pack(const OwnView& view, LanePack& pack) {
    if (!call_world(pack, 0, pack.trials, [&] { view.run_world(view.settings, pack); })) return;
    if (pack.steps != view.poses - 1)
        throw WorldMistake("world " + *view.world + ": a trial took " + std::to_string(pack.steps) + " steps, not " +
                           std::to_string(view.poses - 1) + ".");
}

void record_step(LaneRecorder& recorder, const LanePack& pack, const LaneStep& step, bool goes_on) {
    recorder.take(pack, step, goes_on);
}

void count_one(const LanePack& pack, int source, const double* variances, int stride) {
    if (source < whole_of_P || source >= source_count) refuse(pack, "a source that it does not have counts");
    std::vector<double>& to = pack.counted->of(source);
    for (int j = 0; j < pack.state_size; ++j) to.push_back(variances[j * stride]);
}

class LaneSimulation : public Simulation {
public:
    LaneSimulation(const Scenario& scenario, const OwnReport& report, const Target& target, RunPack run,
                   std::shared_ptr<const void> settings)
        : world_(scenario.world),
          arms_(scenario.arms),
          target_(target),
          settings_(std::move(settings)),
          columns_(with_errors(own_columns(scenario, report), scenario.components, scenario.poses - 1, report.budget)),
          innovations_(report.largest_innovation > 0 ? Innovations::given : Innovations::none),
          all_series_(scenario.components, scenario.groups, innovations_),
          declared_(scenario.groups),
          sources_(report.sources),
          coverage_bounds_(coverage_bounds(declared_)) {
        for (const ComponentGroup& group : declared_)
            groups_.push_back({group.first, group.count, group.contiguous() ? nullptr : group.components.data()});
        view_.poses = scenario.poses;
        view_.state_size = static_cast<int>(scenario.components.size());
        view_.group_count = static_cast<int>(groups_.size());
        view_.series_count = static_cast<int>(all_series_.list.size());
        view_.coverage_bounds = coverage_bounds_.data();
        view_.world = &world_;
        view_.largest_innovation = report.largest_innovation;
        set_budget(view_, report.budget);
        view_.column_count = static_cast<int>(columns_.size()) - view_.error_columns();
        view_.own_column_count = static_cast<int>(report.columns.size());
        for (const Column& column : report.columns) whole_.push_back(column.type == ColumnType::integer);
        view_.whole = whole_.data();
        view_.groups = groups_.data();
        view_.nis = static_cast<int>(all_series_.nis);
        view_.squared_error = static_cast<int>(all_series_.squared_error);
        view_.variance = static_cast<int>(all_series_.variance);
        view_.standardised_error = static_cast<int>(all_series_.standardised_error);
        view_.positive_definite = positive_definite;
        view_.run = run_pack;
        view_.settings = settings_.get();
        view_.run_world = run;
        shape_ = {view_.poses, view_.state_size, static_cast<int>(columns_.size()), view_.series_count,
                  view_.group_count};
    }
    LaneSimulation(const LaneSimulation&) = delete;
    LaneSimulation& operator=(const LaneSimulation&) = delete;

    const SimulationShape& shape() const override { return shape_; }
    std::size_t workspace_size(std::size_t) const override { return target_.own_workspace_size(view_); }
    void simulate(std::size_t arm, const Batch& batch) const override { target_.simulate_own(view_of(arm), batch); }

    void check_repeats(std::uint64_t root_seed) const override {
        BlockMemory memory;
        for (std::size_t arm = 0; arm < arms_.size(); ++arm) {
            const auto first = run_arm(*this, columns_, arm, root_seed, 0, 1, memory);
            if (!same_trial(first, run_arm(*this, columns_, arm, root_seed, 0, 1, memory)))
                throw InputError("cannot run world " + printable(world_),
                                 "trial 0 of " + printable(arms_[arm]) + " gives other numbers a second time: of a "
                                 "clock, of another generator, or of what is kept from trial to trial",
                                 "Draw by trial.normal and trial.uniform alone, and keep nothing");
        }
    }

    Trajectory replay(const Scenario& scenario, std::size_t arm, std::uint64_t root_seed,
                      std::int64_t trial) const override {
        Trajectory trajectory = empty_trajectory(scenario, scenario.arms[arm], columns_);
        trajectory.source = source_text(root_seed, trial);
        LaneRecorder recorder(view_, target_.lanes, trajectory);
        OwnView view = view_of(arm);
        view.record = record_step;
        view.recorder = &recorder;
        BlockMemory one;
        one.octets.prepare(shape_, 1, false);
        target_.simulate_own(view, one.octets.batch(root_seed, trial, one.room.of_size(workspace_size(arm))));
        for (std::size_t c = 0; c < columns_.size(); ++c) trajectory.column_values[c] = one.octets.columns[c * octet];
        fill_failed(trajectory.columns, trajectory.column_values.data());
        add_evaluations(trajectory, all_series_, innovations_,
                        [&](std::size_t place) { return recorder.series(place); });
        return trajectory;
    }

    CountedVariances counted(std::size_t arm, std::uint64_t root_seed, std::int64_t trials) const override {
        const auto n = static_cast<std::size_t>(view_.state_size), own = sources_.size();
        CountedVariances mean{sources_, std::vector<std::vector<double>>(own, std::vector<double>(n)), 0};
        BlockMemory one;
        one.octets.prepare(shape_, 1, false);
        for (std::int64_t trial = 0; trial < counted_trials(view_, trials); ++trial) {
            CountedTrial counted;
            OwnView view = view_of(arm);
            view.counted = &counted;
            view.count = count_one;
            target_.simulate_own(view, one.octets.batch(root_seed, trial, one.room.of_size(workspace_size(arm))));
            if (counted.none()) return {};
            if (one.octets.columns[(columns_.size() - 2) * octet] != 0) continue;
            check_rest(counted.rest(), trial,
                       "Give every source at every step, propagated with the filter's own gains");
            ++mean.trials;
            for (std::size_t s = 0; s < own; ++s)
                for (std::size_t j = 0; j < n && !counted.of_source[s].empty(); ++j) {
                    double variance = 0;
                    for (int i = 0; i < view_.kept_count; ++i)
                        variance += counted.of_source[s][static_cast<std::size_t>(view_.kept_steps[i]) * n + j];
                    mean.variance[s][j] += (variance / view_.kept_count - mean.variance[s][j]) /
                                           static_cast<double>(mean.trials);
                }
        }
        return mean;
    }

private:
    OwnView view_of(std::size_t arm) const {
        OwnView view = view_;
        view.arm = arm;
        view.arm_name = &arms_[arm];
        return view;
    }

    std::string world_;
    std::vector<std::string> arms_;
    Target target_;
    std::shared_ptr<const void> settings_;
    std::vector<Column> columns_;
    Innovations innovations_;
    StateSeries all_series_;
    std::vector<ComponentGroup> declared_;
    std::vector<std::string> sources_;
    std::vector<GroupPlace> groups_;       ///< of the declared ones
    std::vector<double> coverage_bounds_;  ///< [groups, levels]
    std::vector<char> whole_;              ///< [own columns]
    OwnView view_;
    SimulationShape shape_;
};

}  // namespace

std::unique_ptr<const Simulation> lane_simulation(const Scenario& scenario, const OwnReport& report,
                                                  const std::vector<LanesOfTarget>& targets,
                                                  std::shared_ptr<const void> settings) {
    const Target target = best_target();
    for (const LanesOfTarget& one : targets)
        if (one.target == target.name && one.run != nullptr)
            return std::make_unique<LaneSimulation>(scenario, report, target, one.run(), std::move(settings));
    return nullptr;
}

std::unique_ptr<const Simulation> own_simulation(const Scenario& scenario, const OwnReport& report,
                                                 std::function<void(OwnTrial&)> run) {
    const Target target = best_target();
    auto one_by_one = std::make_shared<const OneByOne>(OneByOne{std::move(run), target.lanes});
    return std::make_unique<LaneSimulation>(scenario, report, target, run_one_by_one, std::move(one_by_one));
}

}  // namespace credence
