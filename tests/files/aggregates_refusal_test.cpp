// Files and journals of aggregates that are damaged or hostile are refused by name and place.
// Kind: foreign files.

#include "files/hdf5/read.hpp"
#include "journal_forged.hpp"
#include "store_damage.hpp"

namespace credence::test::aggregates_refusal_test {

namespace {

const std::string fixed = "/first/fixed.ekf", arm = "/first/greedy.ekf";

/// 300 trials, two blocks.
Study some_aggregates() {
    Study study = new_study({scenario("first")}, 1, Keep::aggregates);
    run_study(study, {300, 1, {}});
    return study;
}

using Numbers = std::vector<std::int64_t>;

Change numbers(const std::string& path, const Numbers& values) {
    return replaced<std::int64_t>(path, {values.size()}, values);
}

/// Blocks of both arms, which must be the same.
Change blocks(const Numbers& first, const Numbers& last) {
    return [=](const Handle& root) {
        for (const std::string& group : {fixed, arm}) {
            numbers(group + "/first_block", first)(root);
            numbers(group + "/last_block", last)(root);
        }
    };
}

const char* const no_ranges = "/first_block: and last_block are no ranges of the study's blocks, rising and apart";

const std::vector<Damage> damages{
    {"/@keep: is not aggregates", with_text("/", "keep", "trials")},
    {"/@keep: is not text", with_number<double>("/", "keep", 1)},
    {fixed + "/log_score: is missing", without_attribute("/", "keep")},
    {fixed + "/trace_P: does not belong here", replaced<double>(fixed + "/trace_P", {300})},
    {fixed + "/difference_count: does not belong here", replaced<std::int64_t>(fixed + "/difference_count", {0, 6})},
    {arm + "/difference_total: is missing", without(arm + "/difference_total")},
    {fixed + no_ranges, blocks({-1}, {0})},
    {fixed + no_ranges, blocks({1}, {0})},
    {fixed + no_ranges, blocks({0}, {2})},
    {fixed + no_ranges, blocks({0, 1}, {0, 1})},
    {fixed + no_ranges, blocks({0, 0}, {1, 1})},
    {fixed + no_ranges, blocks({0}, {std::numeric_limits<std::int64_t>::max()})},
    {fixed + "/last_block: has extents [1], not [2]", blocks({0, 2}, {1})},
    {fixed + "/first_block: is not a list", replaced<std::int64_t>(fixed + "/first_block", {1, 1})},
    {fixed + "/first_block: holds 32-bit integers", replaced<std::int32_t>(fixed + "/first_block", {1})},
    {arm + "/first_block: is not the same in every arm", numbers(arm + "/last_block", {0})},
    {fixed + "/status_count: adds up to 300 trials, but the blocks have 256", blocks({0}, {0})},
    {fixed + "/status_count: adds up to 300 trials, but the blocks have 0", blocks({}, {})},
    {arm + "/status_count: a number of trials is below 0", numbers(arm + "/status_count", {301, -1, 0, 0})},
    {arm + "/status_count: adds up to 301", numbers(arm + "/status_count", {300, 1, 0, 0})},
    {arm + "/status_count: has extents [3], not [4]", numbers(arm + "/status_count", {300, 0, 0})},
    {arm + "/status_code: does not count on", replaced<std::int8_t>(arm + "/status_code", {4}, {0, 1, 2, 4})},
    {arm + "@counted_trials: counts 299 trials, but the totals are of 300",
     with_number<std::int64_t>(arm, "counted_trials", 299)},
    {arm + "/column: does not count on", replaced<std::int32_t>(arm + "/column", {8}, {0, 1, 1})},
    {arm + "/column: has extents [9], not [8]", replaced<std::int32_t>(arm + "/column", {9})},
    {arm + "/status_count: a column has more values than trials",
     numbers(arm + "/column_count", {300, 300, 301, 300, 300, 300, 300, 300})},
    {arm + "/status_count: a column has more values than trials",
     numbers(arm + "/column_count", {300, 300, -1, 300, 300, 300, 300, 300})},
    {arm + "/column_total: its parts do not follow",
     [](auto& r) {
         const auto extents =
             hdf5::Dataset(hdf5::open_group(hdf5::open_group(r, "first"), "greedy.ekf"), "column_total").extents();
         replace<double>(r, arm + "/column_total", extents, {1, 1});
     }},
    {arm + "/subtracted_arm: has extents [2], not [1]", replaced<std::int32_t>(arm + "/subtracted_arm", {2}, {0, 1})},
    {arm + "/status_count: there are more pairs than values",
     replaced<std::int64_t>(arm + "/difference_count", {1, 8}, {301})},
    {arm + "/status_count: more pairs differ than there are",
     replaced<std::int64_t>(arm + "/difference_above", {1, 8}, {301})},
    {arm + "/status_count: more pairs differ than there are",
     replaced<std::int64_t>(arm + "/difference_below", {1, 8}, {-1})},
    {fixed + "/first_block: [1099511627776] does not fit",
     [](auto& r) { promise_terabytes(r, fixed + "/first_block"); }},
    {fixed + "/last_block: keeps its values in other files",
     [](auto& r) {
         keep_elsewhere(r, fixed + "/last_block");
         replace<std::int64_t>(r, fixed + "/first_block", {5}, {0, 2, 4, 6, 8});
     }},
};

}  // namespace

TEST_CASE("aggregates: files whose parts do not agree with the scenario or each other are refused") {
    require_refused(some_aggregates(), damages);
}

TEST_CASE("aggregates: a journal's ranges of blocks that cannot be are refused, and take no memory") {
    const Made made(Keep::aggregates);
    CHECK(made.said({made.record}).empty());
    const std::int64_t most = std::numeric_limits<std::int64_t>::max(), far = most_trials / block_size - 1;
    const std::vector<std::pair<CommitStart, std::string>> starts{
        {{3, 3, {}, {}, {{0, 1}}}, "a block that the study does not have"},
        {{3, 3, {}, {}, {{-1, 0}}}, "a block that the study does not have"},
        {{3, 3, {}, {}, {{1, 0}}}, "a block that the study does not have"},
        {{3, 3, {}, {}, {{0, most}}}, "a block that the study does not have"},
        {{3, 3, {}, {}, {{-most, 0}}}, "a block that the study does not have"},
        {{3, 2, {}, {}, {{0, 0}}}, "totals and blocks do not agree"},
        {{most_trials, most_trials, {}, {}, {{0, far}}}, "a record has fewer values than its blocks"},
        {{most_trials, 3, {}, {}, {{100, far}}}, "is damaged"}};
    for (const auto& [start, why] : starts) {
        ForgedCommit bad = made.record;
        bad.start = start;
        const std::string text = made.said({bad});
        CAPTURE(start.trials, start.counted, text);
        CHECK(says(text, why));
    }
    for (const std::uint32_t ranges : {2u, 1000u, 0xffffffffu}) {
        ForgedCommit bad = made.record;
        bad.blocks = ranges;
        CHECK(says(made.said({bad}), "is damaged"));
    }
    ForgedCommit twice = made.record;
    twice.start.ranges.assign(20, {0, 0});
    twice.values.append(20 * made.record.values.size(), '\0');
    CHECK(says(made.said({twice}), "a block is there twice"));
}

TEST_CASE("aggregates: totals in a journal that no trials could give are refused, and cut ones") {
    const Made made(Keep::aggregates);
    ForgedCommit bad = made.record;
    for (std::size_t size = 0; size < made.record.totals.size(); ++size) {
        bad.totals = made.record.totals.substr(0, size);
        REQUIRE(says(made.said({bad}), "is damaged"));
    }
    const auto said = [&](const std::function<void(TrialTotals&)>& change) {
        Study study = made.study;
        change(study.scenarios.front().arms.front().totals.trials);
        bad.totals = totals_of(study.scenarios.front());
        return made.said({bad});
    };
    CHECK(said([](TrialTotals&) {}).empty());
    CHECK(says(said([](TrialTotals& arm) { arm.statuses[0] = 4; }), "an impossible number of trials"));
    CHECK(says(said([](TrialTotals& arm) { arm.statuses = {2, 0, 1, 0}; }), "is damaged"));
    CHECK(says(said([](TrialTotals& arm) { arm.statuses[0] = -1; }), "a count is too large"));
    CHECK(says(said([](TrialTotals& arm) { arm.columns[0].count = 4; }), "a column has more values than trials"));
}

TEST_CASE("aggregates: a journal of trials is not read as one of aggregates, nor the other way round") {
    const Made trials, aggregates(Keep::aggregates);
    for (const auto& [one, other] : {std::pair(&trials, &aggregates), std::pair(&aggregates, &trials)}) {
        put_bytes(one->path + ".journal", one->header + other->record.bytes());
        CHECK(says(refused(one->path, one->asked), "is damaged"));
        std::filesystem::remove(one->path);
        std::filesystem::remove(one->path + ".journal");
    }
}

}  // namespace credence::test::aggregates_refusal_test
