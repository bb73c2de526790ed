// The journal of a study that grows, is sharded or is stopped: it has exactly the finished blocks.

#include "files/journal/journal.hpp"
#include "journal_support.hpp"

#include <atomic>

namespace credence::test::journal_grown_test {

namespace {

Asked asked_for(std::int64_t trials, Shard shard = {}, int threads = 1) {
    return {trials, 1, shard, {tiny("a"), tiny("b")}, threads};
}

}  // namespace

TEST_CASE("journal: a grown study whose partial block is computed again, killed after every block") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5";
    const Study expected = undisturbed(asked_for(1300));
    run_to_end(path, asked_for(600));
    const std::string before = bytes_of(path);
    for (std::int64_t blocks = 0; blocks <= 8; ++blocks) {  // of 2 scenarios, blocks 2 to 5
        CAPTURE(blocks);
        put_bytes(path, before);
        run_and_die(path, asked_for(1300), blocks);
        CHECK(bytes_of(path) == before);
        // Once more, so that a journal goes on with a journal too.
        run_and_die(path, asked_for(1300), 1);
        const std::int64_t there = blocks_in(opened(path, asked_for(1300)).study());
        CHECK(there >= 4 + std::min<std::int64_t>(8, blocks + 1));
        run_to_end(path, asked_for(1300));
        CHECK(same_results(read_results(path).study, expected));
        CHECK(folder.entries() == 1);
    }
}

TEST_CASE("journal: a later block may be committed before the partial one that is computed again") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5";
    const Asked one{1300, 1, {}, {tiny("a")}, 1};
    Asked fewer = one;
    fewer.trials = 600;
    run_to_end(path, fewer);
    {
        // What two threads do where the second is faster: block 3 is taken and committed, block 2 is not.
        StoredRun run = opened(path, one);
        BlockKeeper& keeper = run.begin(one.trials, 1);
        Study& study = run.study();
        ScenarioResults& results = study.scenarios.front();
        const Problem problem(settings_of(results.scenario));
        remove_totals(results, run_block(problem, study.root_seed, 2, 88));
        keeper.take_back(0, 2);
        set_blocks(results, {0, 1, 2, 3}, one.trials);
        study.trials = one.trials;
        const Block block = run_block(problem, study.root_seed, 3, block_size);
        store_columns(results, block);
        add_totals(results, block);
        keeper.take(0, block);
        keeper.prepare(study);
        keeper.commit();
    }
    CHECK(opened(path, one).study().scenarios.front().blocks == std::vector<std::int64_t>{0, 1, 3});
    run_to_end(path, one);
    CHECK(same_results(read_results(path).study, undisturbed(one)));
}

TEST_CASE("journal: grown twice before the results file is written, and asked for more while it is there") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5";
    run_and_die(path, asked_for(300), 3);
    run_and_die(path, asked_for(700), 2);
    const std::string said = refused(path, asked_for(300));
    CHECK(says(said, "--trials=300"));
    CHECK(says(said, "asked for 700 already"));
    run_and_die(path, asked_for(1000));
    run_to_end(path, asked_for(1000, {}, 2));
    CHECK(same_results(read_results(path).study, undisturbed(asked_for(1000))));
}

TEST_CASE("journal: shards that go on with one file make the whole") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5";
    run_to_end(path, asked_for(1300, {0, 3}));
    const Study part = read_results(path).study;
    CHECK_FALSE(part.complete);
    CHECK(part.scenarios.front().blocks == std::vector<std::int64_t>{0, 3});
    run_and_die(path, asked_for(1300, {1, 3}), 1);
    run_to_end(path, asked_for(1300, {1, 3}, 2));
    run_to_end(path, asked_for(1300, {2, 3}));
    const Study whole = read_results(path).study;
    CHECK(whole.complete);
    CHECK(same_results(whole, undisturbed(asked_for(1300))));
}

TEST_CASE("journal: a run that is stopped has exactly the blocks that were finished") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5";
    for (const std::int64_t blocks : {0, 1, 5, 11, 12}) {
        CAPTURE(blocks);
        Study study = asked_for(1300).study();
        run_study(study, {1300, 1, {}, {}, after(blocks), nullptr});
        CHECK(blocks_in(study) == blocks);
        CHECK(study.complete == (blocks == 12));
        run_to_end(path, asked_for(1300), blocks);
        const Study stored = read_results(path).study;
        CHECK(stored.complete == (blocks == 12));
        CHECK(same_results(stored, study));
        run_to_end(path, asked_for(1300));
        CHECK(same_results(read_results(path).study, undisturbed(asked_for(1300))));
        std::filesystem::remove(path);
    }
}

TEST_CASE("journal: a run of several threads that is stopped goes on with what each had finished") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5";
    const Asked asked = asked_for(6000, {}, 3);
    for (int stops = 0; stops < 6; ++stops) {
        StoredRun run = opened(path, asked);
        std::atomic<int> left = 7;
        run_study(run.study(),
                  {asked.trials, 3, {}, {}, [&] { return left-- <= 0; }, &run.begin(asked.trials, 1 + stops)});
        const std::int64_t there = blocks_in(run.study());
        CHECK(there == std::min(48, 7 * (stops + 1)));
        if (stops % 2 == 0) run.finish({});
    }
    run_to_end(path, asked);
    CHECK(same_results(read_results(path).study, undisturbed(asked)));
}

TEST_CASE("journal: a study that grows and is stopped at once keeps all trials that it had") {
    const TemporaryFolder folder;
    run_to_end(folder / "x.h5", asked_for(600));
    run_to_end(folder / "x.h5", asked_for(1300), 0);
    CHECK(read_results(folder / "x.h5").study.scenarios.front().trials == 768);  // the partial block made whole
    run_to_end(folder / "x.h5", asked_for(1300));
    CHECK(same_results(read_results(folder / "x.h5").study, undisturbed(asked_for(1300))));
}

}  // namespace credence::test::journal_grown_test
