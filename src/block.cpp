#include <credence/block.hpp>

#include <algorithm>

namespace credence {

namespace {

/// Trials simulated before their figures are folded: as many as keep the figures in the cache.
int batch_size(const ProblemView& view) {
    constexpr std::int64_t figure_budget = 1 << 16;
    const std::int64_t figures = static_cast<std::int64_t>(view.figure_count) * (view.poses - 1);
    return static_cast<int>(std::clamp<std::int64_t>(figure_budget / figures, 1, block_size));
}

void fold_figures(const ProblemView& view, const double* figures, ArmBlock& arm) {
    const int steps = view.poses - 1;
    for (int f = 0; f < view.figure_count; ++f) {
        const std::size_t row = static_cast<std::size_t>(f) * static_cast<std::size_t>(steps);
        double run_sum = 0;
        for (std::size_t k = 0; k < static_cast<std::size_t>(steps); ++k) {
            const double value = figures[row + k];
            arm.sums[row + k] += value;
            arm.square_sums[row + k] += value * value;
            run_sum += value;
        }
        arm.run_square_sums[static_cast<std::size_t>(f)] += run_sum * run_sum;
    }
}

ArmBlock run_arm(const Problem& problem, Controller controller, std::uint64_t root_seed, std::int64_t first_trial,
                 int trials, SimulateFunction simulate) {
    const ProblemView& view = problem.view();
    const std::vector<Column> declared = trial_columns(problem.scenario());
    const std::size_t figures = static_cast<std::size_t>(view.figure_count);
    const std::size_t cells = figures * static_cast<std::size_t>(view.poses - 1);
    ArmBlock arm{std::vector<double>(static_cast<std::size_t>(column_count) * static_cast<std::size_t>(trials)),
                 std::vector<double>(cells), std::vector<double>(cells), std::vector<double>(figures), 0};
    const int batch_trials = batch_size(view);
    std::vector<double> columns(static_cast<std::size_t>(batch_trials) * column_count);
    std::vector<double> batch_figures(static_cast<std::size_t>(batch_trials) * cells);
    for (int done = 0; done < trials; done += batch_trials) {
        const int count = std::min(batch_trials, trials - done);
        simulate(view, {controller, root_seed, first_trial + done, count, columns.data(), batch_figures.data()});
        for (int i = 0; i < count; ++i) {
            double* own = columns.data() + i * column_count;
            const bool trial_failed = fill_failed(declared, own);
            for (std::size_t c = 0; c < column_count; ++c)
                arm.columns[c * static_cast<std::size_t>(trials) + static_cast<std::size_t>(done + i)] = own[c];
            if (trial_failed) continue;
            ++arm.counted;
            fold_figures(view, batch_figures.data() + static_cast<std::size_t>(i) * cells, arm);
        }
    }
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
