// A journal that is cut or damaged anywhere keeps the commits before that place, and the study ends the same.

#include "journal_support.hpp"

#include <stdlib.h>
#include <unistd.h>

namespace credence::test::journal_test {

namespace {

/// Temporary folders are made in memory where there is such a place: thousands of syncs are nothing for a disk.
/// business.
class InMemory {
public:
    InMemory() {
        if (const char* set = getenv("TMPDIR")) before_ = set;
        if (access("/dev/shm", W_OK) == 0) setenv("TMPDIR", "/dev/shm", 1);
    }
    ~InMemory() {
        if (before_) setenv("TMPDIR", before_->c_str(), 1);
        else unsetenv("TMPDIR");
    }

private:
    std::optional<std::string> before_;
};

/// A folder with a journal of three commits, as bytes.
struct Interrupted {
    InMemory in_memory;
    TemporaryFolder folder;
    Asked asked;
    std::string path = folder / "x.h5", journal = path + ".journal";
    std::string bytes = [this] {
        run_and_die(path, asked);
        return bytes_of(journal);
    }();
    std::vector<std::size_t> ends = commit_ends(bytes);

    /// Records that end within the first `size` bytes.
    std::int64_t whole_commits(std::size_t size) const {
        const auto end = std::upper_bound(ends.begin(), ends.end(), size);
        return std::max<std::int64_t>(0, end - ends.begin() - 1);
    }
    /// Finishes with these bytes as journal; returns whether the results are those of the undisturbed study.
    bool ends_the_same(const std::string& damaged, const Study& expected) const {
        put_bytes(journal, damaged);
        run_to_end(path, asked);
        const bool same = same_results(read_results(path).study, expected) && folder.entries() == 1;
        std::filesystem::remove(path);
        return same;
    }
};

}  // namespace

TEST_CASE("journal: cut at any byte, it has every commit before the cut, and nothing else", "[long]") {
    const Interrupted run;
    REQUIRE(run.ends.size() == 1 + 3);
    REQUIRE(run.ends.back() == run.bytes.size());
    for (std::size_t size = 0; size <= run.bytes.size(); ++size) {
        put_bytes(run.journal, run.bytes.substr(0, size));
        CAPTURE(size, run.bytes.size());
        const StoredRun resumed = opened(run.path, run.asked);
        REQUIRE(blocks_in(resumed.study()) == run.whole_commits(size));
        const std::int64_t records = run.whole_commits(size);
        if (size >= run.ends.front())
            REQUIRE(bytes_of(run.journal).size() == run.ends[static_cast<std::size_t>(records)]);
    }
}

TEST_CASE("journal: cut anywhere, the study that goes on ends the same") {
    const Interrupted run;
    const Study expected = undisturbed(run.asked);
    for (std::size_t size = 0; size <= run.bytes.size(); size += 131)
        REQUIRE(run.ends_the_same(run.bytes.substr(0, size), expected));
    for (const std::size_t end : run.ends)
        for (const std::size_t size : {end - 1, end, end + 1})
            REQUIRE(run.ends_the_same(run.bytes.substr(0, size), expected));
    CHECK(run.ends_the_same(run.bytes + run.bytes.substr(0, 100), expected));
    CHECK(run.ends_the_same(run.bytes + std::string(100000, '\0'), expected));
}

TEST_CASE("journal: any byte flipped is refused, or costs no commit before it", "[long]") {
    const Interrupted run;
    for (std::size_t at = 0; at < run.bytes.size(); ++at) {
        std::string bad = run.bytes;
        bad[at] = static_cast<char>(bad[at] ^ (1 << at % 8));
        put_bytes(run.journal, bad);
        CAPTURE(at);
        const std::string said = refusal<InputError>([&] {
            const StoredRun resumed = opened(run.path, run.asked);
            // The header alone cannot be distinguished from one that was torn while it was written.
            REQUIRE(blocks_in(resumed.study()) == run.whole_commits(at));
        });
        if (!said.empty()) REQUIRE(said.starts_with(run.journal + ": "));
        if (at >= run.ends.front()) REQUIRE(said.empty());
    }
}

TEST_CASE("journal: with any commit damaged the study ends the same") {
    const Interrupted run;
    const Study expected = undisturbed(run.asked);
    for (std::size_t at = run.ends.front(); at < run.bytes.size(); at += 97) {
        std::string bad = run.bytes;
        bad[at] = static_cast<char>(~bad[at]);
        CAPTURE(at);
        REQUIRE(run.ends_the_same(bad, expected));
    }
}

TEST_CASE("journal: left after the results file was renamed into place it is only removed") {
    const Interrupted run;
    const Study expected = undisturbed(run.asked);
    REQUIRE(run.ends_the_same(run.bytes, expected));
    // So it is with a file that was there before, and with one that was to be replaced.
    for (const bool grown : {true, false}) {
        const Asked before{2, grown ? 1u : 9u, {}, run.asked.scenarios, 1};
        run_to_end(run.path, before, all_blocks, Start::overwrite);
        run_and_die(run.path, run.asked, all_blocks, grown ? Start::resume : Start::overwrite);
        const std::string journal = bytes_of(run.journal);
        run_to_end(run.path, run.asked);
        const std::string file = bytes_of(run.path);
        put_bytes(run.journal, journal);
        CHECK(blocks_in(opened(run.path, run.asked).study()) == 3);
        run_to_end(run.path, run.asked);
        CHECK(bytes_of(run.path) == file);
        CHECK(run.folder.entries() == 1);
        std::filesystem::remove(run.path);
    }
}

}  // namespace credence::test::journal_test
