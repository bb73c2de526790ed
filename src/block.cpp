#include <credence/block.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>
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
    std::vector<double> totals;
    for (std::size_t at = 0; at < octets.size(); at += octet)
        totals.push_back(std::accumulate(octets.data() + at, octets.data() + at + octet, 0.0));
    return totals;
}

/// Takes the columns out of their octets and fills those of failed trials.
void store_columns(const std::vector<Column>& declared, const std::vector<double>& octets, std::size_t trials,
                   ArmBlock& arm) {
    for (std::size_t trial = 0; trial < trials; ++trial) {
        const double* in_octet = octets.data() + trial / octet * column_count * octet + trial % octet;
        double own[column_count];
        for (std::size_t c = 0; c < column_count; ++c) own[c] = in_octet[c * octet];
        arm.counted += !fill_failed(declared, own);
        for (std::size_t c = 0; c < column_count; ++c) arm.columns[c * trials + trial] = own[c];
    }
}

ArmBlock run_arm(const Problem& problem, Controller controller, std::uint64_t root_seed, std::int64_t first_trial,
                 int trials, const Unit& unit) {
    const ProblemView& view = problem.view();
    const std::size_t figures = static_cast<std::size_t>(view.figure_count),
                      cells = figures * static_cast<std::size_t>(view.poses - 1),
                      all = static_cast<std::size_t>(trials);
    std::vector<double> columns((all + octet - 1) / octet * column_count * octet);
    std::vector<double> sums(cells * octet), square_sums(cells * octet), run_square_sums(figures * octet);
    thread_local WorkRoom room;
    unit.simulate(view, {controller, root_seed, first_trial, trials, columns.data(), sums.data(), square_sums.data(),
                         run_square_sums.data(), room.of_size(unit.workspace_size(view))});
    ArmBlock arm{std::vector<double>(column_count * all), added_up(sums), added_up(square_sums),
                 added_up(run_square_sums), 0};
    store_columns(trial_columns(problem.scenario()), columns, all, arm);
    return arm;
}

}  // namespace

std::int64_t block_count(std::int64_t trials) { return (trials + block_size - 1) / block_size; }

int trials_in_block(std::int64_t trials, std::int64_t index) {
    return static_cast<int>(std::min<std::int64_t>(block_size, trials - index * block_size));
}

Block run_block(const Problem& problem, std::uint64_t root_seed, std::int64_t index, int trials,
                const Unit& unit) {
    Block block{index, trials, {}};
    for (const Arm& arm : arms_of(problem.scenario()))
        block.arms.push_back(run_arm(problem, arm.controller, root_seed, index * block_size, trials, unit));
    return block;
}

}  // namespace credence
