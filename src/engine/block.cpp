#include <credence/detail/block.hpp>

#include "engine/octets.hpp"
#include "numeric/chi_square.hpp"

#include <credence/error.hpp>
#include <credence/text.hpp>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <numeric>

namespace credence {

namespace {

/// Adds up the eight running sums of each cell, in order.
std::vector<double> added_up(const std::vector<double>& octets) {
    std::vector<double> totals(octets.size() / octet);
    const double* at = octets.data();
    for (double& total : totals) {
        total = std::accumulate(at, at + octet, 0.0);
        at += octet;
    }
    return totals;
}

SeriesSums added_up(const SeriesSums& octets) {
    return {added_up(octets.sums), added_up(octets.square_sums), added_up(octets.run_square_sums), octets.covered};
}

/// Takes the columns out of their octets and fills those of failed trials.
void store_columns(const std::vector<Column>& declared, const std::vector<double>& octets, std::size_t trials,
                   ArmBlock& arm) {
    const std::size_t count = declared.size();
    std::vector<double> own(count);
    arm.columns.resize(count * trials);
    for (std::size_t trial = 0; trial < trials; ++trial) {
        const double* in_octet = octets.data() + trial / octet * count * octet + trial % octet;
        for (std::size_t c = 0; c < count; ++c) own[c] = in_octet[c * octet];
        arm.counted += !fill_failed(declared, own.data());
        for (std::size_t c = 0; c < count; ++c) arm.columns[c * trials + trial] = own[c];
    }
}

/// How the trials ended: [trials].
std::vector<Status> statuses_of(const std::vector<Column>& declared, const ArmBlock& arm, std::size_t trials) {
    const double* status = arm.columns.data() + status_column(declared) * trials;
    std::vector<Status> all(trials);
    for (std::size_t trial = 0; trial < trials; ++trial)
        all[trial] = static_cast<Status>(static_cast<int>(status[trial]));
    return all;
}

/// The cell of every NEES.
void store_cells(const Octets& from, const EquiprobableCells& cells, const std::vector<Status>& statuses,
                 ArmBlock& arm) {
    arm.cells.resize(from.steps * from.trials);
    const EquiprobableCells::Search search = cells.search();
    std::uint16_t* next = arm.cells.data();
    for (std::size_t k = 0; k < from.steps; ++k)
        for (std::size_t trial = 0; trial < from.trials; ++trial)
            if (const double nees = from.nees[k * from.padded + trial]; std::isnan(nees))
                *next++ = no_cell;  // of a state that is there in part
            else
                *next++ = static_cast<std::uint16_t>(search.cell(nees));
    for (std::size_t trial = 0; trial < from.trials; ++trial)
        if (!counts(statuses[trial]))
            for (std::size_t k = 0; k < from.steps; ++k) arm.cells[k * from.trials + trial] = no_cell;
}

/// Errors and NEES by trial, rounded to single precision, and moments.
void store_details(const Octets& from, const std::vector<Status>& statuses, ArmBlock& arm) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    arm.moments.reserve(from.trials * from.moment_count);
    arm.nees.reserve(from.trials * from.steps);
    arm.errors.reserve(from.trials * from.steps * from.components);
    for (std::size_t trial = 0; trial < from.trials; ++trial) {
        const bool is_failed = failed(statuses[trial]);
        for (std::size_t k = 0; k < from.steps; ++k) {
            arm.nees.push_back(is_failed ? nan : static_cast<float>(from.nees[k * from.padded + trial]));
            for (std::size_t i = 0; i < from.components; ++i)
                arm.errors.push_back(
                    is_failed ? nan : static_cast<float>(from.errors[(i * from.steps + k) * from.padded + trial]));
        }
        for (std::size_t i = 0; i < from.moment_count; ++i)
            arm.moments.push_back(is_failed ? double{nan} : from.moments[i * from.padded + trial]);
    }
    arm.product_sums = added_up(from.product_sums);
    arm.product_square_sums = added_up(from.product_square_sums);
    arm.product_counts = added_up(from.product_counts);
}

/// The workspaces of all threads, kept from block to block. (These are not thread_local objects: glibc ends the process
/// where it cannot allocate the record of a thread_local destructor.)
class Workspaces {
public:
    /// A workspace that no other thread has until the returned pointer is destroyed. Throws std::bad_alloc.
    auto take() {
        const auto put_back = [this](BlockMemory* workspace) {
            const std::lock_guard lock(mutex_);
            free_.emplace_back(workspace);  // within the capacity that take() has reserved
        };
        const std::lock_guard lock(mutex_);
        if (free_.empty()) {
            free_.reserve(made_ + 1);
            free_.push_back(std::make_unique<BlockMemory>());
            ++made_;
        }
        std::unique_ptr<BlockMemory, decltype(put_back)> taken(free_.back().release(), put_back);
        free_.pop_back();
        return taken;
    }

