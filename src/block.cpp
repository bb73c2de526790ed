#include <credence/block.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <numeric>

namespace credence {

namespace {

using Octet = std::array<double, octet>;

/// Room for a pack of lanes: doubles from a 64-byte boundary on.
class AlignedBuffer {
public:
    explicit AlignedBuffer(std::size_t size) : bytes_(size * sizeof(double) + alignment) {}
    double* data() {
        void* at = bytes_.data();
        std::size_t space = bytes_.size();
        return static_cast<double*>(std::align(alignment, space - alignment, at, space));
    }

private:
    static constexpr std::size_t alignment = 64;
    std::vector<std::byte> bytes_;
};

/// Eight running sums for each cell, and for each figure's sum over the steps.
struct OctetSums {
    std::vector<Octet> sums, square_sums, run_square_sums;
    OctetSums(std::size_t figures, std::size_t cells) : sums(cells), square_sums(cells), run_square_sums(figures) {}
};

/// Trials simulated before their figures are folded: as many as keep the figures in the cache, in whole octets.
int batch_size(const ProblemView& view) {
    constexpr std::int64_t figure_budget = 1 << 16;
    const std::int64_t figures = static_cast<std::int64_t>(view.figure_count) * (view.poses - 1);
    return static_cast<int>(std::clamp<std::int64_t>(figure_budget / figures / octet, 1, block_size / octet)) * octet;
}

/// Adds one octet's figures, [figure_count, K - 1, 8], those of trials that do not count as zeros.
void fold_figures(const double* figures, std::size_t figure_count, std::size_t steps,
                  const std::array<bool, octet>& counts, OctetSums& folded) {
    for (std::size_t f = 0; f < figure_count; ++f) {
        Octet run_sum{};
        for (std::size_t cell = f * steps; cell < (f + 1) * steps; ++cell)
            for (std::size_t i = 0; i < octet; ++i) {
                const double value = counts[i] ? figures[cell * octet + i] : 0;
                folded.sums[cell][i] += value;
                folded.square_sums[cell][i] += value * value;
                run_sum[i] += value;
            }
        for (std::size_t i = 0; i < octet; ++i) folded.run_square_sums[f][i] += run_sum[i] * run_sum[i];
    }
}

std::vector<double> added_up(const std::vector<Octet>& sums) {
    std::vector<double> totals;
    for (const Octet& eight : sums) totals.push_back(std::accumulate(eight.begin(), eight.end(), 0.0));
    return totals;
}

/// Takes the columns of one trial out of its octet and stores them; returns whether the trial counts.
bool store_trial(const std::vector<Column>& declared, const double* in_octet, std::size_t trial, std::size_t trials,
                 ArmBlock& arm) {
    double own[column_count];
    for (std::size_t c = 0; c < column_count; ++c) own[c] = in_octet[c * octet];
    const bool counts = !fill_failed(declared, own);
    for (std::size_t c = 0; c < column_count; ++c) arm.columns[c * trials + trial] = own[c];
    arm.counted += counts;
    return counts;
}

ArmBlock run_arm(const Problem& problem, Controller controller, std::uint64_t root_seed, std::int64_t first_trial,
                 int trials, SimulateFunction simulate) {
    const ProblemView& view = problem.view();
    const std::vector<Column> declared = trial_columns(problem.scenario());
    const std::size_t figures = static_cast<std::size_t>(view.figure_count),
                      steps = static_cast<std::size_t>(view.poses - 1);
    const std::size_t cells = figures * steps, all = static_cast<std::size_t>(trials);
    const int batch_trials = batch_size(view);
    const std::size_t octets = static_cast<std::size_t>(batch_trials) / octet;
    std::vector<double> columns(octets * column_count * octet), batch_figures(octets * cells * octet);
    AlignedBuffer scratch((column_count + cells) * octet);
    ArmBlock arm{std::vector<double>(column_count * all), {}, {}, {}, 0};
    OctetSums folded(figures, cells);
    for (int done = 0; done < trials; done += batch_trials) {
        const int count = std::min(batch_trials, trials - done);
        simulate(view, {controller, root_seed, first_trial + done, count, columns.data(), batch_figures.data(),
                        scratch.data()});
        for (int first = 0; first < count; first += octet) {
            const std::size_t place = static_cast<std::size_t>(first) / octet;
            std::array<bool, octet> counts{};
            for (int i = 0; i < std::min(octet, count - first); ++i)
                counts[static_cast<std::size_t>(i)] =
                    store_trial(declared, columns.data() + place * column_count * octet + i,
                                static_cast<std::size_t>(done + first + i), all, arm);
            fold_figures(batch_figures.data() + place * cells * octet, figures, steps, counts, folded);
        }
    }
    arm.sums = added_up(folded.sums);
    arm.square_sums = added_up(folded.square_sums);
    arm.run_square_sums = added_up(folded.run_square_sums);
    return arm;
}

}  // namespace

std::int64_t block_count(std::int64_t trials) { return (trials + block_size - 1) / block_size; }

int trials_in_block(std::int64_t trials, std::int64_t index) {
    return static_cast<int>(std::min<std::int64_t>(block_size, trials - index * block_size));
}

Block run_block(const Problem& problem, std::uint64_t root_seed, std::int64_t index, int trials,
                SimulateFunction simulate) {
    Block block{index, trials, {}};
    for (const Arm& arm : arms_of(problem.scenario()))
        block.arms.push_back(run_arm(problem, arm.controller, root_seed, index * block_size, trials, simulate));
    return block;
}

}  // namespace credence
