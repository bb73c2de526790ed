#pragma once
// The memory that a simulation's batch reads and fills.

#include <credence/columns.hpp>
#include <credence/detail/block.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <vector>

namespace credence {

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

/// Running sums by eight, of the sizes of SeriesSums times eight but for `covered`.
inline void clear_sums(SeriesSums& of, std::size_t all_series, std::size_t groups, std::size_t steps) {
    of.sums.assign(all_series * steps * octet, 0);
    of.square_sums.assign(of.sums.size(), 0);
    of.run_square_sums.assign(all_series * octet, 0);
    of.covered.assign(groups * steps * coverage_level_count, 0);
}

inline RunningSums pointers_to(SeriesSums& of) {
    return {of.sums.data(), of.square_sums.data(), of.run_square_sums.data(), of.covered.data()};
}

/// What a unit fills, eight trials next to each other. Kept from block to block; what a unit adds to begins at 0.
struct Octets {
    SeriesSums counted, diverged;  ///< the second is empty until a trial diverges
    std::size_t trials = 0, padded = 0, steps = 0, components = 0, moment_count = 0;
    bool detail = false;
    std::size_t all_series = 0, groups = 0;
    std::vector<double> columns, nees;
    std::vector<double> errors, moments, product_sums, product_square_sums, product_counts;

    void prepare(const SimulationShape& shape, std::size_t count, bool detailed) {
        all_series = static_cast<std::size_t>(shape.series_count);
        groups = static_cast<std::size_t>(shape.group_count);
        trials = count;
        padded = (count + octet - 1) / octet * octet;
        steps = static_cast<std::size_t>(shape.poses - 1);
        components = static_cast<std::size_t>(shape.state_size);
        detail = detailed;
        columns.resize(padded * static_cast<std::size_t>(shape.column_count));
        nees.resize(steps * padded);
        clear_sums(counted, all_series, groups, steps);
        diverged = {};
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

    /// Room for the sums of diverged trials, made with the first of them.
    static RunningSums of_diverged(void* owner) {
        Octets& own = *static_cast<Octets*>(owner);
        if (own.diverged.sums.empty()) clear_sums(own.diverged, own.all_series, own.groups, own.steps);
        return pointers_to(own.diverged);
    }

    Batch batch(std::uint64_t root_seed, std::int64_t first_trial, void* workspace) {
        Batch batch{pointers_to(counted), root_seed, first_trial, static_cast<int>(trials)};
        batch.of_diverged = of_diverged;
        batch.owner = this;
        batch.columns = columns.data();
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

/// The memory in which one thread computes a block.
struct BlockMemory {
    Octets octets;
    WorkRoom room;
};

/// One arm's part of a block [block.hpp, run_block].
ArmBlock run_arm(const Simulation& simulation, const std::vector<Column>& columns, std::size_t a,
                 std::uint64_t root_seed, std::int64_t index, int trials, BlockMemory& memory);

/// Throws InputError where trials of an arm of that name give other numbers a second time, in other company: those of a
/// planner of one's own.
void check_planner_repeats(const Simulation& simulation, std::size_t arm, const std::string& name,
                           std::uint64_t root_seed);

}  // namespace credence
