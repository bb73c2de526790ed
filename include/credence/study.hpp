#pragma once
// Room 11: the study: scenarios under their arms, which blocks to run, and on what.

#include <credence/results.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace credence {

/// Version of columns, figures, draws and file layout. Results of different versions never mix.
inline constexpr int schema_version = 2;

/// A study and what has been computed of it.
struct Study {
    std::uint64_t root_seed = 1;
    std::vector<ScenarioResults> scenarios;
    bool complete = true;               ///< every scenario has all trials that were asked for
};

/// Names the study: a version-5 UUID (SHA-1) of scenarios, arms, root seed, schema version and what is kept; not of
/// trials, threads, shards or stopping.
std::string study_hash(const Study& study);

/// Progress of a run: trials are counted once, under all their arms.
struct Progress {
    std::int64_t done = 0, total = 0;
    double seconds = 0;
};

struct RunOptions {
    std::int64_t trials = 10000;
    int threads = 0;                    ///< 0: as many as the machine has
    std::function<void(const Progress&)> progress;  ///< called from one thread at a time; may be empty
};

/// An empty study of resolved, validated scenarios with names that differ.
Study new_study(const std::vector<Scenario>& scenarios, std::uint64_t root_seed);

/// Runs what is missing of the first `options.trials` trials of every scenario; a partial last block is computed again.
/// The same bits for any number of threads and any history. Throws InputError where the study already has more trials.
void run_study(Study& study, const RunOptions& options);

/// Bytes of memory and of file that `trials` trials of the study take.
struct Footprint {
    std::int64_t memory = 0, file = 0;
};
Footprint footprint(const Study& study, std::int64_t trials, int threads);

}  // namespace credence
