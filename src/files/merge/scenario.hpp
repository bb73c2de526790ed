#pragma once
// Merges the files' content for one scenario.

#include <credence/study.hpp>

#include "files/merge/totals.hpp"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace credence {

/// One scenario of the study, collected from the files.
class ScenarioMerger {
public:
    /// Constructs this scenario of a study of `trials` trials; `paths` are all files.
    ScenarioMerger(const ScenarioResults& like, std::int64_t trials, std::uint64_t root_seed,
                   const std::shared_ptr<const std::vector<std::string>>& paths);

    const BlockRanges& blocks() const { return results_.blocks; }

    /// Adds the blocks of a file that no earlier file had. Throws InputError where columns of a shared block differ.
    void add(const ScenarioResults& from, std::size_t file);

    /// Leaves the columns in the files, and totals that are too large for `in_memory`. Throws InputError where totals
    /// or errors of several files contradict each other.
    ScenarioResults merged(TotalsInMemory& in_memory);

private:
    /// The place of a block: its file, its first row there, and its trials.
    struct Found {
        std::size_t file;
        std::int64_t row, trials;
    };

    void check_same(const ScenarioResults& from, std::int64_t block, std::size_t file) const;

    std::int64_t trials_;
    std::shared_ptr<const std::vector<std::string>> paths_;
    ScenarioResults results_;
    std::shared_ptr<MergedTotals> totals_;
    bool shared_ = false;                   ///< some block is in several files
    std::map<std::int64_t, Found> places_;  ///< of blocks with columns
    std::map<std::size_t, std::vector<std::shared_ptr<const KeptColumns>>> columns_;  ///< by file and arm
};

}  // namespace credence
