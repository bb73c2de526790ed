#pragma once
// Room 12: one scenario of a merge.

#include <credence/study.hpp>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace credence {

/// One scenario of the study, as the files bring it.
class ScenarioMerger {
public:
    /// Of the study's scenario of that number; `paths` are all files.
    ScenarioMerger(const ScenarioResults& like, std::size_t scenario, const std::vector<std::string>& paths);

    const BlockRanges& blocks() const { return results_.blocks; }

    /// Adds what a file has and no other had before. Throws InputError where what others had too is not the same.
    void add(const Study& part, std::size_t file);

    ScenarioResults merged();

private:
    /// A file and the blocks that it has.
    struct Part {
        std::size_t file;
        BlockRanges blocks;
        bool computed = false;  ///< its totals were compared with those of its blocks, computed again
    };
    /// Where a block is: its file, its first row there, and its trials.
    struct Found {
        std::size_t file;
        std::int64_t row, trials;
    };

    void add_rows(const ScenarioResults& from, const BlockRanges& fresh, std::int64_t trials, std::size_t file);
    void add_shared(const Study& part, const BlockRanges& fresh, std::size_t file);
    void check_same(const ScenarioResults& from, std::int64_t block, std::size_t file) const;
    void check_computed(Part& one, const Study& study) const;
    ScenarioResults read(const Part& part) const;
    [[noreturn]] void refuse(std::size_t file, std::vector<std::string> others, const std::string& why) const;

    const std::vector<std::string>& paths_;
    std::size_t scenario_;
    ScenarioResults results_;
    std::vector<Part> parts_;
    std::map<std::int64_t, Found> places_;  ///< of blocks with columns or details
    std::map<std::size_t, std::vector<std::shared_ptr<const KeptColumns>>> columns_;  ///< by file and arm
};

}  // namespace credence
