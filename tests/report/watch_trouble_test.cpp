// Following a run: begun anew, locked by its run, with failed trials, or not there.

#include "files/journal/file.hpp"
#include "watch_support.hpp"

namespace credence::test::watch_trouble_test {

namespace {

std::string refused_look(const std::string& path) {
    return refusal<InputError>([&] { RunWatch(path).snapshot(); });
}

}  // namespace

TEST_CASE("watch: a run that is begun anew is followed anew") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5";
    RunWatch watch(path);
    run_and_die(path, small(1000), 3);
    CHECK(watch.snapshot().trials_done() == 3 * block_size);
    CHECK_THAT(watch_text(watch.snapshot()),
               Catch::Contains("\ntranslation-circle: not run yet, 1000 trials asked for\n"));
    Asked other = small(1000);
    for (const std::uint64_t seed : {2u, 3u, 3u}) {
        other.root_seed = seed;
        std::filesystem::remove(path + ".journal");
        run_and_die(path, other, 4);
        check_says(watch.snapshot(), opened(path, other).study());
    }
    run_and_die(path, small(1000), 5, Start::overwrite);
    const Snapshot snapshot = watch.snapshot();
    CHECK(snapshot.trials_done() == 1000 + block_size);  // all of the first scenario, whose last block is a partial one
    check_says(snapshot, opened(path, small(1000)).study());
}

TEST_CASE("watch: a journal that begins like the last one but has other commits is read from its start") {
    const TemporaryFolder folder;
    const Asked asked = small(2000);
    const std::string path = folder / "x.h5";
    RunWatch watch(path);
    run_and_die(path, asked, 2);  // a block a commit
    CHECK(watch.snapshot().trials_done() == 2 * block_size);
    std::filesystem::remove(path + ".journal");
    {
        StoredRun run = opened(path, asked);
        run_study(run.study(), {asked.trials, 1, {}, {}, after(4), &run.begin(asked.trials, 2)});  // two
    }
    const Snapshot snapshot = watch.snapshot();
    CHECK(snapshot.trials_done() == 4 * block_size);
    check_says(snapshot, opened(path, asked).study());
}

TEST_CASE("watch: a run is neither locked out nor kept waiting, and nothing is written") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5", journal = path + ".journal";
    const Asked asked = small(1000);
    run_and_die(path, asked, 2);
    const std::string bytes = bytes_of(journal);
    const auto changed = std::filesystem::last_write_time(journal);
    {
        const std::optional<JournalBytes> held = JournalBytes::open(journal);
        REQUIRE(held);
        StoredRun run = opened(path, asked);  // takes the lock
        CHECK(RunWatch(path).snapshot().trials_done() == 2 * block_size);
    }
    CHECK(bytes_of(journal) == bytes);
    CHECK(std::filesystem::last_write_time(journal) == changed);
    CHECK(folder.entries() == 1);
}

TEST_CASE("watch: failed trials are counted and left out of every mean") {
    const TemporaryFolder folder;
    const Study study = made_up_study();
    write_results(folder / "x.h5", study, run_facts);
    const Snapshot snapshot = RunWatch(folder / "x.h5").snapshot();
    CHECK(snapshot.state == RunState::complete);
    for (std::size_t s = 0; s < study.scenarios.size(); ++s)
        for (const WatchedArm& arm : snapshot.scenarios[s].arms) {
            CHECK(arm.failed == 1);
            CHECK(arm.diverged == 1);
            CHECK(arm.columns.front().count == 4);
        }
}

TEST_CASE("watch: where there is nothing, or nothing of credence, it says so") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5";
    CHECK(says(refused_look(path), "nothing to watch: neither " + path + " nor " + path + ".journal is there. Check"));
    put_bytes(path + ".journal", "credence-jour");
    CHECK(RunWatch(path).snapshot().state == RunState::begun);
    put_bytes(path + ".journal", "something else altogether");
    CHECK(says(refused_look(path), "is not a journal of credence"));
    std::filesystem::remove(path + ".journal");
    std::filesystem::create_directory(path + ".journal");
    CHECK(says(refused_look(path), "is not a regular file"));
    std::filesystem::remove(path + ".journal");
    put_bytes(path, "something else altogether");
    CHECK(says(refused_look(path), path));
    std::filesystem::remove(path);
    RunWatch watch(path);
    run_and_die(path, small(1000), 2);
    CHECK(watch.snapshot().state == RunState::running);
    std::filesystem::remove(path + ".journal");
    CHECK(says(refusal<InputError>([&] { watch.snapshot(); }), "nothing to watch"));
}

}  // namespace credence::test::watch_trouble_test
