#pragma once
// Module study: the study: scenarios with their arms, which blocks to run, and how.

#include <credence/detail/block.hpp>
#include <credence/detail/progress.hpp>
#include <credence/detail/results.hpp>

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace credence {

/// Version of the layout of results files. A file of another version is refused.
inline constexpr int schema_version = 5;
/// Version of draws, columns and series.
inline constexpr int draws_version = 2;

/// A study has no more trials of a scenario than this.
inline constexpr std::int64_t most_trials = 1'000'000'000'000;

/// A study and its results so far.
struct Study {
    std::uint64_t root_seed = 1;
    std::vector<ScenarioResults> scenarios;
    std::int64_t trials = 0;            ///< of each scenario that were asked for
    bool complete = true;               ///< every scenario has all of them
    /// The releases that computed trials of it, such as `credence 0.3.0, git revision 1a2b3c4`; empty if not known.
    std::vector<std::string> computed_by{};
};

/// The definition of a study, which does not include its trials, threads, shards or stopping.
struct StudyDefinition {
    std::uint64_t root_seed = 1;
    std::vector<Scenario> scenarios; ///< resolved
    Keep keep = Keep::trials;
};
StudyDefinition definition_of(const Study& study);

struct Record;

/// A record as a study of one scenario: its columns, without those that a record does not have.
Study study_of(Record record);

/// How the study keeps its columns: the same in every scenario.
Keep keep_of(const Study& study);

/// The identifier of the study: a version-5 UUID (SHA-1) of scenarios, arms, root seed, draws_version and Keep. Keys
/// that came after it [detail/keys.hpp] are left out where they have their default.
std::string study_hash(const StudyDefinition& definition);
std::string study_hash(const Study& study);

/// Describes the first difference between two studies, such as `its root seed is 2, not 1`; empty where they are the
/// same.
std::string difference_of(const StudyDefinition& there, const StudyDefinition& here);

/// The part of a study's blocks that one of several runs computes: block b where b mod count = index.
struct Shard {
    std::int64_t index = 0, count = 1;
};

/// Keeps the columns of blocks in a file during a run, so that a crash loses only blocks that were not committed yet.
/// The engine calls one function at a time, except for `commit`.
class BlockKeeper {
public:
    virtual ~BlockKeeper() = default;
    /// A partial last block was removed from the totals: it is computed again, larger.
    virtual void take_back(std::size_t scenario, std::int64_t block) = 0;
    /// Takes a finished block; the study includes its totals already.
    virtual void take(std::size_t scenario, const Block& block) = 0;
    /// Whether the blocks taken so far should be committed. This would free `held` bytes of memory beside the keeper's
    /// own.
    virtual bool due(std::int64_t held) const = 0;
    /// Whether so much waits to be committed that no further blocks should be computed until a commit is made.
    virtual bool full() const = 0;
    /// Prepares a commit of all blocks taken so far, with the study's totals, which include exactly these.
    virtual void prepare(const Study& study) = 0;
    /// Makes the prepared commit durable. Other threads may pass blocks to the keeper meanwhile. Throws Failure.
    virtual void commit() = 0;
    /// Called at the end of the run: all is committed, and `study` lists the present blocks, so that columns may be
    /// read by their rows.
    virtual void finished(const Study& study) = 0;
};

/// What a run computed of an arm, of all scenarios and on all threads.
struct ArmTime {
    std::int64_t trials = 0;
    double seconds = 0;
};

struct RunOptions {
    std::int64_t trials = 10000;
    int threads = 0;                    ///< 0: as many as the machine has
    std::function<void(const Progress&)> progress{};  ///< called from one thread at a time; may be empty
    Shard shard{};
    std::function<bool()> stop{};       ///< asked before every block, from several threads; may be empty
    BlockKeeper* keeper = nullptr;      ///< none: kept columns and all totals stay in memory
    std::map<std::string, ArmTime>* times = nullptr;  ///< to which each arm's are added; may be none
    /// Beyond this many bytes, totals of finished scenarios are dropped where the keeper can provide them again.
    std::int64_t most_totals = most_totals_in_memory;
};

/// An empty study of resolved, validated scenarios with names that differ. Their totals are not in memory yet
/// [load_totals].
Study new_study(const std::vector<Scenario>& scenarios, std::uint64_t root_seed, Keep keep = Keep::trials);

/// Runs the missing blocks of the shard, of the first `options.trials` trials of every scenario; a partial last block
/// is computed again. The result has the same bits for any number of threads and any history. Returns early where
/// `options.stop` returns true: blocks that were begun are finished, a partial one that was present is completed, the
/// others are missing. Throws InputError where the study has been asked for more trials already, and what the keeper
/// throws.
void run_study(Study& study, const RunOptions& options);

/// The trials that the study has been asked for, or that some scenario has, if more: it cannot be asked for fewer.
std::int64_t least_trials(const Study& study);

/// Whether the last present block would be larger in a study of `trials` trials.
bool last_would_grow(const ScenarioResults& results, std::int64_t trials);

/// The blocks of a shard that a scenario of the study lacks, of `trials` trials; they include a partial one that is
/// present and would be larger, whatever its shard.
BlockRanges missing_blocks(const ScenarioResults& results, std::int64_t trials, const Shard& shard = {});

/// Bytes of memory and of file for `trials` trials of the study.
struct Footprint {
    std::int64_t memory = 0, file = 0;
    std::int64_t cells = 0;  ///< totals by step that are written and reported
};
Footprint footprint(const Study& study, std::int64_t trials, int threads);

}  // namespace credence
