#include "merge_scenario.hpp"

#include <credence/error.hpp>
#include <credence/store.hpp>
#include <credence/text.hpp>

#include "journal_totals.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace credence {

namespace {

/// One arm's columns, some rows from each of several files.
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
        auto span = std::upper_bound(spans_.begin(), spans_.end(), first,
                                     [](std::int64_t row, const Span& other) { return row < other.begin + other.rows; });
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
    /// Rows `begin` ... here are rows `first` ... there.
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

/// A scenario's totals in bytes that are the same where the totals are.
std::string totals_of(const ScenarioResults& results) {
    ByteWriter bytes;
    put_totals(bytes, results);
    return bytes.take();
}

void add_totals_of(const ScenarioResults& from, ScenarioResults& to) {
    for (std::size_t a = 0; a < from.arms.size(); ++a) add_totals(to.arms[a], from.arms[a]);
}

/// `trials 512 to 767 of b/fixed.ekf`
std::string place_text(const ScenarioResults& results, const ArmResults& arm, std::int64_t block, std::int64_t trials) {
    const std::int64_t first = block * block_size;
    return "trials " + std::to_string(first) + " to " + std::to_string(first + trials - 1) + " of " +
           results.scenario.name + "/" + arm.name;
}

}  // namespace

ScenarioMerger::ScenarioMerger(const ScenarioResults& like, std::size_t scenario, const std::vector<std::string>& paths)
    : paths_(paths), scenario_(scenario), results_(empty_results(like.scenario, like.keep)) {
    if (like.keep == Keep::aggregates) return;
    for (ArmResults& arm : results_.arms) arm.kept = std::make_shared<GatheredColumns>();
}

void ScenarioMerger::add(const Study& part, std::size_t file) {
    const ScenarioResults& from = part.scenarios[scenario_];
    for (const ArmResults& arm : from.arms) columns_[file].push_back(arm.kept);
    const BlockRanges again = from.blocks.common(results_.blocks), fresh = from.blocks.without(again);
    if (again.empty()) {
        add_totals_of(from, results_);
    } else {
        for (const auto& [block, place] : places_)
            if (again.contains(block)) check_same(from, block, file);
        add_shared(part, fresh, file);
    }
    parts_.push_back({file, from.blocks});
    if (!fresh.empty()) add_rows(from, fresh, part.trials, file);
}

ScenarioResults ScenarioMerger::merged() {
    if (results_.keep == Keep::aggregates) return std::move(results_);
    for (std::size_t a = 0; a < results_.arms.size(); ++a) {
        const auto gathered = std::make_shared<GatheredColumns>();
        for (const auto& [block, place] : places_) gathered->add(columns_.at(place.file)[a], place.row, place.trials);
        results_.arms[a].kept = gathered;
    }
    return std::move(results_);
}

void ScenarioMerger::add_rows(const ScenarioResults& from, const BlockRanges& fresh, std::int64_t trials,
                              std::size_t file) {
    for (const std::int64_t block : fresh) {
        const std::int64_t row = first_row(from, block).value();
        if (results_.keep == Keep::aggregates && row >= from.detailed()) break;
        places_[block] = {file, row, trials_in_block(trials, block)};
    }
    BlockRanges blocks = results_.blocks;
    blocks.add(fresh);
    set_blocks(results_, std::move(blocks), trials);
    for (const std::int64_t block : fresh) {
        if (first_row(results_, block).value() >= results_.detailed()) break;
        copy_details(results_, from, block);
    }
}

void ScenarioMerger::refuse(std::size_t file, std::vector<std::string> others, const std::string& why) const {
    constexpr std::size_t most = 8;
    if (others.size() > most) {
        const std::string more = std::to_string(others.size() - most) + " more";
        others.resize(most);
        others.push_back(more);
    }
    throw InputError("cannot merge " + paths_[file] + " with " + joined(others) + " (" + why +
                     "). Find out which of them is damaged, and run it again.");
}

/// Throws unless the columns and details of a block are the same in this file and in the one that brought it.
void ScenarioMerger::check_same(const ScenarioResults& from, std::int64_t block, std::size_t file) const {
    const Found& place = places_.at(block);
    const std::int64_t row = first_row(from, block).value();
    for (std::size_t a = 0; a < from.arms.size(); ++a) {
        const auto check = [&](bool same, const std::string& what) {
            if (!same)
                refuse(file, {paths_[place.file]}, place_text(from, from.arms[a], block, place.trials) + " differ in " + what);
        };
        for (std::size_t c = 0; c < from.columns.size() && from.keep == Keep::trials; ++c)
            check(same_bits(columns_.at(place.file)[a]->values(c, place.row, place.trials),
                            columns_.at(file)[a]->values(c, row, place.trials)),
                  from.columns[c].name);
        check(same_details(results_, from, a, block), "their errors");
    }
}

ScenarioResults ScenarioMerger::read(const Part& part) const {
    return std::move(read_results(paths_[part.file]).study.scenarios[scenario_]);
}

/// Adds the totals of a file that shares blocks with others. They must be what those of the others say, with those of
/// the blocks that the others do not have computed; so it does not matter which file comes first.
void ScenarioMerger::add_shared(const Study& part, const BlockRanges& fresh, std::size_t file) {
    const ScenarioResults& from = part.scenarios[scenario_];
    ScenarioResults expected = empty_results(from.scenario, from.keep);
    BlockRanges left = from.blocks;
    std::vector<std::string> others;
    for (Part& one : parts_) {
        if (one.blocks.common(from.blocks).empty()) continue;
        others.push_back(paths_[one.file]);
        if (one.blocks.without(left).empty()) {
            add_totals_of(read(one), expected);
            left = left.without(one.blocks);
        } else if (!one.blocks.without(from.blocks).empty()) {
            check_computed(one, part);
        }
    }
    const BlockRunner runner(from.scenario);
    for (const std::int64_t block : left) {
        const Block computed = runner.run(part.root_seed, block, trials_in_block(part.trials, block));
        add_totals(expected, computed);
        if (fresh.contains(block)) add_totals(results_, computed);
    }
    if (totals_of(expected) != totals_of(from))
        refuse(file, others, "their totals of " + from.scenario.name + " contradict each other");
}

/// Throws unless the totals of a file that shares only some of its blocks are those of all of them.
void ScenarioMerger::check_computed(Part& one, const Study& study) const {
    if (std::exchange(one.computed, true)) return;
    const ScenarioResults from = read(one);
    ScenarioResults expected = empty_results(from.scenario, from.keep);
    const BlockRunner runner(from.scenario);
    for (const std::int64_t block : one.blocks)
        add_totals(expected, runner.run(study.root_seed, block, trials_in_block(study.trials, block)));
    if (totals_of(expected) != totals_of(from))
        throw InputError("cannot merge " + paths_[one.file] + " (its totals of " + from.scenario.name +
                         " are not those of its trials). Run it again.");
}

}  // namespace credence
