// The rows of columns and details: which trials they are of.

#include <credence/detail/results.hpp>

#include "totals/visit_totals.hpp"

#include "base/nan.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace credence {

namespace {

/// A block that is kept: its old rows, its new rows, and their number.
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

std::vector<double> ArmColumns::values(std::size_t column, std::int64_t first, std::int64_t count) const {
    if (kept_) return (*kept_)(column, first, count);
    const auto from = in_memory_[column].begin() + first;
    return {from, from + count};
}

void ArmColumns::keep(std::shared_ptr<const KeptColumns> kept) {
    in_memory_.clear();
    kept_ = std::move(kept);
}

std::vector<std::vector<double>>& ArmColumns::in_memory() {
    if (kept_) throw std::logic_error("the columns are in a file");
    return in_memory_;
}

std::vector<double> column_values(const ScenarioResults& results, const ArmResults& arm, std::size_t column) {
    return arm.columns.values(column, 0, results.trials);
}

std::vector<double> figure_values(const ScenarioResults& results, const ArmResults& arm, std::size_t column) {
    std::vector<double> values = column_values(results, arm, column);
    const std::vector<double> status = column_values(results, arm, status_column(results.columns));
    for (std::size_t i = 0; i < values.size(); ++i)
        if (failed(static_cast<Status>(static_cast<int>(status[i])))) values[i] = nan;
    return values;
}

std::int64_t ScenarioResults::detailed() const {
    const std::int64_t most = detailed_trials(steps(), state_size());
    if (blocks.empty()) return std::min(trials, most);
    return std::min(trials, block_size * blocks.count_below(most / block_size));
}

int ScenarioResults::moment_count() const {
    return credence::moment_count(state_size(), static_cast<int>(scenario.groups.size()));
}

std::int64_t block_rows(const ScenarioResults& results, std::size_t place) {
    return std::min<std::int64_t>(block_size, results.trials - block_size * static_cast<std::int64_t>(place));
}

std::int64_t trials_in(const BlockRanges& blocks, std::int64_t trials) {
    if (blocks.empty()) return 0;
    return block_size * (blocks.count() - 1) + trials_in_block(trials, blocks.back());
}

std::int64_t trials_up_to(const ScenarioResults& results) {
    if (results.blocks.empty()) return 0;
    return results.blocks.back() * block_size + block_rows(results, results.blocks.size() - 1);
}

std::vector<std::int64_t> trial_numbers(const ScenarioResults& results, std::int64_t first, std::int64_t count) {
    std::vector<std::int64_t> numbers;
    numbers.reserve(static_cast<std::size_t>(count));
    for (std::int64_t row = first; row < first + count;) {
        const std::int64_t start = results.blocks[static_cast<std::size_t>(row / block_size)] * block_size;
        do numbers.push_back(start + row % block_size);
        while (++row % block_size != 0 && row < first + count);
    }
    return numbers;
}

std::optional<std::int64_t> first_row(const ScenarioResults& results, std::int64_t block) {
    const std::optional<std::int64_t> place = results.blocks.place_of(block);
    return place ? std::optional(block_size * *place) : std::nullopt;
}

void set_blocks(ScenarioResults& results, BlockRanges blocks, std::int64_t trials) {
    std::vector<Move> moves, detailed_moves;
    const std::int64_t most = detailed_trials(results.steps(), results.state_size()) / block_size;
    const bool in_memory = std::ranges::any_of(
        results.arms, [](const ArmResults& arm) { return !arm.columns.kept() && !arm.columns.empty(); });
    std::int64_t rows = 0;
    for (const std::int64_t block : blocks) {
        if (!in_memory && block >= most) break;  // the block has no row
        const std::int64_t size = trials_in_block(trials, block);
        if (const std::optional<std::int64_t> row = first_row(results, block)) {
            const auto place = static_cast<std::size_t>(*row / block_size);
            moves.push_back({*row, rows, std::min(size, block_rows(results, place))});
            if (block < most) detailed_moves.push_back(moves.back());
        }
        rows += size;
    }
    results.trials = trials_in(blocks, trials);
    results.blocks = std::move(blocks);
    const std::int64_t detailed = results.detailed();
    for (ArmResults& arm : results.arms) {
        if (!arm.columns.kept())
            for (std::vector<double>& column : arm.columns.in_memory()) move_rows(column, moves, results.trials, 1);
        if (!has_totals(results)) continue;
        visit_details(
            results, [&](auto& values, std::int64_t width) { move_rows(values, detailed_moves, detailed, width); },
            arm);
    }
}

void copy_details(ScenarioResults& to, const ScenarioResults& from, std::int64_t block) {
    const std::int64_t row_to = first_row(to, block).value(), row_from = first_row(from, block).value();
    if (row_to >= to.detailed() || row_from >= from.detailed()) return;
    const std::int64_t rows = block_rows(from, static_cast<std::size_t>(row_from / block_size));
    const auto copy = [&](const auto& source, auto& target, std::int64_t width) {
        std::copy_n(source.begin() + row_from * width, rows * width, target.begin() + row_to * width);
    };
    for (std::size_t a = 0; a < from.arms.size(); ++a) visit_details(from, copy, from.arms[a], to.arms[a]);
}

}  // namespace credence
