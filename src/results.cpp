#include <credence/results.hpp>

#include <credence/chi_square.hpp>

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>

namespace credence {

namespace {

void add_figure(FigureTotals& totals, const Figure& figure, const ArmBlock& from, std::size_t f, std::size_t steps,
                double sign) {
    totals.run_square_sum.add(sign * from.run_square_sums[f]);
    for (std::size_t k = 0; k < steps; ++k) {
        totals.sum[k].add(sign * from.sums[f * steps + k]);
        if (!figure.integer) totals.square_sum[k].add(sign * from.square_sums[f * steps + k]);
    }
}

void add_coverage(FigureTotals& totals, const std::int32_t* covered, std::int64_t sign) {
    for (std::size_t i = 0; i < totals.covered.size(); ++i) totals.covered[i] += sign * covered[i];
}

void add_cells(ArmResults& to, const ArmBlock& from, std::size_t trials, std::int64_t sign) {
    for (std::size_t i = 0; i < from.cells.size(); ++i)
        if (from.cells[i] != no_cell) to.cells[i / trials * shape_cells + from.cells[i]] += sign;
}

void add_products(ProductTotals& to, const ArmBlock& from, double sign) {
    for (std::size_t lag = 0; lag < from.product_sums.size(); ++lag) {
        to.sum[lag].add(sign * from.product_sums[lag]);
        to.square_sum[lag].add(sign * from.product_square_sums[lag]);
        to.count[lag] += static_cast<std::int64_t>(sign * from.product_counts[lag]);
    }
}

void add_scaled_totals(ScenarioResults& results, const Block& block, int sign) {
    const std::size_t steps = static_cast<std::size_t>(results.steps());
    for (std::size_t a = 0; a < results.arms.size(); ++a) {
        const ArmBlock& from = block.arms[a];
        ArmResults& to = results.arms[a];
        to.counted += sign * from.counted;
        const std::int32_t* covered = from.covered.data();
        for (std::size_t f = 0; f < results.figures.size(); ++f) {
            add_figure(to.totals[f], results.figures[f], from, f, steps, sign);
            add_coverage(to.totals[f], covered, sign);
            covered += to.totals[f].covered.size();
        }
        add_cells(to, from, static_cast<std::size_t>(block.trials), sign);
        add_products(to.products, from, sign);
    }
}

/// Detailed trials of a block, from a row on.
void store_details(const ArmBlock& from, std::int64_t row, std::size_t trials, ArmResults& to) {
    const auto put = [&](const std::vector<float>& values, std::vector<double>& all) {
        const auto width = static_cast<std::int64_t>(values.size() / trials);
        std::copy(values.begin(), values.end(), all.begin() + row * width);
    };
    put(from.errors, to.errors);
    put(from.nees, to.nees);
}

/// A block that stays: where its rows were, where they go, and how many.
struct Move {
    std::int64_t from, to, rows;
};

/// Rows of `width` values each.
void move_rows(std::vector<double>& values, const std::vector<Move>& moves, std::int64_t rows, std::int64_t width) {
    const bool in_place =
        std::all_of(moves.begin(), moves.end(), [](const Move& move) { return move.from == move.to; });
    if (in_place) return values.resize(static_cast<std::size_t>(rows * width));
    std::vector<double> moved(static_cast<std::size_t>(rows * width));
    for (const Move& move : moves)
        std::copy_n(values.begin() + move.from * width, move.rows * width, moved.begin() + move.to * width);
    values = std::move(moved);
}

}  // namespace

ScenarioResults empty_results(const Scenario& scenario) {
    ScenarioResults results{scenario, trial_columns(scenario), step_figures(scenario), {}, 0, {}};
    const std::size_t steps = static_cast<std::size_t>(results.steps());
    const std::size_t lags = static_cast<std::size_t>(lag_count(scenario.poses));
    for (const Arm& arm : arms_of(scenario)) {
        ArmResults one;
        one.name = arm_name(arm);
        one.columns.resize(results.columns.size());
        for (const Figure& figure : results.figures)
            one.totals.push_back(
                {std::vector<ExactSum>(steps), std::vector<ExactSum>(figure.integer ? 0 : steps), {}, {},
                 std::vector<std::int64_t>(figure.role == FigureRole::nees ? steps * coverage_level_count : 0)});
        if (shape_counted(results.steps())) one.cells.resize(steps * shape_cells);
        one.products = {std::vector<ExactSum>(lags), std::vector<ExactSum>(lags), std::vector<std::int64_t>(lags)};
        results.arms.push_back(std::move(one));
    }
    return results;
}

bool is_figure(const Column& column) { return column.type != ColumnType::status && column.name != "status_pose"; }

std::vector<double> column_values(const ArmResults& arm, std::size_t column, std::int64_t first, std::int64_t count) {
    if (arm.kept) return arm.kept->values(column, first, count);
    const auto from = arm.columns[column].begin() + first;
    return {from, from + count};
}

std::vector<double> column_values(const ScenarioResults& results, const ArmResults& arm, std::size_t column) {
    return column_values(arm, column, 0, results.trials);
}

std::vector<double> figure_values(const ScenarioResults& results, const ArmResults& arm, std::size_t column) {
    std::vector<double> values = column_values(results, arm, column);
    const std::vector<double> status = column_values(results, arm, column_status);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (failed(static_cast<Status>(static_cast<int>(status[i]))))
            values[i] = std::numeric_limits<double>::quiet_NaN();
    return values;
}

std::vector<const ArmResults*> arms_meant(const ScenarioResults& results, const std::string& name) {
    std::vector<const ArmResults*> meant;
    for (const ArmResults& arm : results.arms) {
        if (arm.name == name) return {&arm};
        if (controller_of(arm.name) == name) meant.push_back(&arm);
    }
    return meant;
}

const ArmResults* fixed_partner(const ScenarioResults& results, const ArmResults& arm) {
    const std::size_t dot = arm.name.find('.');
    if (dot == std::string::npos || arm.name.substr(0, dot) != "greedy") return nullptr;
    for (const ArmResults& other : results.arms)
        if (other.name == "fixed" + arm.name.substr(dot)) return &other;
    return nullptr;
}

std::int64_t ScenarioResults::detailed() const {
    const std::int64_t most = detailed_trials(steps(), state_size());
    if (blocks.empty()) return std::min(trials, most);
    const auto end = std::lower_bound(blocks.begin(), blocks.end(), most / block_size);
    return std::min(trials, block_size * (end - blocks.begin()));
}

std::int64_t block_rows(const ScenarioResults& results, std::size_t place) {
    return std::min<std::int64_t>(block_size, results.trials - block_size * static_cast<std::int64_t>(place));
}

std::vector<std::int64_t> trial_numbers(const ScenarioResults& results, std::int64_t first, std::int64_t count) {
    std::vector<std::int64_t> numbers;
    numbers.reserve(static_cast<std::size_t>(count));
    for (std::int64_t row = first; row < first + count; ++row)
        numbers.push_back(results.blocks[static_cast<std::size_t>(row / block_size)] * block_size + row % block_size);
    return numbers;
}

std::optional<std::int64_t> first_row(const ScenarioResults& results, std::int64_t block) {
    const auto found = std::lower_bound(results.blocks.begin(), results.blocks.end(), block);
    if (found == results.blocks.end() || *found != block) return std::nullopt;
    return block_size * (found - results.blocks.begin());
}

void set_blocks(ScenarioResults& results, std::vector<std::int64_t> blocks, std::int64_t trials) {
    std::vector<Move> moves, detailed_moves;
    const std::int64_t most = detailed_trials(results.steps(), results.state_size()) / block_size;
    std::int64_t rows = 0;
    for (const std::int64_t block : blocks) {
        const std::int64_t size = trials_in_block(trials, block);
        if (const std::optional<std::int64_t> row = first_row(results, block)) {
            const auto place = static_cast<std::size_t>(*row / block_size);
            moves.push_back({*row, rows, std::min(size, block_rows(results, place))});
            if (block < most) detailed_moves.push_back(moves.back());
        }
        rows += size;
    }
    results.blocks = std::move(blocks);
    results.trials = rows;
    const std::int64_t steps = results.steps(), detailed = results.detailed();
    for (ArmResults& arm : results.arms) {
        if (!arm.kept)
            for (std::vector<double>& column : arm.columns) move_rows(column, moves, rows, 1);
        move_rows(arm.nees, detailed_moves, detailed, steps);
        move_rows(arm.errors, detailed_moves, detailed, steps * results.state_size());
    }
}

void extend(ScenarioResults& results, std::int64_t trials) {
    std::vector<std::int64_t> blocks(static_cast<std::size_t>(block_count(trials)));
    std::iota(blocks.begin(), blocks.end(), 0);
    set_blocks(results, std::move(blocks), trials);
}

void store_columns(ScenarioResults& results, const Block& block) {
    const std::int64_t row = first_row(results, block.index).value();
    const auto trials = static_cast<std::size_t>(block.trials);
    for (std::size_t a = 0; a < results.arms.size(); ++a) {
        ArmResults& arm = results.arms[a];
        if (!block.arms[a].nees.empty()) store_details(block.arms[a], row, trials, arm);
        if (arm.kept) continue;
        for (std::size_t c = 0; c < results.columns.size(); ++c)
            std::copy_n(block.arms[a].columns.begin() + static_cast<std::ptrdiff_t>(c * trials), trials,
                        arm.columns[c].begin() + row);
    }
}

void add_totals(ScenarioResults& results, const Block& block) { add_scaled_totals(results, block, 1); }

void add_totals(ArmResults& to, const ArmResults& from) {
    const auto add_sums = [](std::vector<ExactSum>& sums, const std::vector<ExactSum>& others) {
        for (std::size_t i = 0; i < sums.size(); ++i) sums[i].add(others[i]);
    };
    const auto add_counts = [](std::vector<std::int64_t>& counts, const std::vector<std::int64_t>& others) {
        std::transform(counts.begin(), counts.end(), others.begin(), counts.begin(), std::plus<>());
    };
    to.counted += from.counted;
    for (std::size_t f = 0; f < to.totals.size(); ++f) {
        add_sums(to.totals[f].sum, from.totals[f].sum);
        add_sums(to.totals[f].square_sum, from.totals[f].square_sum);
        to.totals[f].run_square_sum.add(from.totals[f].run_square_sum);
        add_counts(to.totals[f].covered, from.totals[f].covered);
    }
    add_counts(to.cells, from.cells);
    add_sums(to.products.sum, from.products.sum);
    add_sums(to.products.square_sum, from.products.square_sum);
    add_counts(to.products.count, from.products.count);
}

void remove_totals(ScenarioResults& results, const Block& block) { add_scaled_totals(results, block, -1); }

}  // namespace credence
