#include "files/merge/merge.hpp"

#include <credence/error.hpp>
#include <credence/text.hpp>

#include "study/block_results.hpp"
#include "study/releases.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

namespace credence {

namespace {

/// One arm's columns, with rows from several files.
struct GatheredColumns {
    /// Maps rows from `begin` on here to rows from `first` on there.
    struct Span {
        std::shared_ptr<const KeptColumns> source;
        std::int64_t begin, first, rows;
    };
    std::vector<Span> spans;

    void add(const std::shared_ptr<const KeptColumns>& source, std::int64_t first, std::int64_t rows) {
        const std::int64_t begin = spans.empty() ? 0 : spans.back().begin + spans.back().rows;
        if (!spans.empty() && spans.back().source == source && spans.back().first + spans.back().rows == first)
            spans.back().rows += rows;
        else
            spans.push_back({source, begin, first, rows});
    }

    std::vector<double> operator()(std::size_t column, std::int64_t first, std::int64_t count) const {
        std::vector<double> values;
        auto span = std::upper_bound(spans.begin(), spans.end(), first, [](std::int64_t row, const Span& other) {
            return row < other.begin + other.rows;
        });
        for (; count > 0; ++span) {
            const std::int64_t skip = first - span->begin, some = std::min(count, span->rows - skip);
            const std::vector<double> read = (*span->source)(column, span->first + skip, some);
            values.insert(values.end(), read.begin(), read.end());
            first += some;
            count -= some;
        }
        return values;
    }
};

/// A file's part of a scenario.
struct Part {
    std::size_t file;
    BlockRanges blocks;
    std::vector<std::shared_ptr<const KeptColumns>> columns;  ///< by arm
    std::shared_ptr<const KeptTotals> totals;

    /// Its totals and details, of a study of `trials` trials.
    ScenarioResults loaded(const ScenarioResults& like, std::int64_t trials) const {
        ScenarioResults from = results_without_totals(like.scenario, like.keep);
        from.kept_totals = totals;
        for (std::size_t a = 0; a < from.arms.size(); ++a) from.arms[a].columns.keep(columns[a]);
        set_blocks(from, blocks, trials);
        load_totals(from);
        return from;
    }
};

/// Totals and details of the files, read from these one after the other when they are loaded.
KeptTotals merged_totals(const std::vector<Part>& parts, std::int64_t trials) {
    return [=](ScenarioResults& results) {
        for (const Part& part : parts) {
            const ScenarioResults from = part.loaded(results, trials);
            for (std::size_t a = 0; a < from.arms.size(); ++a) add_totals(results.arms[a], from.arms[a]);
            BlockRanges blocks = results.blocks;
            blocks.add(part.blocks);
            set_blocks(results, std::move(blocks), trials);
            for (const std::int64_t block : part.blocks) {
                if (first_row(results, block).value() >= results.detailed()) break;
                copy_details(results, from, block);
            }
        }
    };
}

/// One scenario of the study, collected from files of which no two have the same block.
class ScenarioMerger {
public:
    /// This scenario of a study of `trials` trials.
    ScenarioMerger(const ScenarioResults& like, std::int64_t trials)
        : trials_(trials), results_(results_without_totals(like.scenario, like.keep)) {
        for (ArmResults& arm : results_.arms) arm.columns = {};  // they stay in the files
    }

    /// A block that is in a file already.
    struct Shared {
        std::int64_t block;
        std::size_t file;
    };
    /// The first of these blocks that is in a file already.
    std::optional<Shared> shared(const BlockRanges& blocks) const {
        const BlockRanges again = blocks.common(results_.blocks);
        for (const Part& part : parts_)
            if (!again.empty() && part.blocks.contains(again.front())) return Shared{again.front(), part.file};
        return std::nullopt;
    }

    void add(const ScenarioResults& from, std::size_t file) {
        Part part{file, from.blocks, {}, from.kept_totals};
        for (const ArmResults& arm : from.arms) part.columns.push_back(arm.columns.kept());
        if (results_.keep == Keep::trials)
            for (const std::int64_t block : from.blocks)
                places_[block] = {parts_.size(), first_row(from, block).value(), trials_in_block(trials_, block)};
        parts_.push_back(std::move(part));
        BlockRanges blocks = results_.blocks;
        blocks.add(from.blocks);
        set_blocks(results_, std::move(blocks), trials_);
    }

