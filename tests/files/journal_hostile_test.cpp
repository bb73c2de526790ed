// Forged journals with right checksums: they are refused.
// Kind: foreign files.

#include "journal_forged.hpp"
#include "of_scenarios.hpp"

#include <sys/resource.h>

namespace credence::test::journal_hostile_test {

namespace {

/// No allocation beyond what the process has and `more` bytes succeeds.
class LittleMemory {
public:
    LittleMemory() {
        getrlimit(RLIMIT_AS, &before_);
#if !defined(CREDENCE_SANITIZED) && !defined(__SANITIZE_ADDRESS__)
        const rlimit limit{rlim_t{3} << 30, before_.rlim_max};
        setrlimit(RLIMIT_AS, &limit);
#endif
    }
    ~LittleMemory() { setrlimit(RLIMIT_AS, &before_); }

private:
    rlimit before_{};
};

}  // namespace

TEST_CASE("journal: commits with invalid heads end it as torn ones do") {
    const Made made;
    for (const std::int64_t payload :
         {std::int64_t{0}, std::int64_t{-1}, std::int64_t{19}, std::int64_t{1} << 40,
          std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min()}) {
        ForgedCommit bad = made.record;
        bad.payload = payload;
        CAPTURE(payload);
        CHECK(made.said({bad}).empty());
        CHECK(made.said({made.record, bad}).empty());
    }
}

TEST_CASE("journal: blocks and trials that cannot be are refused") {
    const Made made;
    const std::int64_t most = std::numeric_limits<std::int64_t>::max();
    const std::vector<std::pair<CommitStart, std::string>> starts{
        {{-1, 0, {}}, "an impossible number of trials"},
        {{most_trials + 1, 3, {{0, 3}}}, "an impossible number of trials"},
        {{3, 4, {{0, 3}}}, "an impossible number of trials"},
        {{3, -3, {{0, 3}}}, "an impossible number of trials"},
        {{3, 3, {{1, 3}}}, "a block that the study does not have"},
        {{3, 3, {{-1, 3}}}, "a block that the study does not have"},
        {{3, 3, {{most, 3}}}, "a block that the study does not have"},
        {{3, 3, {{0, -3}}}, "a block that the study does not have"},
        {{3, 3, {{0, 256}}}, "a block that the study does not have"},
        {{3, 0, {{0, 3}}}, "totals and blocks do not agree"},
        {{300, 0, {{1, 44}}}, "is damaged"},
        {{3, 2, {{0, 3}}}, "totals and blocks do not agree"}};
    for (const auto& [start, why] : starts) {
        ForgedCommit bad = made.record;
        bad.start = start;
        const std::string text = made.said({bad});
        CAPTURE(start.trials, start.counted, text);
        CHECK(text.starts_with(made.path + ".journal: is damaged: "));
        CHECK(says(text, why));
    }
    ForgedCommit other = made.record;
    other.scenario = 1;
    CHECK(says(made.said({other}), "a scenario that the study does not have"));
    for (const std::uint32_t blocks : {2u, 1000u, 0xffffffffu}) {
        ForgedCommit bad = made.record;
        bad.blocks = blocks;
        CHECK(says(made.said({bad}), "is damaged"));
    }
    for (const Shard shard : {Shard{0, 0}, Shard{-1, 2}, Shard{2, 2}, Shard{0, -1}}) {
        ForgedCommit bad = made.record;
        bad.start.shard = shard;
        CHECK(says(made.said({bad}), "an impossible shard"));
    }
    ForgedCommit longer{0, {300, 47, {{1, 44}}}, std::string(8000, '\0'), made.record.totals, {}, {}};
    CHECK(says(made.said({made.record, longer}), "is damaged"));
}

TEST_CASE("journal: values and totals that are not the commit's are refused") {
    const Made made;
    ForgedCommit bad = made.record;
    bad.values.pop_back();
    CHECK(says(made.said({bad}), "is damaged"));
    bad = made.record;
    bad.values.clear();
    bad.totals.clear();
    CHECK(says(made.said({bad}), "fewer values than its blocks"));
    for (std::size_t size = 0; size < made.record.totals.size(); ++size) {
        bad = made.record;
        bad.totals.resize(size);
        CAPTURE(size);
        REQUIRE(says(made.said({bad}), "is damaged"));
    }
    bad = made.record;
    bad.totals += '\0';
    CHECK(says(made.said({bad}), "more than the totals"));
    bad = made.record;
    std::fill(bad.totals.begin() + 8, bad.totals.end(), '\xff');
    CHECK(says(made.said({bad}), "is damaged"));
    for (const std::int64_t completed : {std::int64_t{-1}, std::int64_t{4}, std::int64_t{1} << 60}) {
        Study study = made.study;
        study.scenarios.front().arms.front().totals.trials.statuses.front() = completed;
        bad.totals = totals_of(study.scenarios.front());
        CAPTURE(completed);
        CHECK(says(made.said({bad}), "is damaged"));
    }
}

TEST_CASE("journal: any byte of the totals changed under a right checksum is refused or harmless") {
    for (const Keep keep : {Keep::trials, Keep::aggregates}) Made(keep).flip_totals();
}

TEST_CASE("journal: an invalid status is refused when it is read") {
    const Made made;
    const ScenarioResults& results = made.study.scenarios.front();
    const auto at = static_cast<std::size_t>(BlockLayout(results).column_offset(0, column_status, 3));
    for (const char status : {'\x09', '\xff', '\x80'}) {
        ForgedCommit bad = made.record;
        bad.values[at + 1] = status;
        CHECK(says(made.said({bad}), "holds an unknown status"));
    }
}

TEST_CASE("journal: numbers of trials that no memory holds take none") {
    const Made made;
    const LittleMemory limit;
    const JournalHeader header{JournalBase::none, {}, most_trials, {}, definition_of(made.study)};
    put_bytes(made.path + ".journal", header_bytes(header));
    CHECK(opened(made.path, made.asked).study().trials == most_trials);
    // A whole block, but far away: its rows are few.
    const std::int64_t far = most_trials / block_size - 1;
    const Block block = run_block(Problem(made.asked.scenarios.front()), 1, far, block_size);
    Study study = made.asked.study();
    set_blocks(study.scenarios.front(), {far}, most_trials);
    add_totals(study.scenarios.front(), block);
    const auto size = BlockLayout(study.scenarios.front()).size({far, block_size});
    const ForgedCommit record{0,
                        {most_trials, block_size, {{far, block_size}}},
                        std::string(static_cast<std::size_t>(size), '\0'),
                        totals_of(study.scenarios.front()),
                        {},
                        {}};
    put_bytes(made.path + ".journal", made.header + record.bytes());
    CHECK(opened(made.path, made.asked).study().scenarios.front().blocks == std::vector<std::int64_t>{far});
}

TEST_CASE("journal: a header that was made up is refused") {
    const Made made;
    ByteWriter body;
    body.put(static_cast<std::int32_t>(schema_version));
    body.put(std::uint8_t{0});  // trials are kept
    body.put(std::uint8_t{0});
    for (int i = 0; i < 3; ++i) body.put(std::int64_t{0});  // no file was there
    body.put(std::int64_t{3});
    body.put(std::int64_t{0});
    body.put(std::int64_t{1});
    body.put(std::uint64_t{1});
    const auto journal_of = [&](const ByteWriter& rest) {
        const std::string text = body.bytes() + rest.bytes();
        const auto size = static_cast<std::uint32_t>(text.size());
        return sealed("credence-journal" + std::string("\12\0\0\0", 4) +
                      std::string(reinterpret_cast<const char*>(&size), sizeof size) + text);
    };
    const auto said = [&](const std::function<void(ByteWriter&)>& make) {
        ByteWriter rest;
        make(rest);
        put_bytes(made.path + ".journal", journal_of(rest) + made.record.bytes());
        const std::string text = refused(made.path, made.asked);
        std::filesystem::remove(made.path);
        return text;
    };
    CHECK(says(said([](ByteWriter& rest) { rest.put_count(0); }), "it has 0 scenarios"));
    CHECK(says(said([](ByteWriter& rest) { rest.put_count(1); rest.put_text("[nonsense"); }), "scenario"));
    CHECK(says(said([](ByteWriter& rest) { rest.put_count(1); rest.put_text("[scenario]\nposes = 1e9"); }), "poses"));
    const LittleMemory limit;
    CHECK(says(said([](ByteWriter& rest) { rest.put_count(~std::uint64_t{0}); }), "is damaged"));
    CHECK(says(said([](ByteWriter& rest) { rest.put_count(1); rest.put_count(~std::uint64_t{0}); }), "is damaged"));
}

}  // namespace credence::test::journal_hostile_test
