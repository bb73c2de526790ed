// Totals and details that are in memory only while they are needed: the same results, and little memory.

#include "files/merge/merge.hpp"

#include "catch.hpp"
#include "journal_support.hpp"
#include "temporary_folder.hpp"

#include <algorithm>

#if __has_include(<malloc.h>)
#include <malloc.h>
#endif

namespace credence::test::memory_test {

namespace {

Asked some(std::int64_t trials = 700) {
    Asked asked;
    asked.trials = trials;
    asked.scenarios = {tiny("a"), tiny("b"), tiny("c"), tiny("d"), scenario("e")};
    return asked;
}

std::int64_t in_memory(const Study& study) {
    return std::count_if(study.scenarios.begin(), study.scenarios.end(), has_totals);
}

/// Runs without keeping totals of scenarios that are done. Returns how many scenarios had them at most.
std::int64_t compute_with_little(StoredRun& run, const Asked& asked, std::int64_t blocks = all_blocks) {
    std::int64_t most = 0;
    RunOptions options{asked.trials, asked.threads, {}, asked.shard, {}, &run.begin(asked.trials, 1, asked.shard)};
    if (blocks != all_blocks) options.stop = after(blocks);
    options.progress = [&](const Progress&) { most = std::max(most, in_memory(run.study())); };
    options.most_totals = 0;
    run_study(run.study(), options);
    return most;
}

Study results_in(const std::string& path) { return read_results(path).study; }

void drop(Study& study) {
    for (ScenarioResults& results : study.scenarios) drop_totals(results);
}

}  // namespace

TEST_CASE("memory: only scenarios that are computed have totals, and the results are the same") {
    for (const Keep keep : {Keep::trials, Keep::aggregates}) {
        const TemporaryFolder folder;
        Asked asked = some();
        asked.keep = keep;
        CHECK(in_memory(asked.study()) == 0);
        StoredRun run = opened(folder / "x.h5", asked);
        CHECK(compute_with_little(run, asked) == 1);
        CHECK(in_memory(run.study()) == 0);
        CHECK(same_results(run.study(), undisturbed(asked)));
        asked.trials = 1300;  // a partial block is taken back from totals that the journal has
        CHECK(compute_with_little(run, asked) == 1);
        run.finish(run_facts);
        CHECK(same_results(results_in(folder / "x.h5"), undisturbed(asked)));
    }
}

TEST_CASE("memory: totals that are not in memory are found by a run that was stopped, died or grows a file") {
    for (const std::int64_t blocks : {2, 7}) {
        const TemporaryFolder folder;
        const std::string path = folder / "x.h5";
        run_to_end(path, some(300));
        {
            StoredRun run = opened(path, some());
            drop(run.study());
            compute_with_little(run, some(), blocks);  // and die
        }
        {
            StoredRun run = opened(path, some());
            drop(run.study());
            compute_with_little(run, some(), 1);
            run.finish(run_facts);
        }
        StoredRun run = opened(path, some());
        drop(run.study());
        compute_with_little(run, some());
        run.finish(run_facts);
        CAPTURE(blocks);
        CHECK(same_results(results_in(path), undisturbed(some())));
    }
}

TEST_CASE("memory: totals that stay in a results file are those that are read from it") {
    const TemporaryFolder folder;
    run_to_end(folder / "x.h5", some());
    const Study kept = read_results(folder / "x.h5", 0).study,
                unseen = read_results_without_totals(folder / "x.h5").study;
    CHECK(in_memory(kept) == 0);
    CHECK(in_memory(unseen) == 0);
    CHECK(in_memory(results_in(folder / "x.h5")) == 5);
    CHECK(same_results(kept, undisturbed(some())));
    CHECK(same_results(unseen, undisturbed(some())));
    const std::int64_t two = totals_size(kept.scenarios[0], kept.scenarios[0].detailed()) * 5 / 2;
    CHECK(in_memory(read_results(folder / "x.h5", two).study) == 2);
}

TEST_CASE("memory: a merge whose totals stay in the files gives the same results") {
    const TemporaryFolder folder;
    std::vector<std::string> paths;
    for (const std::int64_t shard : {2, 0, 1}) {
        Asked asked = some();
        asked.shard = {shard, 3};
        paths.push_back(folder / ("part" + std::to_string(shard)));
        run_to_end(paths.back(), asked);
    }
    const Study merged = merge_results(paths, 0);
    CHECK(in_memory(merged) == 0);
    CHECK(same_results(merged, undisturbed(some())));
    write_results(folder / "merged.h5", merged, run_facts);
    CHECK(same_results(results_in(folder / "merged.h5"), undisturbed(some())));
}

#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 33) && !defined(CREDENCE_SANITIZED)
namespace {

std::int64_t allocated() {
    const auto now = mallinfo2();
    return static_cast<std::int64_t>(now.uordblks + now.hblkhd);
}

}  // namespace

TEST_CASE("memory: that of a run, of the table and of the file does not grow with the scenarios") {
    const TemporaryFolder folder;
    Asked asked;
    asked.trials = 256;
    asked.scenarios.clear();
    for (int i = 0; i < 40; ++i) {
        asked.scenarios.push_back(scenario("s" + std::to_string(i), "translation"));
        asked.scenarios.back().arms.controllers = {Controller::fixed};
        asked.scenarios.back().poses = 20;
    }
    const std::int64_t before = allocated();
    StoredRun run = opened(folder / "x.h5", asked);
    std::int64_t all = 0, most = 0;
    for (const ScenarioResults& results : run.study().scenarios) all += totals_size(results, asked.trials);
    RunOptions options{asked.trials, 1, {}, {}, {}, &run.begin(asked.trials, 1)};
    options.progress = [&](const Progress&) { most = std::max(most, allocated() - before); };
    options.most_totals = 0;
    run_study(run.study(), options);
    CAPTURE(most, all);
    CHECK(most < all / 4);
    run.finish(run_facts);
    CHECK(allocated() - before < all / 4);
}
#endif

}  // namespace credence::test::memory_test
