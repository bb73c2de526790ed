#include "files/merge/scenario.hpp"

#include "study/block_results.hpp"

#include <algorithm>
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

}  // namespace

/// Totals and details of the files, read from these one after the other when they are loaded.
class MergedTotals : public KeptTotals {
public:
    /// A file's part of the scenario.
    struct Part {
        std::size_t file;
        BlockRanges blocks;
        std::vector<std::shared_ptr<const KeptColumns>> columns;  ///< by arm
        std::shared_ptr<const KeptTotals> totals;
    };

    explicit MergedTotals(std::int64_t trials) : trials_(trials) {}

    std::vector<Part> parts;

    void load(ScenarioResults& results) const override {
        for (const Part& part : parts) {
            const ScenarioResults from = read(part, results);
            for (std::size_t a = 0; a < from.arms.size(); ++a) add_totals(results.arms[a], from.arms[a]);
            BlockRanges blocks = results.blocks;
            blocks.add(part.blocks);
            set_blocks(results, std::move(blocks), trials_);
            for (const std::int64_t block : part.blocks) {
                if (first_row(results, block).value() >= results.detailed()) break;
                copy_details(results, from, block);
            }
        }
    }

private:
    ScenarioResults read(const Part& part, const ScenarioResults& like) const {
        ScenarioResults from = results_without_totals(like.scenario, like.keep);
        from.kept_totals = part.totals;
        for (std::size_t a = 0; a < from.arms.size(); ++a) from.arms[a].columns.keep(part.columns[a]);
        set_blocks(from, part.blocks, trials_);
        load_totals(from);
        return from;
    }

    std::int64_t trials_;
};

ScenarioMerger::ScenarioMerger(const ScenarioResults& like, std::int64_t trials)
    : trials_(trials),
      results_(results_without_totals(like.scenario, like.keep)),
      totals_(std::make_shared<MergedTotals>(trials)) {
    results_.kept_totals = totals_;
    for (ArmResults& arm : results_.arms) arm.columns = {};  // they stay in the files
}

std::optional<ScenarioMerger::Shared> ScenarioMerger::shared(const BlockRanges& blocks) const {
    const BlockRanges again = blocks.common(results_.blocks);
    for (const MergedTotals::Part& part : totals_->parts)
        if (!again.empty() && part.blocks.contains(again.front())) return Shared{again.front(), part.file};
    return std::nullopt;
}

void ScenarioMerger::add(const ScenarioResults& from, std::size_t file) {
    MergedTotals::Part part{file, from.blocks, {}, from.kept_totals};
    for (const ArmResults& arm : from.arms) part.columns.push_back(arm.columns.kept());
    if (results_.keep == Keep::trials)
        for (const std::int64_t block : from.blocks)
            places_[block] = {totals_->parts.size(), first_row(from, block).value(), trials_in_block(trials_, block)};
    totals_->parts.push_back(std::move(part));
    BlockRanges blocks = results_.blocks;
    blocks.add(from.blocks);
    set_blocks(results_, std::move(blocks), trials_);
}

ScenarioResults ScenarioMerger::merged(TotalsInMemory& in_memory) {
    for (std::size_t a = 0; a < results_.arms.size() && results_.keep == Keep::trials; ++a) {
        const auto gathered = std::make_shared<GatheredColumns>();
        for (const auto& [block, place] : places_)
            gathered->add(totals_->parts[place.part].columns[a], place.row, place.trials);
        results_.arms[a].columns.keep(gathered);
    }
    in_memory.load(results_);
    // A file that contradicts itself is found before anything is written.
    if (!has_totals(results_) && results_.keep == Keep::aggregates) {
        load_totals(results_);
        drop_totals(results_);
    }
    return std::move(results_);
}

}  // namespace credence