    /// Leaves the columns in the files, and totals that are too large for `in_memory`. Throws InputError where a file
    /// contradicts itself.
    ScenarioResults merged(TotalsInMemory& in_memory) {
        results_.kept_totals = std::make_shared<KeptTotals>(merged_totals(parts_, trials_));
        for (std::size_t a = 0; a < results_.arms.size() && results_.keep == Keep::trials; ++a) {
            GatheredColumns gathered;
            for (const auto& [block, place] : places_)
                gathered.add(parts_[place.part].columns[a], place.row, place.trials);
            results_.arms[a].columns.keep(std::make_shared<KeptColumns>(std::move(gathered)));
        }
        in_memory.load(results_);
        // A file that contradicts itself is found before anything is written.
        if (!has_totals(results_) && results_.keep == Keep::aggregates) {
            load_totals(results_);
            drop_totals(results_);
        }
        return std::move(results_);
    }

private:
    /// The place of a block: which of the files it is in, its first row there, and its trials.
    struct Found {
        std::size_t part;
        std::int64_t row, trials;
    };

    std::int64_t trials_;
    ScenarioResults results_;
    std::vector<Part> parts_;
    std::map<std::int64_t, Found> places_;  ///< of blocks with columns
};

/// Throws unless the file is of the same study as the first one.
void check_same_study(const Study& first, const Study& other, const std::vector<std::string>& paths, std::size_t file,
                      std::size_t first_file) {
    const auto refuse = [&](const std::string& why) {
        throw InputError("cannot merge " + paths[file] + " with " + paths[first_file],
                         "it is not of the same study: " + why, "Merge the shards of one study");
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

/// Throws unless trials of the two files may be merged.
void check_releases(const Study& first, const Study& other, const std::vector<std::string>& paths, std::size_t a,
                    std::size_t b) {
    for (const std::string& release : other.computed_by)
        if (const std::string unlike = unmixable(first.computed_by, release); !unlike.empty())
            throw InputError("cannot merge " + paths[b] + " with " + paths[a],
                             release + " computed trials of it, and " + unlike +
                                 " of the other; draws and columns may differ between them",
                             "Run one of them again");
}

/// The study that results from files that are added one after the other.
class Merger {
public:
    explicit Merger(const std::vector<std::string>& paths) : paths_(paths) {}

    void add(std::size_t file, Study part) {
        require_all_columns(part, "cannot merge " + paths_[file]);
        if (scenarios_.empty()) begin(part, file);
        check_same_study(study_, part, paths_, file, first_);
        check_releases(study_, part, paths_, first_, file);
        for (const std::string& release : part.computed_by) note_release(study_.computed_by, release);
        for (std::size_t s = 0; s < scenarios_.size(); ++s) {
            const ScenarioResults& results = part.scenarios[s];
            if (const auto shared = scenarios_[s].shared(results.blocks))
                throw InputError("cannot merge " + paths_[file] + " with " + paths_[shared->file],
                                 "both have block " + std::to_string(shared->block) + " of scenario " +
                                     results.scenario.name,
                                 "Give files of which no two have the same trials");
            scenarios_[s].add(results, file);
        }
    }

    Study merged(std::int64_t most_totals) {
        TotalsInMemory in_memory(most_totals);
        for (std::size_t s = 0; s < scenarios_.size(); ++s) study_.scenarios[s] = scenarios_[s].merged(in_memory);
        study_.complete = missing_text(study_).empty();
        return std::move(study_);
    }

private:
    void begin(const Study& part, std::size_t file) {
        first_ = file;
        for (std::size_t s = 0; s < part.scenarios.size(); ++s) scenarios_.emplace_back(part.scenarios[s], part.trials);
        study_ = part;
        for (ScenarioResults& results : study_.scenarios) results.arms.clear();
    }

    const std::vector<std::string>& paths_;
    std::size_t first_ = 0;
    Study study_;
    std::vector<ScenarioMerger> scenarios_;
};

}  // namespace

Study merge_results(const std::vector<std::string>& paths, std::int64_t most_totals) {
    Merger merger(paths);
    for (std::size_t file = 0; file < paths.size(); ++file)
        merger.add(file, read_results_without_totals(paths[file]).study);
    return merger.merged(most_totals);
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
