#include <credence/detail/block.hpp>

#include "numeric/chi_square.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>
#include <memory>
#include <mutex>
#include <new>
#include <numeric>

namespace credence {

namespace {

/// Room for a unit, from a 64-byte boundary on as a pack of lanes wants it. It is kept from block to block, and what a
/// trial does not touch of it is never paid for.
class WorkRoom {
public:
    void* of_size(std::size_t size) {
        if (size > size_) {
            bytes_.reset(new (alignment) std::byte[size]);
            size_ = size;
        }
        return bytes_.get();
    }

private:
    static constexpr std::align_val_t alignment{64};
    struct Release {
        void operator()(std::byte* bytes) const { ::operator delete[](bytes, alignment); }
    };
    std::unique_ptr<std::byte[], Release> bytes_;
    std::size_t size_ = 0;
};

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

/// What a unit fills, eight trials next to each other. Kept from block to block; what a unit adds to begins at 0.
struct Octets {
    std::size_t trials = 0, padded = 0, steps = 0, components = 0, moment_count = 0;
    bool detail = false;
    std::vector<double> columns, sums, square_sums, run_square_sums, nees;
    std::vector<std::int32_t> covered;
    std::vector<double> errors, moments, product_sums, product_square_sums, product_counts;

    void prepare(const SimulationShape& shape, std::size_t count, bool detailed) {
        const auto all_series = static_cast<std::size_t>(shape.series_count);
        const auto blocks = static_cast<std::size_t>(shape.group_count);
        trials = count;
        padded = (count + octet - 1) / octet * octet;
        steps = static_cast<std::size_t>(shape.poses - 1);
        components = static_cast<std::size_t>(shape.state_size);
        detail = detailed;
        columns.resize(padded * static_cast<std::size_t>(shape.column_count));
        nees.resize(steps * padded);
        sums.assign(all_series * steps * octet, 0);
        square_sums.assign(sums.size(), 0);
        run_square_sums.assign(all_series * octet, 0);
        covered.assign(blocks * steps * coverage_level_count, 0);
        if (!detail) {
            errors = moments = std::vector<double>();  // much room, and seldom wanted; {} would keep it
            return;
        }
        errors.resize(components * steps * padded);
        moment_count = static_cast<std::size_t>(credence::moment_count(shape.state_size, shape.group_count));
        moments.resize(moment_count * padded);
        for (auto* products : {&product_sums, &product_square_sums, &product_counts})
            products->assign(static_cast<std::size_t>(lag_count(shape.poses)) * octet, 0);
    }

    Batch batch(std::uint64_t root_seed, std::int64_t first_trial, void* workspace) {
        Batch batch{root_seed, first_trial, static_cast<int>(trials)};
        batch.columns = columns.data();
        batch.sums = sums.data();
        batch.square_sums = square_sums.data();
        batch.run_square_sums = run_square_sums.data();
        batch.covered = covered.data();
        batch.nees = nees.data();
        batch.errors = detail ? errors.data() : nullptr;
        batch.moments = detail ? moments.data() : nullptr;
        batch.product_sums = product_sums.data();
        batch.product_square_sums = product_square_sums.data();
        batch.product_counts = product_counts.data();
        batch.workspace = workspace;
        return batch;
    }
};

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
            *next++ = static_cast<std::uint16_t>(search.cell(from.nees[k * from.padded + trial]));
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

/// The memory in which one thread computes a block.
struct Workspace {
    Octets octets;
    WorkRoom room;
};

/// The workspaces of all threads, kept from block to block. (These are not thread_local objects: glibc ends the process
/// where it cannot allocate the record of a thread_local destructor.)
class Workspaces {
public:
    /// A workspace that no other thread has until the returned pointer is destroyed. Throws std::bad_alloc.
    auto take() {
        const auto put_back = [this](Workspace* workspace) {
            const std::lock_guard lock(mutex_);
            free_.emplace_back(workspace);  // within the capacity that take() has reserved
        };
        const std::lock_guard lock(mutex_);
        if (free_.empty()) {
            free_.reserve(made_ + 1);
            free_.push_back(std::make_unique<Workspace>());
            ++made_;
        }
        std::unique_ptr<Workspace, decltype(put_back)> taken(free_.back().release(), put_back);
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
    std::vector<std::unique_ptr<Workspace>> free_;
};

/// Never destroyed, because a thread may still compute when the process ends.
Workspaces& workspaces() {
    static Workspaces& all = *new Workspaces;
    return all;
}

ArmBlock run_arm(const Simulation& simulation, const std::vector<Column>& columns, std::size_t a,
                 std::uint64_t root_seed, std::int64_t index, int trials, Workspace& workspace) {
    const auto start = std::chrono::steady_clock::now();
    const SimulationShape& shape = simulation.shape();
    Octets& octets = workspace.octets;
    octets.prepare(shape, static_cast<std::size_t>(trials), detailed(shape, index));
    void* room = workspace.room.of_size(simulation.workspace_size(a));
    simulation.simulate(a, octets.batch(root_seed, index * block_size, room));
    ArmBlock arm;
    arm.sums = added_up(octets.sums);
    arm.square_sums = added_up(octets.square_sums);
    arm.run_square_sums = added_up(octets.run_square_sums);
    arm.covered = octets.covered;
    store_columns(columns, octets.columns, octets.trials, arm);
    const std::vector<Status> statuses = statuses_of(columns, arm, octets.trials);
    if (distribution_counted(shape.poses - 1))
        store_cells(octets, *equiprobable_cells(shape.state_size), statuses, arm);
    if (detailed(shape, index)) store_details(octets, statuses, arm);
    arm.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return arm;
}

}  // namespace

bool detailed(const SimulationShape& shape, std::int64_t index) {
    static_assert(block_size == 256, "detailed_trials counts whole blocks");
    return index < detailed_trials(shape.poses - 1, shape.state_size) / block_size;
}

Block run_block(const Simulation& simulation, const std::vector<Column>& columns, std::size_t arms,
                std::uint64_t root_seed, std::int64_t index, int trials) {
    Block block{index, trials, {}};
    const auto workspace = workspaces().take();
    for (std::size_t a = 0; a < arms; ++a)
        block.arms.push_back(run_arm(simulation, columns, a, root_seed, index, trials, *workspace));
    return block;
}

void free_workspaces() { workspaces().clear(); }

BlockRunner::BlockRunner(const World& world, const Scenario& scenario)
    : columns_(world.columns(scenario)), arms_(scenario.arms.size()), simulation_(world.simulation(scenario)) {}

Block BlockRunner::run(std::uint64_t root_seed, std::int64_t index, int trials) const {
    return run_block(*simulation_, columns_, arms_, root_seed, index, trials);
}

}  // namespace credence
