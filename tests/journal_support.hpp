#pragma once
// Interrupted runs, and journals as bytes, for the tests of journals.

#include "worlds/deformable/keys.hpp"
#include "files/stored_run.hpp"

#include "files/journal/commit.hpp"
#include "store_study.hpp"
#include "study_support.hpp"

#include <limits>

namespace credence::test {

/// A world of one step, one feature and one arm: few bytes.
inline DeformableSettings tiny(const std::string& name) {
    return read_deformable_text("[scenario]\nname = " + name + "\nposes = 2\n[features]\npositions = 0.5 0.5\n" +
                                  "[arms]\ncontrollers = fixed\n[planner]\nspeeds = 1", name, name);
}

/// The study and the run of a test.
struct Asked {
    std::int64_t trials = 3;
    std::uint64_t root_seed = 1;
    Shard shard;
    std::vector<DeformableSettings> scenarios{tiny("a"), tiny("b"), tiny("c")};
    int threads = 1;
    Keep keep = Keep::trials;
    std::string release = unknown_release;

    Study study() const { return new_study(scenarios, root_seed, keep); }
};

inline constexpr std::int64_t all_blocks = std::numeric_limits<std::int64_t>::max();

/// Stops a run of one thread after so many blocks.
inline std::function<bool()> after(std::int64_t blocks) {
    return [left = std::make_shared<std::int64_t>(blocks)] { return (*left)-- <= 0; };
}

inline StoredRun opened(const std::string& path, const Asked& asked, Start start = Start::resume) {
    return StoredRun(path, asked.study(), start, asked.release);
}

inline void compute(StoredRun& run, const Asked& asked, std::int64_t blocks = all_blocks) {
    BlockKeeper& keeper = run.begin(asked.trials, 1, asked.shard);
    RunOptions options{asked.trials, asked.threads, {}, asked.shard, after(blocks), &keeper};
    if (blocks == all_blocks) options.stop = {};
    run_study(run.study(), options);
}

/// Leaves a journal with that many blocks, as a crash would.
inline void run_and_die(const std::string& path, const Asked& asked, std::int64_t blocks = all_blocks,
                        Start start = Start::resume) {
    StoredRun run = opened(path, asked, start);
    compute(run, asked, blocks);
}

/// Leaves a results file.
inline void run_to_end(const std::string& path, const Asked& asked, std::int64_t blocks = all_blocks,
                       Start start = Start::resume) {
    StoredRun run = opened(path, asked, start);
    compute(run, asked, blocks);
    run.finish(run_facts);
}

/// The study of an undisturbed run.
inline Study undisturbed(const Asked& asked) {
    Study study = asked.study();
    run_study(study, {asked.trials, 1, {}, asked.shard, {}, nullptr});
    return study;
}

inline std::int64_t blocks_in(const Study& study) {
    std::int64_t blocks = 0;
    for (const ScenarioResults& results : study.scenarios) blocks += static_cast<std::int64_t>(results.blocks.size());
    return blocks;
}

/// The ends of a journal's header and commits.
inline std::vector<std::size_t> commit_ends(const std::string& journal) {
    std::vector<std::size_t> ends{header_size(journal.substr(0, header_prefix), "journal")};
    while (ends.back() < journal.size()) {
        ByteReader from(journal.data() + ends.back(), journal.size() - ends.back());
        const auto payload = static_cast<std::size_t>(get_commit_head(from).payload);
        ends.push_back(ends.back() + commit_head_size + payload + commit_tail_size);
    }
    return ends;
}

/// Text with its checksum behind it.
inline std::string sealed(std::string bytes) {
    const std::uint32_t crc = checksum(bytes.data(), bytes.size());
    return bytes.append(reinterpret_cast<const char*>(&crc), sizeof crc);
}

/// The message that refuses a run on `path`; empty where it can continue.
inline std::string refused(const std::string& path, const Asked& asked, Start start = Start::resume) {
    return refusal<std::runtime_error>([&] { run_to_end(path, asked, all_blocks, start); });
}

inline bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace credence::test
