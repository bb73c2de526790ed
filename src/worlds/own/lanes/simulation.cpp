// Trials of a user's own world in lanes: what the chosen target runs and reads.

#include <credence/detail/draws.hpp>
#include <credence/detail/lanes_of.hpp>
#include "numeric/chi_square.hpp"
#include "numeric/positive_definite.hpp"
#include "scenario/state_series.hpp"
#include "worlds/own/lanes/one_by_one.hpp"
#include "worlds/own/lanes/recorder.hpp"
#include "worlds/own/trial_ends.hpp"
#include "worlds/simulate.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>
#include <new>
#include <stdexcept>
#include <utility>

namespace credence {

void refuse(const LanePack& pack, const char* what) {
    throw WorldMistake("world " + *pack.world + ": " + what + ".");
}

void leave(const LanePack&) { throw TrialEnds(); }

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

/// Room for one trial's results, all of which a batch asks for.
struct OneTrial {
    std::vector<double> columns, sums, square_sums, run_square_sums, nees;
    std::vector<std::int32_t> covered;
    Batch batch;

    OneTrial(const SimulationShape& shape, std::uint64_t root_seed, std::int64_t trial) {
        const auto steps = static_cast<std::size_t>(shape.poses - 1);
        const auto all_series = static_cast<std::size_t>(shape.series_count);
        columns.resize(static_cast<std::size_t>(shape.column_count) * octet);
        sums.resize(all_series * steps * octet);
        square_sums.resize(sums.size());
        run_square_sums.resize(all_series * octet);
        nees.resize(steps * octet);
        covered.resize(static_cast<std::size_t>(shape.group_count) * steps * coverage_level_count);
        batch.root_seed = root_seed;
        batch.first_trial = trial;
        batch.trials = 1;
        batch.columns = columns.data();
        batch.sums = sums.data();
        batch.square_sums = square_sums.data();
        batch.run_square_sums = run_square_sums.data();
        batch.covered = covered.data();
        batch.nees = nees.data();
    }

    /// Of a trial that failed nothing counts but its status.
    void leave_out_what_failed(const std::vector<Column>& declared) {
        std::vector<double> row;
        for (std::size_t c = 0; c < declared.size(); ++c) row.push_back(columns[c * octet]);
        if (!fill_failed(declared, row.data())) return;
        for (std::size_t c = 0; c < declared.size(); ++c) columns[c * octet] = row[c];
        for (std::vector<double>* series : {&sums, &square_sums, &nees}) std::ranges::fill(*series, 0);
    }

    /// Whether the numbers of the trial, which is the first of its octet, are the same bits.
    bool same_as(const OneTrial& other) const {
        for (const auto member : {&OneTrial::columns, &OneTrial::sums, &OneTrial::square_sums, &OneTrial::nees})
            for (std::size_t i = 0; i < (this->*member).size(); i += octet)
                if (std::bit_cast<std::uint64_t>((this->*member)[i]) !=
                    std::bit_cast<std::uint64_t>((other.*member)[i]))
                    return false;
        return true;
    }
};

void run_pack(const OwnView& view, LanePack& pack) {
    if (!call_world(pack, 0, pack.trials, [&] { view.run_world(view.settings, pack); })) return;
    if (pack.steps != view.poses - 1)
        throw WorldMistake("world " + *view.world + ": a trial took " + std::to_string(pack.steps) + " steps, not " +
                           std::to_string(view.poses - 1) + ".");
}

void record_pack(const OwnView& view, LanePack& pack) { view.recorder->run(view, pack, run_pack); }

class LaneSimulation : public Simulation {
public:
    LaneSimulation(const Scenario& scenario, const OwnReport& report, const Target& target, RunPack run,
                   std::shared_ptr<const void> settings)
        : world_(scenario.world),
          arms_(scenario.arms),
          target_(target),
          settings_(std::move(settings)),
          columns_(own_columns(scenario, report)),
          innovations_(report.largest_innovation > 0 ? Innovations::given : Innovations::none),
          all_series_(scenario.components, scenario.groups, innovations_),
          declared_(scenario.groups) {
        for (const ComponentGroup& group : declared_) {
            groups_.push_back({group.first, group.count, group.contiguous() ? nullptr : group.components.data()});
            for (const double level : coverage_levels)
                coverage_bounds_.push_back(stable_chi_square_quantile(level, group.count));
        }
        view_.poses = scenario.poses;
        view_.state_size = static_cast<int>(scenario.components.size());
        view_.group_count = static_cast<int>(groups_.size());
        view_.series_count = static_cast<int>(all_series_.list.size());
        view_.coverage_bounds = coverage_bounds_.data();
        view_.world = &world_;
        view_.largest_innovation = report.largest_innovation;
        view_.column_count = static_cast<int>(columns_.size());
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
        shape_ = {view_.poses, view_.state_size, view_.column_count, view_.series_count, view_.group_count};
    }
    LaneSimulation(const LaneSimulation&) = delete;
    LaneSimulation& operator=(const LaneSimulation&) = delete;

