#include <credence/merge.hpp>

#include <credence/error.hpp>
#include <credence/text.hpp>

#include <algorithm>
#include <bit>
#include <map>
#include <memory>

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

/// Where a block is: its file, its first row there, and its trials.
struct Found {
    std::size_t file;
    std::int64_t row, trials;
};

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
        return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y) || (x != x && y != y);
    });
}

/// One scenario of the study, as the files bring it.
class ScenarioMerger {
public:
    explicit ScenarioMerger(const ScenarioResults& like) : results_(empty_results(like.scenario, like.keep)) {
        if (like.keep == Keep::aggregates) return;
        for (ArmResults& arm : results_.arms) arm.kept = std::make_shared<GatheredColumns>();
    }

    /// Adds what a file has and no other had before.
    void add(const ScenarioResults& from, std::size_t file, const std::vector<std::string>& paths, std::int64_t trials,
             std::uint64_t root_seed) {
        columns_.emplace_back();
        for (const ArmResults& arm : from.arms) columns_.back().push_back(arm.kept);
        const BlockRanges fresh = from.blocks.without(results_.blocks), again = from.blocks.without(fresh);
        if (results_.keep == Keep::trials)
            for (const std::int64_t block : again) check_same(from, block, file, paths);
        if (fresh.empty()) return;
        for (std::size_t a = 0; a < from.arms.size(); ++a) add_totals(results_.arms[a], from.arms[a]);
        if (!again.empty()) take_out(again, trials, root_seed);
        if (results_.keep == Keep::trials)
            for (const std::int64_t block : fresh)
                places_[block] = {file, first_row(from, block).value(), trials_in_block(trials, block)};
        BlockRanges blocks = results_.blocks;
        blocks.add(fresh);
        set_blocks(results_, std::move(blocks), trials);
        for (const std::int64_t block : fresh) {
            if (first_row(results_, block).value() >= results_.detailed()) break;
            copy_details(results_, from, block);
        }
    }

    ScenarioResults merged() {
        if (results_.keep == Keep::aggregates) return std::move(results_);
        for (std::size_t a = 0; a < results_.arms.size(); ++a) {
            const auto gathered = std::make_shared<GatheredColumns>();
            for (const auto& [block, place] : places_) gathered->add(columns_[place.file][a], place.row, place.trials);
            results_.arms[a].kept = gathered;
        }
        return std::move(results_);
    }

private:
    void check_same(const ScenarioResults& from, std::int64_t block, std::size_t file,
                    const std::vector<std::string>& paths) const {
        const Found& place = places_.at(block);
        const std::int64_t row = first_row(from, block).value();
        for (std::size_t a = 0; a < from.arms.size(); ++a)
            for (std::size_t c = 0; c < from.columns.size(); ++c)
                if (!same_bits(columns_[place.file][a]->values(c, place.row, place.trials),
                               columns_[file][a]->values(c, row, place.trials)))
                    throw InputError("cannot merge " + paths[file] + " with " + paths[place.file] + " (trials " +
                                     std::to_string(block * block_size) + " to " +
                                     std::to_string(block * block_size + place.trials - 1) + " of " +
                                     from.scenario.name + "/" + from.arms[a].name + " differ in " +
                                     from.columns[c].name + "). Find out which of them is damaged, and run it again.");
    }

    /// The totals of a file are of all its blocks: those that were there already are computed and taken out.
    void take_out(const BlockRanges& blocks, std::int64_t trials, std::uint64_t root_seed) {
        const BlockRunner runner(results_.scenario);
        for (const std::int64_t block : blocks)
            remove_totals(results_, runner.run(root_seed, block, trials_in_block(trials, block)));
    }

    ScenarioResults results_;
    std::map<std::int64_t, Found> places_;                                  ///< of the trials that are kept
    std::vector<std::vector<std::shared_ptr<const KeptColumns>>> columns_;  ///< by file and arm
};

/// Throws unless the file is of the study that the first one is of.
void check_same_study(const Study& first, const Study& other, const std::vector<std::string>& paths, std::size_t file) {
    const auto refuse = [&](const std::string& why) {
        throw InputError("cannot merge " + paths[file] + " with " + paths.front() + " (it is not of the same study: " +
                         why + "). Merge the shards of one study.");
    };
    const std::string difference = difference_of(definition_of(other), definition_of(first));
    if (!difference.empty()) refuse(difference);
    if (other.trials != first.trials)
        refuse("it was asked for " + std::to_string(other.trials) + " trials, not " + std::to_string(first.trials));
}

/// `3, 7 to 9`; long lists are cut.
std::string ranges_text(const BlockRanges& blocks) {
    constexpr std::size_t most = 12;
    const std::vector<BlockRange> ranges = blocks.ranges();
    std::vector<std::string> texts;
    for (const BlockRange& range : ranges) {
        if (texts.size() == most) break;
        texts.push_back(std::to_string(range.first) +
                        (range.count() > 1 ? (range.count() > 2 ? " to " : ", ") + std::to_string(range.last) : ""));
    }
    const std::size_t more = ranges.size() - texts.size();
    return joined(texts, ", ") + (more > 0 ? " and " + std::to_string(more) + " more places" : "");
}

}  // namespace

Study merge_results(const std::vector<std::string>& paths) {
    Study study = read_results(paths.front()).study;
    std::vector<ScenarioMerger> mergers(study.scenarios.begin(), study.scenarios.end());
    for (std::size_t file = 0; file < paths.size(); ++file) {
        const Study part = file == 0 ? std::move(study) : read_results(paths[file]).study;
        if (file > 0) check_same_study(study, part, paths, file);
        for (std::size_t s = 0; s < mergers.size(); ++s)
            mergers[s].add(part.scenarios[s], file, paths, part.trials, part.root_seed);
        if (file == 0) {
            study = part;
            for (ScenarioResults& results : study.scenarios) results.arms.clear();
        }
    }
    for (std::size_t s = 0; s < mergers.size(); ++s) study.scenarios[s] = mergers[s].merged();
    study.complete = missing_text(study).empty();
    return study;
}

std::string missing_text(const Study& study) {
    std::vector<std::string> lacking;
    for (const ScenarioResults& results : study.scenarios) {
        const BlockRanges missing = missing_blocks(results, study.trials);
        if (!missing.empty())
            lacking.push_back("scenario " + results.scenario.name + " lacks blocks " + ranges_text(missing) + " of " +
                              std::to_string(block_count(study.trials)));
    }
    return joined(lacking, "; ");
}

}  // namespace credence
