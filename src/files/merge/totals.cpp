#include "files/merge/totals.hpp"

#include <credence/error.hpp>
#include <credence/detail/worlds.hpp>
#include <credence/text.hpp>

#include "files/journal/totals.hpp"
#include "study/block_results.hpp"

#include <algorithm>

namespace credence {

namespace {

/// A scenario's totals as bytes, equal exactly where the totals are equal.
std::string totals_of(const ScenarioResults& results) {
    ByteWriter bytes;
    put_totals(bytes, results);
    return bytes.take();
}

void add_totals_of(const ScenarioResults& from, ScenarioResults& to) {
    for (std::size_t a = 0; a < from.arms.size(); ++a) add_totals(to.arms[a], from.arms[a]);
}

}  // namespace

void refuse_contradiction(const std::string& path, std::vector<std::string> others, const std::string& why) {
    constexpr std::size_t most = 8;
    if (others.size() > most) {
        const std::string more = std::to_string(others.size() - most) + " more";
        others.resize(most);
        others.push_back(more);
    }
    throw InputError("cannot merge " + path + " with " + joined(others) + " (" + why +
                     "). Find out which of them is damaged, and run it again.");
}

std::string place_text(const ScenarioResults& results, const ArmResults& arm, std::int64_t block, std::int64_t trials) {
    const std::int64_t first = block * block_size;
    return "trials " + std::to_string(first) + " to " + std::to_string(first + trials - 1) + " of " +
           results.scenario.name + "/" + arm.name;
}

/// Adds up the totals of the files, one after the other.
class MergedTotals::Adding {
public:
    Adding(const MergedTotals& merged, ScenarioResults& results)
        : merged_(merged), results_(results), computed_(merged.parts_.size()) {}

    void add(std::size_t place) {
        const ScenarioResults from = read(place);
        const BlockRanges again = from.blocks.common(results_.blocks), fresh = from.blocks.without(again);
        if (again.empty()) {
            add_totals_of(from, results_);
        } else {
            check_details(place, from, again);
            add_shared(place, from, fresh);
        }
        BlockRanges blocks = results_.blocks;
        blocks.add(fresh);
        set_blocks(results_, std::move(blocks), merged_.trials_);
        for (const std::int64_t block : fresh) {
            if (first_row(results_, block).value() >= results_.detailed()) break;
            copy_details(results_, from, block);
        }
    }

private:
    const std::string& path_of(std::size_t place) const { return (*merged_.paths_)[merged_.parts_[place].file]; }

    ScenarioResults read(std::size_t place) const {
        const Part& part = merged_.parts_[place];
        ScenarioResults from = results_without_totals(results_.scenario, results_.keep);
        from.kept_totals = part.totals;
        for (std::size_t a = 0; a < from.arms.size(); ++a) {
            from.arms[a].columns.clear();
            from.arms[a].kept = part.columns[a];
        }
        set_blocks(from, part.blocks, merged_.trials_);
        load_totals(from);
        return from;
    }

    /// Throws unless errors that an earlier file has as well are the same.
    void check_details(std::size_t place, const ScenarioResults& from, const BlockRanges& again) const {
        for (const std::int64_t block : again)
            for (std::size_t a = 0; a < from.arms.size(); ++a) {
                if (same_details(results_, from, a, block)) continue;
                std::size_t first = 0;
                while (!merged_.parts_[first].blocks.contains(block)) ++first;
                refuse_contradiction(
                    path_of(place), {path_of(first)},
                    place_text(from, from.arms[a], block, trials_of(block)) + " differ in their errors");
            }
    }

    int trials_of(std::int64_t block) const { return trials_in_block(merged_.trials_, block); }

    Block compute(const BlockRunner& runner, std::int64_t block) const {
        return runner.run(merged_.root_seed_, block, trials_of(block));
    }

    /// Adds the totals of a file that shares blocks with others. They must equal the others' totals plus those of the
    /// blocks that only this file has, which are computed again; so the order of the files does not matter.
    void add_shared(std::size_t place, const ScenarioResults& from, const BlockRanges& fresh) {
        ScenarioResults expected = empty_results(from.scenario, from.keep);
        BlockRanges left = from.blocks;
        std::vector<std::string> others;
        for (std::size_t other = 0; other < place; ++other) {
            const BlockRanges& blocks = merged_.parts_[other].blocks;
            if (blocks.common(from.blocks).empty()) continue;
            others.push_back(path_of(other));
            if (blocks.without(left).empty()) {
                add_totals_of(read(other), expected);
                left = left.without(blocks);
            } else if (!blocks.without(from.blocks).empty()) {
                check_computed(other);
            }
        }
        const BlockRunner runner(world_of(from.scenario), from.scenario);
        for (const std::int64_t block : left) {
            const Block computed = compute(runner, block);
            add_totals(expected, computed);
            if (fresh.contains(block)) add_totals(results_, computed);
        }
        if (totals_of(expected) != totals_of(from))
            refuse_contradiction(path_of(place), others,
                                 "their totals of " + from.scenario.name + " contradict each other");
    }

    /// Throws unless the totals of a file that shares only some of its blocks equal the totals of all its blocks.
    void check_computed(std::size_t place) {
        if (computed_[place]) return;
        computed_[place] = true;
        const ScenarioResults from = read(place);
        ScenarioResults expected = empty_results(from.scenario, from.keep);
        const BlockRunner runner(world_of(from.scenario), from.scenario);
        for (const std::int64_t block : from.blocks) add_totals(expected, compute(runner, block));
        if (totals_of(expected) != totals_of(from))
            throw InputError("cannot merge " + path_of(place) + " (its totals of " + from.scenario.name +
                             " are not those of its trials). Run it again.");
    }

    const MergedTotals& merged_;
    ScenarioResults& results_;
    std::vector<bool> computed_;  ///< by file: its totals were compared with those of its blocks, computed again
};

void MergedTotals::add(const ScenarioResults& from, std::size_t file) {
    parts_.push_back({file, from.blocks, {}, from.kept_totals});
    for (const ArmResults& arm : from.arms) parts_.back().columns.push_back(arm.kept);
}

void MergedTotals::load(ScenarioResults& results) const {
    Adding adding(*this, results);
    for (std::size_t place = 0; place < parts_.size(); ++place) adding.add(place);
}

}  // namespace credence
