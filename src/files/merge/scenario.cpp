#include "files/merge/scenario.hpp"

#include "study/block_results.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace credence {

namespace {

/// One arm's columns, with rows from several files.
class GatheredColumns : public KeptColumns {
public:
    void add(std::shared_ptr<const KeptColumns> source, std::int64_t first, std::int64_t rows) {
        const std::int64_t begin = spans_.empty() ? 0 : spans_.back().begin + spans_.back().rows;
        if (!spans_.empty() && spans_.back().source == source && spans_.back().first + spans_.back().rows == first)
            spans_.back().rows += rows;
        else
            spans_.push_back({std::move(source), begin, first, rows});
    }

    std::vector<double> values(std::size_t column, std::int64_t first, std::int64_t count) const override {
        std::vector<double> values;
        auto span = std::upper_bound(spans_.begin(), spans_.end(), first, [](std::int64_t row, const Span& other) {
            return row < other.begin + other.rows;
        });
        for (; count > 0; ++span) {
            const std::int64_t skip = first - span->begin, some = std::min(count, span->rows - skip);
            const std::vector<double> read = span->source->values(column, span->first + skip, some);
            values.insert(values.end(), read.begin(), read.end());
            first += some;
            count -= some;
        }
        return values;
    }

private:
    /// Maps rows from `begin` on here to rows from `first` on there.
    struct Span {
        std::shared_ptr<const KeptColumns> source;
        std::int64_t begin, first, rows;
    };
    std::vector<Span> spans_;
};

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
        return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y) || (x != x && y != y);
    });
}

}  // namespace

ScenarioMerger::ScenarioMerger(const ScenarioResults& like, std::int64_t trials, std::uint64_t root_seed,
                               const std::shared_ptr<const std::vector<std::string>>& paths)
    : trials_(trials),
      paths_(paths),
      results_(results_without_totals(like.scenario, like.keep)),
      totals_(std::make_shared<MergedTotals>(trials, root_seed, paths)) {
    results_.kept_totals = totals_;
    for (ArmResults& arm : results_.arms) arm.columns.clear();  // they stay in the files
}

void ScenarioMerger::add(const ScenarioResults& from, std::size_t file) {
    for (const ArmResults& arm : from.arms) columns_[file].push_back(arm.kept);
    const BlockRanges again = from.blocks.common(results_.blocks), fresh = from.blocks.without(again);
    shared_ = shared_ || !again.empty();
    for (const auto& [block, place] : places_)
        if (again.contains(block)) check_same(from, block, file);
    if (results_.keep == Keep::trials)
        for (const std::int64_t block : fresh)
            places_[block] = {file, first_row(from, block).value(), trials_in_block(trials_, block)};
    BlockRanges blocks = results_.blocks;
    blocks.add(fresh);
    set_blocks(results_, std::move(blocks), trials_);
    totals_->add(from, file);
}

ScenarioResults ScenarioMerger::merged(TotalsInMemory& in_memory) {
    for (std::size_t a = 0; a < results_.arms.size() && results_.keep == Keep::trials; ++a) {
        const auto gathered = std::make_shared<GatheredColumns>();
        for (const auto& [block, place] : places_) gathered->add(columns_.at(place.file)[a], place.row, place.trials);
        results_.arms[a].kept = gathered;
    }
    in_memory.load(results_);
    // Files that have the same blocks are compared before anything is written.
    if (!has_totals(results_) && (shared_ || results_.keep == Keep::aggregates)) {
        load_totals(results_);
        drop_totals(results_);
    }
    return std::move(results_);
}

/// Throws unless the columns of a block are the same in this file and in the one that brought it.
void ScenarioMerger::check_same(const ScenarioResults& from, std::int64_t block, std::size_t file) const {
    const Found& place = places_.at(block);
    const std::int64_t row = first_row(from, block).value();
    for (std::size_t a = 0; a < from.arms.size(); ++a)
        for (std::size_t c = 0; c < from.columns.size(); ++c)
            if (!same_bits(columns_.at(place.file)[a]->values(c, place.row, place.trials),
                           columns_.at(file)[a]->values(c, row, place.trials)))
                refuse_contradiction((*paths_)[file], {(*paths_)[place.file]},
                                     place_text(from, from.arms[a], block, place.trials) + " differ in " +
                                         from.columns[c].name);
}

}  // namespace credence
