#pragma once
// Merges the files' content for one scenario.

#include <credence/study.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace credence {

class MergedTotals;

/// One scenario of the study, collected from files of which no two have the same block.
class ScenarioMerger {
public:
    /// Constructs this scenario of a study of `trials` trials.
    ScenarioMerger(const ScenarioResults& like, std::int64_t trials);

    /// A block that is in a file already.
    struct Shared {
        std::int64_t block;
        std::size_t file;
    };
    /// The first of these blocks that is in a file already.
    std::optional<Shared> shared(const BlockRanges& blocks) const;

    void add(const ScenarioResults& from, std::size_t file);

    /// Leaves the columns in the files, and totals that are too large for `in_memory`. Throws InputError where a file
    /// contradicts itself.
    ScenarioResults merged(TotalsInMemory& in_memory);

private:
    /// The place of a block: which of the files it is in, its first row there, and its trials.
    struct Found {
        std::size_t part;
        std::int64_t row, trials;
    };

    std::int64_t trials_;
    ScenarioResults results_;
    std::shared_ptr<MergedTotals> totals_;
    std::map<std::int64_t, Found> places_;  ///< of blocks with columns
};

}  // namespace credence