    const SimulationShape& shape() const override { return shape_; }
    std::size_t workspace_size(std::size_t) const override { return target_.own_workspace_size(view_); }
    void simulate(std::size_t arm, const Batch& batch) const override {
        target_.simulate_own(view_of(arm), batch);
    }

    void check_repeats(std::uint64_t root_seed) const override {
        for (std::size_t arm = 0; arm < arms_.size(); ++arm) {
            OneTrial first(shape_, root_seed, 0), second(shape_, root_seed, 0);
            for (OneTrial* one : {&first, &second}) {
                run_one(view_of(arm), *one);
                one->leave_out_what_failed(columns_);
            }
            if (!first.same_as(second))
                throw InputError("cannot run world " + printable(world_) + " (trial 0 of " + printable(arms_[arm]) +
                                 " gives other numbers a second time: of a clock, of another generator, or of what is "
                                 "kept from trial to trial). Draw by trial.normal and trial.uniform alone, and keep "
                                 "nothing.");
        }
    }

    Trajectory replay(const Scenario& scenario, std::size_t arm, std::uint64_t root_seed,
                      std::int64_t trial) const override {
        Trajectory trajectory = empty_trajectory(scenario, scenario.arms[arm], columns_);
        trajectory.source = source_text(root_seed, trial);
        LaneRecorder recorder(view_.largest_innovation, target_.lanes, trajectory);
        OwnView view = view_of(arm);
        view.run = record_pack;
        view.recorder = &recorder;
        OneTrial one(shape_, root_seed, trial);
        run_one(view, one);
        for (std::size_t c = 0; c < columns_.size(); ++c) trajectory.column_values[c] = one.columns[c * octet];
        fill_failed(trajectory.columns, trajectory.column_values.data());
        add_evaluations(trajectory, all_series_, innovations_,
                        [&](std::size_t place) { return recorder.series(place); });
        return trajectory;
    }

private:
    OwnView view_of(std::size_t arm) const {
        OwnView view = view_;
        view.arm = arm;
        view.arm_name = &arms_[arm];
        return view;
    }
    void run_one(const OwnView& view, OneTrial& one) const {
        const std::unique_ptr<std::byte[], AlignedDelete> room(
            new (room_alignment) std::byte[workspace_size(view.arm)]);
        one.batch.workspace = room.get();
        target_.simulate_own(view, one.batch);
    }

    static constexpr std::align_val_t room_alignment{64};  // as a pack of lanes wants it
    struct AlignedDelete {
        void operator()(std::byte* bytes) const { ::operator delete[](bytes, room_alignment); }
    };

    std::string world_;
    std::vector<std::string> arms_;
    Target target_;
    std::shared_ptr<const void> settings_;
    std::vector<Column> columns_;
    Innovations innovations_;
    StateSeries all_series_;
    std::vector<ComponentGroup> declared_;
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
