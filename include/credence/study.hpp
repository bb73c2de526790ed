#pragma once
// Module study: the study: scenarios under their arms, which blocks to run, and on what.

#include <credence/detail/provenance.hpp>
#include <credence/results.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace credence {

/// Version of columns, figures, draws and file layout. Results of different versions never mix.
inline constexpr int schema_version = 2;

/// A study has no more trials of a scenario than this.
inline constexpr std::int64_t most_trials = 1'000'000'000'000;

/// A study and what has been computed of it.
struct Study {
    std::uint64_t root_seed = 1;
    std::vector<ScenarioResults> scenarios;
    std::int64_t trials = 0;            ///< of each scenario that were asked for
    bool complete = true;               ///< every scenario has all of them
    Provenance computed_by{};           ///< which release computed which blocks; empty where it is not known
};

/// What makes a study that study: not its trials, threads, shards or stopping.
struct StudyDefinition {
    std::uint64_t root_seed = 1;
    std::vector<Scenario> scenarios; ///< resolved
    Keep keep = Keep::trials;
};
StudyDefinition definition_of(const Study& study);

/// What the study keeps of its columns: the same in every scenario.
Keep keep_of(const Study& study);

/// Names the study: a version-5 UUID (SHA-1) of scenarios, arms, root seed, schema version and what is kept.
std::string study_hash(const StudyDefinition& definition);
std::string study_hash(const Study& study);

/// What the first difference between two studies is, such as `its root seed is 2, not 1`; empty where they are the same.
std::string difference_of(const StudyDefinition& there, const StudyDefinition& here);

/// Progress of a run: trials are counted once, under all their arms.
struct Progress {
    std::int64_t done = 0, total = 0;
    double seconds = 0;
};

/// The part of a study's blocks that one of several runs computes: block b where b mod count = index.
struct Shard {
    std::int64_t index = 0, count = 1;
};

/// Keeps the columns of blocks in a file while a run goes on, so that a crash loses no more than what was not committed
/// yet. The engine calls one function at a time, but for `commit`.
class BlockKeeper {
public:
    virtual ~BlockKeeper() = default;
    /// A partial last block was taken back from the totals: it is computed again, larger.
    virtual void take_back(std::size_t scenario, std::int64_t block) = 0;
    /// A finished block; the study holds its totals already.
    virtual void take(std::size_t scenario, const Block& block) = 0;
    /// The same of blocks that another process computed; `values` are their columns and details in order, in the keeper's
    /// own form.
    virtual void take(std::size_t scenario, const std::vector<std::int64_t>& blocks, const std::string& values) = 0;
    /// Whether what was taken should be committed. `held` bytes of memory would be freed then, beside the keeper's own.
    virtual bool due(std::int64_t held) const = 0;
    /// Whether so much waits to be committed that no more should be computed while a commit is being made.
    virtual bool full() const = 0;
    /// Makes a commit of all that was taken, with the study's totals, which hold just that.
    virtual void prepare(const Study& study) = 0;
    /// Makes durable what was prepared. Other threads may take blocks meanwhile. Throws Failure.
    virtual void commit() = 0;
    /// The run has ended, all is committed, and `study` says which blocks are there: columns may be read by their rows.
    virtual void finished(const Study& study) = 0;
};

class Workers;

struct RunOptions {
    std::int64_t trials = 10000;
    int threads = 0;                    ///< 0: as many as the machine has
    std::function<void(const Progress&)> progress{};  ///< called from one thread at a time; may be empty
    Shard shard{};
    std::function<bool()> stop{};       ///< asked before every block, from several threads; may be empty
    BlockKeeper* keeper = nullptr;      ///< none: columns that are kept stay in memory, and all totals
    Workers* workers = nullptr;              ///< other processes that compute blocks too; needs a keeper
    /// Beyond so many bytes totals of scenarios that are done are dropped where the keeper gives them back.
    std::int64_t most_totals = most_totals_in_memory;
};

/// An empty study of resolved, validated scenarios with names that differ. Their totals are not in memory yet
/// [load_totals].
Study new_study(const std::vector<Scenario>& scenarios, std::uint64_t root_seed, Keep keep = Keep::trials);

/// Runs what is missing of the shard's blocks of the first `options.trials` trials of every scenario; a partial last
/// block is computed again. The same bits for any number of threads and any history. Returns early where `options.stop`
/// says so: blocks under way are finished, a partial one that was there is made whole, the others are not there. Throws InputError where the study has been asked
/// for more trials already, and what the keeper throws.
void run_study(Study& study, const RunOptions& options);

/// Trials that the study has been asked for already, or that some scenario of it has: it cannot be asked for fewer.
std::int64_t least_trials(const Study& study);

/// Whether the last block that is there would be larger in a study of `trials` trials.
bool last_would_grow(const ScenarioResults& results, std::int64_t trials);

/// The blocks of a shard that a scenario of the study lacks, of `trials` trials; a partial one that is there and would be
/// larger is among them, whosever it is.
BlockRanges missing_blocks(const ScenarioResults& results, std::int64_t trials, const Shard& shard = {});

/// Bytes of memory and of file that `trials` trials of the study take.
struct Footprint {
    std::int64_t memory = 0, file = 0;
    std::int64_t cells = 0;  ///< totals by step that are written and reported
};
Footprint footprint(const Study& study, std::int64_t trials, int threads);

}  // namespace credence
