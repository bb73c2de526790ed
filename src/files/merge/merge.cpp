#include "files/merge/merge.hpp"

#include <credence/error.hpp>
#include <credence/text.hpp>

#include "files/merge/scenario.hpp"
#include "study/block_results.hpp"
#include "study/releases.hpp"

#include <utility>

namespace credence {

namespace {

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
        for (std::size_t s = 0; s < part.scenarios.size(); ++s)
            scenarios_.emplace_back(part.scenarios[s], part.trials);
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
