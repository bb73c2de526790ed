// Shards merge to what one run gives, and to nothing else.

#include "files/merge/merge.hpp"

#include "journal_support.hpp"

namespace credence::test::merge_test {

namespace {

/// Shards of one study of two scenarios with detailed trials in the first blocks, in files.
struct Shards {
    TemporaryFolder folder;
    Asked asked{1300, 1, {}, {tiny("a"), tiny("b")}, 1};

    std::string shard(std::int64_t index, std::int64_t count) const { return of(asked, {index, count}); }
    std::string of(Asked other, Shard part) const {
        static int number = 0;
        other.shard = part;
        const std::string path = folder / (std::to_string(number++) + ".h5");
        run_to_end(path, other);
        return path;
    }
};

std::string refused_to_merge(const std::vector<std::string>& paths) {
    return refusal<InputError>([&] { merge_results(paths); });
}

}  // namespace

TEST_CASE("merge: shards in any order give the bytes of one run") {
    const Shards shards;
    std::vector<std::string> paths{shards.shard(0, 3), shards.shard(1, 3), shards.shard(2, 3)};
    run_to_end(shards.folder / "whole.h5", shards.asked);
    const std::string whole = bytes_of(shards.folder / "whole.h5");
    do {
        const Study merged = merge_results(paths);
        CHECK(merged.complete);
        CHECK(missing_text(merged).empty());
        write_results(shards.folder / "merged.h5", merged, run_facts);
        CHECK(bytes_of(shards.folder / "merged.h5") == whole);
    } while (std::next_permutation(paths.begin(), paths.end()));
}

TEST_CASE("merge: files that have the same block are refused by name") {
    const Shards shards;
    const std::string whole = shards.shard(0, 1), half = shards.shard(0, 2), rest = shards.shard(1, 2),
                      third = shards.shard(1, 3);
    CHECK(same_results(merge_results({whole}), undisturbed(shards.asked)));
    const auto said = [](const std::string& file, const std::string& other, int block) {
        return "cannot merge " + file + " with " + other + " (both have block " + std::to_string(block) +
               " of scenario a). Give files of which no two have the same trials.";
    };
    CHECK(refused_to_merge({whole, whole}) == said(whole, whole, 0));
    CHECK(refused_to_merge({half, rest, whole}) == said(whole, half, 0));
    CHECK(refused_to_merge({whole, rest}) == said(rest, whole, 1));
    CHECK(refused_to_merge({half, rest, third}) == said(third, rest, 1));
    CHECK(refused_to_merge({third, half}) == said(half, third, 4));
}

TEST_CASE("merge: details of trials come from whichever file has them") {
    const Shards shards;
    const Study expected = undisturbed(shards.asked);
    const ArmResults& arm = expected.scenarios.front().arms.front();
    REQUIRE(arm.errors.size() > static_cast<std::size_t>(2 * block_size));
    const Study merged = merge_results({shards.shard(1, 2), shards.shard(0, 2)});
    const ArmResults& found = merged.scenarios.front().arms.front();
    REQUIRE(found.errors.size() == arm.errors.size());
    for (std::size_t i = 0; i < arm.errors.size(); ++i)
        REQUIRE((found.errors[i] == arm.errors[i] ||
                 (found.errors[i] != found.errors[i] && arm.errors[i] != arm.errors[i])));
}

TEST_CASE("merge: blocks that no file has are named by scenario") {
    const Shards shards;
    const std::string first = shards.shard(0, 3), last = shards.shard(2, 3);
    const Study merged = merge_results({last, first});
    CHECK_FALSE(merged.complete);
    CHECK(missing_text(merged) == "scenario a lacks blocks 1, 4 of 6; scenario b lacks blocks 1, 4 of 6");
    CHECK(missing_text(merge_results({last})) ==
          "scenario a lacks blocks 0, 1, 3, 4 of 6; scenario b lacks blocks 0, 1, 3, 4 of 6");
    // What was merged of them is a file like a shard's, that can be merged again.
    write_results(shards.folder / "some.h5", merged, {});
    CHECK(same_results(merge_results({shards.folder / "some.h5", shards.shard(1, 3)}), undisturbed(shards.asked)));
}

TEST_CASE("merge: an interrupted run's file is taken as a shard is") {
    const Shards shards;
    const std::string some = shards.folder / "some.h5";
    run_to_end(some, shards.asked, 7);  // all of a, one block of b
    CHECK(missing_text(merge_results({some})) == "scenario b lacks blocks 1 to 5 of 6");
    CHECK(says(refused_to_merge({some, shards.shard(1, 2)}), "(both have block 1 of scenario a)"));
}

TEST_CASE("merge: files of other studies, seeds and trials are refused") {
    const Shards shards;
    const std::string first = shards.shard(0, 2);
    Asked other_seed = shards.asked, other_key = shards.asked, fewer = shards.asked, other_name = shards.asked;
    other_seed.root_seed = 9;
    set_key(other_key.scenarios[1], "sensor.sigma", "0.06");
    fewer.trials = 1299;
    other_name.scenarios[0].name = "z";
    const std::vector<std::pair<Asked, std::string>> others{{other_seed, "its root seed is 9, not 1"},
                                                            {other_key, "sensor.sigma is 0.06 there and 0.05 here"},
                                                            {fewer, "it was asked for 1299 trials, not 1300"},
                                                            {other_name, "scenario"}};
    for (const auto& [asked, why] : others) {
        const std::string foreign = shards.of(asked, {1, 2}), said = refused_to_merge({first, foreign});
        CAPTURE(said, why);
        CHECK(said.starts_with("cannot merge " + foreign + " with " + first + " (it is not of the same study: "));
        CHECK(says(said, why));
    }
    CHECK(says(refused_to_merge({first, shards.folder / "none.h5"}), "cannot be found"));
}

TEST_CASE("merge: shards without a block are taken, first and last") {
    Shards shards;
    shards.asked.trials = 300;
    const std::vector<std::string> paths{shards.shard(2, 3), shards.shard(0, 3), shards.shard(1, 3)};
    CHECK(blocks_in(read_results(paths[0]).study) == 0);
    const Study expected = undisturbed(shards.asked);
    CHECK(same_results(merge_results(paths), expected));
    CHECK(same_results(merge_results({paths[1], paths[2], paths[0]}), expected));
    CHECK(missing_text(merge_results({paths[0]})) ==
          "scenario a lacks blocks 0, 1 of 2; scenario b lacks blocks 0, 1 of 2");
}

}  // namespace credence::test::merge_test
