#pragma once
// Totals and details of one scenario of a merge.

#include <credence/study.hpp>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace credence {

/// Throws InputError: a file contradicts others.
[[noreturn]] void refuse_contradiction(const std::string& path, std::vector<std::string> others,
                                       const std::string& why);

/// `trials 512 to 767 of b/fixed.ekf`
std::string place_text(const ScenarioResults& results, const ArmResults& arm, std::int64_t block, std::int64_t trials);

/// The merged totals and details of several files, read from these one after the other when they are loaded.
class MergedTotals : public KeptTotals {
public:
    MergedTotals(std::int64_t trials, std::uint64_t root_seed,
                 std::shared_ptr<const std::vector<std::string>> paths)
        : trials_(trials), root_seed_(root_seed), paths_(std::move(paths)) {}

    void add(const ScenarioResults& from, std::size_t file);

    /// Throws InputError where a file does not agree with its columns, or files contradict each other.
    void load(ScenarioResults& results) const override;

private:
    /// A file's part of the scenario.
    struct Part {
        std::size_t file;
        BlockRanges blocks;
        std::vector<std::shared_ptr<const KeptColumns>> columns;  ///< by arm
        std::shared_ptr<const KeptTotals> totals;
    };

    class Adding;

    std::int64_t trials_;
    std::uint64_t root_seed_;
    std::shared_ptr<const std::vector<std::string>> paths_;
    std::vector<Part> parts_;
};

}  // namespace credence
