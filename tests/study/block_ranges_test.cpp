// Sets of blocks as ranges, against sets of numbers.

#include <credence/detail/block_ranges.hpp>

#include "catch.hpp"

#include <algorithm>
#include <random>
#include <set>

namespace credence::test::block_ranges_test {

namespace {

using Numbers = std::set<std::int64_t>;

/// Some of the numbers below 40, many or few of them.
Numbers some_of(std::minstd_rand& random) {
    Numbers numbers;
    const auto share = random() % 5;
    for (std::int64_t block = 0; block < 40; ++block)
        if (random() % 5 <= share) numbers.insert(block);
    return numbers;
}

BlockRanges ranges_of(const Numbers& numbers) { return std::vector<std::int64_t>(numbers.begin(), numbers.end()); }

void check_same(const BlockRanges& ranges, const Numbers& numbers) {
    REQUIRE(ranges.size() == numbers.size());
    CHECK(Numbers(ranges.begin(), ranges.end()) == numbers);
    CHECK(ranges == ranges_of(numbers));
    std::size_t place = 0;
    for (const std::int64_t block : numbers) {
        CHECK(ranges[place] == block);
        CHECK(ranges.place_of(block) == static_cast<std::int64_t>(place++));
    }
    for (std::int64_t block = -1; block < 42; ++block) {
        CHECK(ranges.contains(block) == (numbers.count(block) > 0));
        CHECK(ranges.count_below(block) == std::distance(numbers.begin(), numbers.lower_bound(block)));
    }
    const std::vector<BlockRange> list = ranges.ranges();
    for (std::size_t i = 1; i < list.size(); ++i) CHECK(list[i].first > list[i - 1].last + 1);
}

}  // namespace

TEST_CASE("block ranges: sets of numbers say the same of adding, taking away and what is common") {
    std::minstd_rand random(7);
    for (int repeat = 0; repeat < 60; ++repeat) {
        const Numbers a = some_of(random), b = some_of(random);
        Numbers both, all, rest;
        std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::inserter(all, all.end()));
        std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::inserter(both, both.end()));
        std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::inserter(rest, rest.end()));
        const BlockRanges ours = ranges_of(a), theirs = ranges_of(b);
        BlockRanges together = ours, one_by_one = ours;
        together.add(theirs);
        std::vector<std::int64_t> shuffled(b.begin(), b.end());
        std::shuffle(shuffled.begin(), shuffled.end(), random);
        for (const std::int64_t block : shuffled) one_by_one.add(block);
        check_same(ours, a);
        check_same(together, all);
        check_same(one_by_one, all);
        check_same(ours.common(theirs), both);
        check_same(ours.without(theirs), rest);
        for (const std::int64_t block : both) one_by_one.remove(block);
        Numbers but = all;
        for (const std::int64_t block : both) but.erase(block);
        check_same(one_by_one, but);
    }
}

TEST_CASE("block ranges: all blocks of a study are one range, whatever their number") {
    const std::int64_t many = 4'000'000'000;
    BlockRanges all = BlockRanges::below(many);
    CHECK(all.ranges() == std::vector<BlockRange>{{0, many - 1}});
    CHECK(all.count() == many);
    CHECK(all[3'999'999'999] == many - 1);
    CHECK(BlockRanges::below(0).empty());
    all.remove(5);
    CHECK(all.ranges() == std::vector<BlockRange>{{0, 4}, {6, many - 1}});
    CHECK(all.place_of(6) == 5);
    all.add(BlockRange{3, 9});
    CHECK(all == BlockRanges::below(many));
}

}  // namespace credence::test::block_ranges_test
