#pragma once
// The journal of a run: finished blocks, committed to the disk during the run. docs/durability.md describes its
// guarantees.

#include "files/journal/scan.hpp"
#include "study/releases.hpp"

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>

namespace credence {

class Journal : public BlockKeeper {
public:
    /// Opens the journal at `path`, or creates it with these permissions, and locks it. Throws InputError where another
    /// program holds it or it is not a journal of this version.
    explicit Journal(const std::string& path, mode_t mode = 0666);

    /// The journal's study; nothing where the journal is new, or was torn before anything could be committed.
    const std::optional<JournalHeader>& header() const { return header_; }

    /// Starts the journal over, for `study`.
    void begin(const JournalHeader& header, Study& study);
    /// Continues the journal: adds its commits to `study`, which holds the content of the results file that the journal
    /// extends. A torn tail is ignored, and cut. Throws InputError where the journal is damaged.
    void load(Study& study);
    bool has_commits() const { return file_.size() > header_size_; }
    /// Size in bytes of the torn tail that load() cut.
    std::int64_t torn() const { return torn_; }
    void remove() { file_.remove(); }
    /// Throws Failure unless the file's bytes are those that were read when it was opened and those written since.
    void check_unchanged() const;
    /// The releases that computed blocks of the study.
    const std::vector<std::string>& computed_by() const { return computed_by_; }

    /// Number of blocks after which a commit is made; 0: half a second, and more where there is little to commit.
    void commit_every(std::int64_t blocks) { commit_every_ = blocks; }
    /// The shard that the run computes, and its release, for all commits from here on.
    void works_on(const Shard& shard, const std::string& release) {
        shard_ = shard;
        release_ = release;
    }

    void take_back(std::size_t scenario, std::int64_t block) override;
    void take(std::size_t scenario, const Block& block) override;
    bool due(std::int64_t held) const override;
    bool full() const override;
    void prepare(const Study& study) override;
    void commit() override;
    void finished(const Study& study) override;

    /// The committed totals and details.
    void load_totals(std::size_t scenario, ScenarioResults& results) const;

    /// Values of a column by row; valid after finished() has set the rows of the blocks.
    std::vector<double> values(std::size_t scenario, std::size_t arm, std::size_t column, std::int64_t first,
                               std::int64_t count) const;

private:
    /// A scenario: the layout of its blocks, their places, and what is waiting for the next commit.
    struct Kept {
        BlockLayout layout;
        std::vector<ColumnType> types;
        std::vector<std::shared_ptr<const KeptColumns>> in_file;  ///< by arm, of the results file that it extends
        std::shared_ptr<const KeptTotals> totals_in_file;         ///< likewise; nullptr: there are no totals
        PlacedBlocks placed;
        std::int64_t counted = 0;                                 ///< trials in the last totals
        JournalTotals totals;                                     ///< the last ones; nothing: the results file has them
        std::vector<BlockPlace> rows;                             ///< of the blocks, in order; if trials are kept
        std::vector<std::int64_t> pending;                        ///< blocks
        ByteWriter pending_values;
    };

    void keep(Study& study);
    std::vector<BlockLayout> layouts() const;
    bool keeps_trials() const { return kept_.empty() || kept_.front().layout.keep() == Keep::trials; }
    std::vector<JournalScenario> scan(const Study& study);
    void put_commit(std::size_t scenario, const Study& study);
    void read_details(std::size_t scenario, ScenarioResults& results) const;
    static std::int64_t rows_in_file(const Kept& kept, std::size_t at, std::int64_t skip, std::int64_t left);
    void read_values(std::int64_t position, ColumnType type, double* values, std::int64_t count) const;

    JournalFile file_;
    std::optional<JournalHeader> header_;
    std::int64_t asked_ = 0, torn_ = 0, commit_every_ = 0, header_size_ = 0;
    std::uint32_t seal_ = 0;  ///< checksum of the header and of the checksums of all commits
    Shard shard_;
    std::string release_ = unknown_release;
    std::vector<std::string> computed_by_;
    std::vector<Kept> kept_;

    /// A commit to be written, its checksum still missing.
    struct PreparedCommit {
        std::string start, values, totals;

        std::int64_t size() const { return static_cast<std::int64_t>(start.size() + values.size() + totals.size()); }
    };

    std::vector<PreparedCommit> batch_;
    std::int64_t batch_size_ = 0;    ///< bytes, with their checksums
    std::atomic<bool> committing_ = false;
    std::size_t totals_size_ = 0;    ///< of the last commit
    std::size_t pending_size_ = 0, pending_blocks_ = 0;
    const std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
    std::chrono::steady_clock::time_point last_commit_ = begun_;
};

}  // namespace credence
