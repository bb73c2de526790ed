#pragma once
// The journal of a run: what the engine finished, committed while the run goes on. docs/durability.md says what
// it promises.

#include "files/journal/file.hpp"
#include "files/journal/commit.hpp"

#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <optional>

namespace credence {

/// Where the values of a block are: in the journal, or in the results file that the journal grows.
struct BlockPlace {
    std::int64_t trials = 0;
    std::int64_t position = 0;  ///< in the journal: of the block's first byte; in the file: of its first row
    bool in_file = false;
};

/// Which blocks are there. Where no trial is kept, those alone have a place that have details, or are partial: what the
/// others take does not grow with their number.
struct PlacedBlocks {
    BlockRanges blocks;
    std::map<std::int64_t, BlockPlace> places;

    void put(std::int64_t block, const BlockPlace& place);
    /// Of a study of `trials` trials: blocks of which no trial is kept. Those of them that have details have a place already.
    void put(const BlockRange& range, std::int64_t trials, const BlockLayout& layout);
    /// The others' place is the one to believe.
    void put(const PlacedBlocks& others);
    void remove(std::int64_t block);
    std::int64_t trials_of(std::int64_t block) const;
    std::int64_t trials() const;
    /// The study that has just these blocks.
    std::int64_t trials_up_to() const { return blocks.empty() ? 0 : blocks.back() * block_size + trials_of(blocks.back()); }
    /// Whether it has these with as many trials.
    bool has(const PlacedBlocks& others) const;
};

/// Where the journal has the last totals of a scenario.
struct JournalTotals {
    std::int64_t position = 0, size = 0;

    /// Whether any record is of that scenario.
    bool found() const { return position > 0; }
};

/// What a journal says of one scenario.
struct JournalScenario {
    PlacedBlocks placed;
    std::int64_t asked = 0;    ///< trials that the study was asked for at the last totals
    std::int64_t counted = 0;  ///< trials in the last totals
    JournalTotals totals;
    Provenance computed_by;    ///< of this scenario alone
};

class Journal : public BlockKeeper {
public:
    /// Opens the journal at `path`, or makes it with these permissions, and locks it. Throws InputError where another program holds it, or it is
    /// no journal of this version.
    explicit Journal(const std::string& path, mode_t mode = 0666);

    /// The study that it belongs to; nothing where it is new, or was torn before anything could be committed.
    const std::optional<JournalHeader>& header() const { return header_; }

    /// Begins it anew, for `study`.
    void begin(const JournalHeader& header, Study& study);
    /// Goes on with it: adds what was committed to `study`, which holds what is in the results file that it grows. A torn
    /// tail is left out, and cut. Throws InputError where it is damaged.
    void load(Study& study);
    bool has_commits() const { return file_.size() > header_size_; }
    /// Bytes of the torn tail that load() cut.
    std::int64_t torn() const { return torn_; }
    void remove() { file_.remove(); }
    /// Throws Failure unless the file is what was read from it when it was opened and written since, byte by byte.
    void check_unchanged() const;
    /// Which release computed which blocks of the study.
    const Provenance& computed_by() const { return computed_by_; }

    /// Blocks that make a commit due; 0: half a second, and more where there is little to commit.
    void commit_every(std::int64_t blocks) { commit_every_ = blocks; }
    /// What the run works on, and the release that computes it, for the records from here on.
    void works_on(const Shard& shard, const std::string& release) {
        shard_ = shard;
        release_ = release;
    }

    void take_back(std::size_t scenario, std::int64_t block) override;
    void take(std::size_t scenario, const Block& block) override;
    void take(std::size_t scenario, const std::vector<std::int64_t>& blocks, const std::string& values) override;
    bool due(std::int64_t held) const override;
    bool full() const override;
    void prepare(const Study& study) override;
    void commit() override;
    void finished(const Study& study) override;

    /// The totals and details that are committed.
    void load_totals(std::size_t scenario, ScenarioResults& results) const;

    /// Values of a column by row, once finished() has said which blocks are there.
    std::vector<double> values(std::size_t scenario, std::size_t arm, std::size_t column, std::int64_t first,
                               std::int64_t count) const;

private:
    /// A scenario: how its blocks lie, where they are, and what the engine gave since the last commit.
    struct Kept {
        BlockLayout layout;
        std::vector<ColumnType> types;
        std::vector<std::shared_ptr<const KeptColumns>> in_file;  ///< by arm, of the results file that is grown
        std::shared_ptr<const KeptTotals> totals_in_file;         ///< likewise; nullptr: there is none
        PlacedBlocks placed;
        std::int64_t counted = 0;                                 ///< trials in them
        JournalTotals totals;                                     ///< over them; none: those of the results file
        std::vector<BlockPlace> rows;                             ///< of those that are there, in order; if trials are kept
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
    std::uint32_t seal_ = 0;  ///< checksum of the header and of the checksums of all records
    Shard shard_;
    std::string release_ = unknown_release;
    Provenance computed_by_;
    std::vector<Kept> kept_;

    /// A record to be committed, its checksum still missing.
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
