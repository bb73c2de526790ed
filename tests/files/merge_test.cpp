// Shards merge to what one run gives, and to nothing else.

#include "files/merge/merge.hpp"

#include "journal_support.hpp"
#include "store_damage.hpp"

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

TEST_CASE("merge: a file alone, twice, beside others that have its blocks") {
    const Shards shards;
    const Study expected = undisturbed(shards.asked);
    const std::string whole = shards.shard(0, 1), first = shards.shard(0, 2), second = shards.shard(1, 2);
    const std::vector<std::string> thirds{shards.shard(0, 3), shards.shard(1, 3), shards.shard(2, 3)};
    const std::vector<std::vector<std::string>> unions{
        {whole},          {whole, whole},  {first, whole},
        {whole, second},  {first, second, first},
        {first, thirds[0], thirds[1], thirds[2]},
        {thirds[2], first, thirds[1], second, thirds[0], whole}};
    for (const std::vector<std::string>& paths : unions) {
        CAPTURE(paths.size());
        const Study merged = merge_results(paths);
        CHECK(merged.complete);
        CHECK(same_results(merged, expected));
    }
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

TEST_CASE("merge: the same block with other values is refused by trials, arm and column") {
    const Shards shards;
    const std::string good = shards.shard(0, 2), bad = shards.folder / "bad.h5";
    damaged_copy(good, bad, [&](const Handle& root) {
        const Handle column = open(root, "/b/fixed.ekf/pose_error");
        const hsize_t row = 300, one = 1;  // of block 2, trials 512 to 767
        const Handle file(H5Dget_space(column.id()), H5Sclose, bad, "space"),
            memory(H5Screate_simple(1, &one, nullptr), H5Sclose, bad, "space");
        H5Sselect_hyperslab(file.id(), H5S_SELECT_SET, &row, nullptr, &one, nullptr);
        const double value = 0.125;
        REQUIRE(H5Dwrite(column.id(), H5T_NATIVE_DOUBLE, memory.id(), file.id(), H5P_DEFAULT, &value) >= 0);
        forget_checksum(column);
    });
    const std::string said = refused_to_merge({shards.shard(1, 2), good, bad});
    CAPTURE(said);
    CHECK(said.starts_with("cannot merge " + bad + " with " + good +
                           " (trials 512 to 767 of b/fixed.ekf differ in pose_error)"));
    CHECK_FALSE(refused_to_merge({bad, good}).empty());
}

TEST_CASE("merge: totals of blocks that several files have contradict each other, whichever comes first") {
    Shards shards;
    shards.asked.scenarios = {tiny("b")};
    for (const Keep keep : {Keep::trials, Keep::aggregates}) {
        shards.asked.keep = keep;
        const std::string half = shards.shard(0, 2), rest = shards.shard(1, 2), whole = shards.shard(0, 1),
                          third = shards.shard(0, 3);
        const auto bad = [&](const std::string& good) {
            return damaged_copy(good, good + "-bad.h5", [](const Handle& root) {
                scale(root, "/b/fixed.ekf/nees_pose_total", 2);  // no column says it
            });
        };
        // The same blocks; some that another has all of, and the other way round; blocks shared in part; two that make
        // up a third one. In their order, and the other way round.
        std::vector<std::vector<std::string>> unions{{half, bad(half)}, {whole, bad(third)}, {third, bad(whole)},
                                                     {half, bad(third)}, {third, half + "-bad.h5"},
                                                     {half, rest, whole + "-bad.h5"}, {half + "-bad.h5", rest, whole}};
        if (keep == Keep::aggregates) unions.resize(4);
        for (std::vector<std::string>& paths : unions) {
            for (int order = 0; order < 2; ++order) {
                const std::string said = refused_to_merge(paths);
                CAPTURE(paths, said);
                CHECK(said.starts_with("cannot merge "));
                CHECK(says(said, "-bad.h5"));
                CHECK(says(said, " totals of b "));
                std::reverse(paths.begin(), paths.end());
            }
        }
        CHECK(same_results(merge_results({whole, third, half, rest}), undisturbed(shards.asked)));
    }
}

TEST_CASE("merge: the same block with other errors of its trials is refused") {
    const Shards shards;
    const std::string good = shards.shard(0, 2);
    const std::string bad = damaged_copy(good, shards.folder / "bad.h5", [](const Handle& root) {
        scale(root, "/a/fixed.ekf/detailed_error", 2);
    });
    CHECK(says(refused_to_merge({bad, good}), "of a/fixed.ekf differ in their errors"));
    CHECK(says(refused_to_merge({good, bad}), "of a/fixed.ekf differ in their errors"));
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

TEST_CASE("merge: an interrupted run's file merges like a shard") {
    const Shards shards;
    const std::string some = shards.folder / "some.h5";
    run_to_end(some, shards.asked, 7);  // all of a, one block of b
    CHECK(missing_text(merge_results({some})) == "scenario b lacks blocks 1 to 5 of 6");
    const Study merged = merge_results({some, shards.shard(0, 2), shards.shard(1, 2)});
    CHECK(same_results(merged, undisturbed(shards.asked)));
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