    void clear() {
        const std::lock_guard lock(mutex_);
        made_ -= free_.size();
        free_.clear();
    }

private:
    std::mutex mutex_;
    std::size_t made_ = 0;
    std::vector<std::unique_ptr<BlockMemory>> free_;
};

/// Never destroyed, because a thread may still compute when the process ends.
Workspaces& workspaces() {
    static Workspaces& all = *new Workspaces;
    return all;
}

}  // namespace

bool detailed(const SimulationShape& shape, std::int64_t index) {
    static_assert(block_size == 256, "detailed_trials counts whole blocks");
    return index < detailed_trials(shape.poses - 1, shape.state_size) / block_size;
}

ArmBlock run_arm(const Simulation& simulation, const std::vector<Column>& columns, std::size_t a,
                 std::uint64_t root_seed, std::int64_t index, int trials, BlockMemory& memory) {
    const auto start = std::chrono::steady_clock::now();
    const SimulationShape& shape = simulation.shape();
    Octets& octets = memory.octets;
    octets.prepare(shape, static_cast<std::size_t>(trials), detailed(shape, index));
    void* room = memory.room.of_size(simulation.workspace_size(a));
    simulation.simulate(a, octets.batch(root_seed, index * block_size, room));
    ArmBlock arm;
    static_cast<SeriesSums&>(arm) = added_up(octets.counted);
    arm.diverged = added_up(octets.diverged);
    store_columns(columns, octets.columns, octets.trials, arm);
    const std::vector<Status> statuses = statuses_of(columns, arm, octets.trials);
    if (distribution_counted(shape.poses - 1))
        store_cells(octets, *equiprobable_cells(shape.state_size), statuses, arm);
    if (detailed(shape, index)) store_details(octets, statuses, arm);
    arm.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return arm;
}

Block run_block(const Simulation& simulation, const std::vector<Column>& columns, std::size_t arms,
                std::uint64_t root_seed, std::int64_t index, int trials) {
    Block block{index, trials, {}};
    const auto workspace = workspaces().take();
    for (std::size_t a = 0; a < arms; ++a)
        block.arms.push_back(run_arm(simulation, columns, a, root_seed, index, trials, *workspace));
    return block;
}

void check_planner_repeats(const Simulation& simulation, std::size_t arm, const std::string& name,
                           std::uint64_t root_seed) {
    constexpr std::size_t all = 64, some = 32;
    static_assert(some % octet == 0);
    BlockMemory memory;
    const auto columns_of = [&](std::size_t trials) {
        memory.octets.prepare(simulation.shape(), trials, false);
        void* room = memory.room.of_size(simulation.workspace_size(arm));
        simulation.simulate(arm, memory.octets.batch(root_seed, 0, room));
        return memory.octets.columns;
    };
    const std::vector<double> first = columns_of(all), again = columns_of(some);
    const std::size_t count = static_cast<std::size_t>(simulation.shape().column_count);
    for (std::size_t i = 0; i < some * count; ++i)
        if (std::bit_cast<std::uint64_t>(first[i]) != std::bit_cast<std::uint64_t>(again[i]))
            throw InputError("cannot run " + printable(name),
                             "trial " + std::to_string(i / (octet * count) * octet + i % octet) +
                                 " goes another way a second time, beside other trials",
                             "Let the planner choose by what it is told of each trial alone, and draw its numbers from "
                             "what it is given");
}

void free_workspaces() { workspaces().clear(); }

BlockRunner::BlockRunner(const World& world, const Scenario& scenario)
    : columns_(world.columns(scenario)), arms_(scenario.arms.size()), simulation_(world.simulation(scenario)) {}

Block BlockRunner::run(std::uint64_t root_seed, std::int64_t index, int trials) const {
    return run_block(*simulation_, columns_, arms_, root_seed, index, trials);
}

}  // namespace credence
