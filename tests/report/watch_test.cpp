// Watching a run: a snapshot has the means of the trials so far, and the run is not affected.

#include "watch_support.hpp"

namespace credence::test::watch_test {

namespace {

/// Bytes that this process has read from files so far.
std::int64_t bytes_read() {
    std::ifstream io("/proc/self/io");
    std::string name;
    std::int64_t bytes = 0;
    io >> name >> bytes;
    return bytes;
}

}  // namespace

TEST_CASE("watch: after every commit a snapshot has the means of the trials so far, and reads no more than these") {
    const TemporaryFolder folder;
    const Asked asked = small(1100);  // 5 blocks of each scenario, the last of 76 trials
    const std::string path = folder / "x.h5", journal = path + ".journal";
    RunWatch watch(path);
    std::int64_t size = 0;
    for (std::int64_t commit = 1; commit <= 10; ++commit) {
        run_and_die(path, asked, 1);
        const std::string bytes = bytes_of(journal);
        const std::int64_t before = bytes_read();
        const Snapshot snapshot = watch.snapshot();
        const std::int64_t appended = static_cast<std::int64_t>(bytes.size()) - size, read = bytes_read() - before;
        size += appended;
        CAPTURE(commit, size, appended, read);
        // Once for the checksum and once for the columns; the header, and what /proc says.
        CHECK(read < 2 * appended + 20000);
        CHECK(snapshot.state == RunState::running);
        CHECK(snapshot.trials == 1100);
        CHECK(snapshot.trials_asked() == 2200);
        CHECK(bytes_of(journal) == bytes);
        check_says(snapshot, opened(path, asked).study());
    }
    CHECK(size > 1000000);
    run_to_end(path, asked);
    const Snapshot last = watch.snapshot();
    CHECK(last.state == RunState::complete);
    CHECK(last.trials_done() == 2200);
    check_says(last, read_results(path).study);
    CHECK(folder.entries() == 1);
}

TEST_CASE("watch: a journal cut anywhere is followed up to its last whole commit, and on from there") {
    const TemporaryFolder folder;
    const Asked asked{600, 1, {}, {tiny("a")}, 1};
    const std::string path = folder / "x.h5", journal = path + ".journal";
    run_and_die(path, asked);
    const std::string bytes = bytes_of(journal);
    const std::vector<std::size_t> ends = commit_ends(bytes);
    REQUIRE(ends.size() == 4);
    RunWatch growing(path);
    for (std::size_t size = 0; size < bytes.size(); size += 997) {
        put_bytes(journal, bytes.substr(0, size));
        const auto whole = std::upper_bound(ends.begin(), ends.end(), size) - ends.begin();
        const std::int64_t trials[] = {0, 0, 256, 512, 600};
        CAPTURE(size);
        for (const Snapshot& snapshot : {growing.snapshot(), RunWatch(path).snapshot()}) {
            CHECK(snapshot.state == (whole == 0 ? RunState::begun : RunState::running));
            CHECK(snapshot.trials_done() == trials[whole]);
        }
    }
    put_bytes(journal, bytes);
    check_says(growing.snapshot(), undisturbed(asked));
}

TEST_CASE("watch: a shard is shown with the trials that it will have") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5";
    const Asked part = small(2500, {1, 4});  // blocks 1, 5 and 9, which has 196 trials
    run_and_die(path, part, 0);
    RunWatch watch(path);
    const auto check = [&](std::int64_t trials, std::int64_t trials_asked, std::int64_t blocks,
                           std::int64_t blocks_asked, const Shard& shard) {
        const Snapshot snapshot = watch.snapshot();
        const WatchedScenario& scenario = snapshot.scenarios.front();
        CAPTURE(watch_text(snapshot));
        CHECK(scenario.trials == trials);
        CHECK(scenario.trials_asked == trials_asked);
        CHECK(scenario.blocks == blocks);
        CHECK(scenario.blocks_asked == blocks_asked);
        CHECK(snapshot.shard.index == shard.index);
        CHECK(snapshot.shard.count == shard.count);
        return snapshot;
    };
    check(0, 708, 0, 3, {1, 4});
    run_and_die(path, part, 2);
    check(512, 708, 2, 3, {1, 4});
    run_to_end(path, part);
    CHECK(check(708, 708, 3, 3, {1, 4}).state == RunState::incomplete);
    // Another shard into the same file, and then all of it.
    run_and_die(path, small(2500, {0, 2}), 1);
    check(708 + 256, 708 + 5 * 256, 4, 8, {0, 2});
    run_and_die(path, small(2500), 2);
    check_says(check(708 + 3 * 256, 2500, 6, 10, {}), opened(path, small(2500)).study());
}

TEST_CASE("watch: a study that is grown is shown with what its file has, whose partial block is computed again") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5", journal = path + ".journal";
    RunWatch watch(path);
    for (const std::int64_t trials : {300, 400, 900}) {  // a block of 44 trials, of 144, and whole
        const Asked asked = small(trials);
        for (const std::int64_t blocks : {0, 1, 2}) {
            run_and_die(path, asked, blocks);
            const Snapshot snapshot = watch.snapshot();
            CAPTURE(trials, blocks);
            CHECK(snapshot.state == RunState::running);
            CHECK(snapshot.trials == trials);
            check_says(snapshot, opened(path, asked).study());
        }
        const std::string bytes = bytes_of(journal);
        run_to_end(path, asked);
        check_says(watch.snapshot(), undisturbed(asked));
        // Killed between naming the file and removing the journal: all is in the file, the journal's blocks too.
        put_bytes(journal, bytes);
        const Snapshot late = RunWatch(path).snapshot();
        CHECK(late.state == RunState::running);
        CHECK(late.trials_done() >= opened(path, asked).study().scenarios.front().trials);
        std::filesystem::remove(journal);
    }
}

}  // namespace credence::test::watch_test
