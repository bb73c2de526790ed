// Files that exist before a run or appear during it: results are never mixed, replaced without --overwrite, or lost.

#include "files/system/system_file.hpp"
#include "journal_support.hpp"

#include "report/watch/watch.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace credence::test::stored_run_test {

namespace {

/// Copies bytes into a file that stays the same one, as `cp` does.
void copy_into(const std::string& from, const std::string& to) { put_bytes(to, bytes_of(from)); }

struct Folder {
    TemporaryFolder folder;
    std::string path = folder / "x.h5", journal = path + ".journal";
    Asked asked{3, 1, {}, {tiny("a"), tiny("b")}};

    Asked of(std::int64_t trials, std::uint64_t seed = 1) const {
        Asked other = asked;
        other.trials = trials;
        other.root_seed = seed;
        return other;
    }
    /// The study goes on and ends as it should.
    void check_goes_on() const {
        run_to_end(path, asked);
        CHECK(same_results(read_results(path).study, undisturbed(asked)));
        CHECK_FALSE(std::filesystem::exists(journal));
    }
};

std::string failure_of(StoredRun& run) {
    return refusal<Failure>([&] { run.finish({}); });
}

/// Changes a byte of a file that another program has open.
void change(const std::string& path, std::size_t at) {
    std::string bytes = bytes_of(path);
    bytes[at] = static_cast<char>(~bytes[at]);
    put_bytes(path, bytes);
}

}  // namespace

TEST_CASE("stored run: a symbolic link and the file that it leads to have one journal and one writer") {
    const Folder here;
    std::filesystem::create_directory(here.folder / "disk");
    const std::string real = here.folder / "disk/real.h5";
    std::filesystem::create_symlink("disk/real.h5", here.path);
    {
        StoredRun first = opened(here.path, here.asked, Start::fresh), second = opened(real, here.asked, Start::fresh);
        compute(first, here.asked, 1);
        CHECK(std::filesystem::exists(real + ".journal"));
        CHECK_FALSE(std::filesystem::exists(here.journal));
        CHECK(says(refusal<InputError>([&] { second.begin(3); }), "another program is writing it"));
        CHECK(says(refused(real, here.asked), "another program is writing it"));
        CHECK(RunWatch(here.path).snapshot().state == RunState::running);
    }
    run_to_end(here.path, here.asked);
    CHECK(std::filesystem::is_symlink(here.path));
    CHECK(same_results(read_results(real).study, undisturbed(here.asked)));
    // A longer study is not replaced by a shorter one through the other name.
    CHECK(says(refused(real, here.of(2)), "asked for 3 already"));
}

TEST_CASE("stored run: a file that appears under the name while the run goes on is not replaced") {
    const Folder here;
    for (const Start start : {Start::fresh, Start::overwrite, Start::resume}) {
        {
            StoredRun run = opened(here.path, here.asked, start);
            compute(run, here.asked);
            put_bytes(here.path, "mine");
            CHECK(says(failure_of(run), "a file of that name appeared in the meantime"));
        }
        CHECK(bytes_of(here.path) == "mine");
        CHECK(here.folder.entries() == 2);
        std::filesystem::remove(here.path);
        CHECK(blocks_in(opened(here.path, here.asked).study()) == 2);  // nothing is computed again
        here.check_goes_on();
        std::filesystem::remove(here.path);
    }
}

TEST_CASE("stored run: results that are changed or replaced while they are grown are not mixed with what is computed") {
    const Folder here;
    run_to_end(here.folder / "base.h5", here.of(2));
    run_to_end(here.folder / "other.h5", here.of(2, 7));
    const std::vector<std::function<void()>> changes{
        [&] { copy_into(here.folder / "other.h5", here.path); },
        [&] { std::filesystem::rename(here.folder / "copy.h5", here.path); },
        [&] { std::filesystem::remove(here.path); },
        [&] { put_bytes(here.path, ""); }};
    for (const auto& change : changes) {
        copy_into(here.folder / "base.h5", here.path);
        copy_into(here.folder / "other.h5", here.folder / "copy.h5");
        {
            StoredRun run = opened(here.path, here.asked);
            compute(run, here.asked);
            change();
            CHECK(
                says(failure_of(run), "another program changed, replaced or removed it while the run went on with it"));
        }
        CHECK(std::filesystem::exists(here.journal));
        const std::string said = refused(here.path, here.asked);
        CHECK_FALSE(said.empty());
        copy_into(here.folder / "base.h5", here.path);
        CHECK(blocks_in(opened(here.path, here.asked).study()) == 2);
        here.check_goes_on();
    }
}

TEST_CASE("stored run: what another program does to the journal is refused, and never copied into the results") {
    const Folder here;
    const auto size = [&] { return std::filesystem::file_size(here.journal); };
    SECTION("between two commits") {
        {
            StoredRun run = opened(here.path, here.asked);
            compute(run, here.asked, 1);
            REQUIRE(truncate(here.journal.c_str(), 100) == 0);
            const std::string said = refusal<Failure>([&] { compute(run, here.asked); });
            CHECK(says(said, "cannot write " + here.journal + " (another program changed it: it has 100 bytes, "));
        }
        CHECK(size() == 100);  // nothing was written behind a gap
    }
    SECTION("after the last one") {
        const std::vector<std::function<void()>> changes{
            [&] { REQUIRE(truncate(here.journal.c_str(), static_cast<off_t>(size() - 1)) == 0); },
            [&] { REQUIRE(truncate(here.journal.c_str(), 0) == 0); },
            [&] { change(here.journal, size() - 1); },
            [&] { change(here.journal, size() / 2); },
            [&] { change(here.journal, 30); },
            [&] { put_bytes(here.journal, std::string(size(), '\0')); },
            [&] { copy_into(here.folder / "other.h5.journal", here.journal); }};
        run_and_die(here.folder / "other.h5", here.of(3, 2));
        for (const auto& damage : changes) {
            {
                StoredRun run = opened(here.path, here.asked);
                compute(run, here.asked);
                damage();
                const std::string said = failure_of(run);
                CAPTURE(said);
                CHECK(says(said, "cannot read back " + here.journal + " (another program changed it"));
            }
            CHECK_FALSE(std::filesystem::exists(here.path));
            if (bytes_of(here.journal).substr(0, 16) != "credence-journal" || !refused(here.path, here.asked).empty())
                std::filesystem::remove(here.journal);
            here.check_goes_on();
            std::filesystem::remove(here.path);
        }
    }
    SECTION("when it replaces it") {
        StoredRun run = opened(here.path, here.asked);
        compute(run, here.asked);
        put_bytes(here.folder / "new", "another's");
        std::filesystem::rename(here.folder / "new", here.journal);
        CHECK(failure_of(run).empty());  // what was written is there, under no name
        CHECK(same_results(read_results(here.path).study, undisturbed(here.asked)));
        CHECK(bytes_of(here.journal) == "another's");
        std::filesystem::remove(here.journal);
    }
}

TEST_CASE("stored run: a results file that only its owner may read stays so, and so is its journal") {
    const Folder here;
    run_to_end(here.path, here.of(2));
    REQUIRE(chmod(here.path.c_str(), 0600) == 0);
    run_and_die(here.path, here.asked, 1);
    CHECK(permissions_of(here.journal) == 0600);
    run_to_end(here.path, here.asked);
    CHECK(permissions_of(here.path) == 0600);
    run_to_end(here.path, here.of(3, 5), all_blocks, Start::overwrite);
    CHECK(permissions_of(here.path) == 0600);
}

TEST_CASE("stored run: a journal beside a results file of the same study that it does not know") {
    const Folder here;
    Asked asked = here.asked, shard = asked;
    asked.trials = shard.trials = 1300;
    shard.shard = {1, 2};
    const auto put = [&](const Asked& file, const Asked& run, std::int64_t blocks, Start start = Start::resume) {
        for (const std::string& path : {here.path, here.journal}) std::filesystem::remove(path);
        run_to_end(here.folder / "merged.h5", file, all_blocks, Start::overwrite);
        run_and_die(here.path, run, blocks, start);
        std::filesystem::rename(here.folder / "merged.h5", here.path);
    };
    SECTION("the file has all: the journal goes, the file stays") {
        for (const Start start : {Start::resume, Start::overwrite}) {
            put(asked, shard, 4, start);
            const std::string file = bytes_of(here.path);
            run_to_end(here.path, asked);
            CHECK(bytes_of(here.path) == file);
            CHECK(here.folder.entries() == 1);
            put(asked, shard, 4, start);
            Asked more = asked;
            more.trials = 1600;
            run_and_die(here.path, more, 1);
            run_to_end(here.path, more);
            CHECK(same_results(read_results(here.path).study, undisturbed(more)));
        }
    }
    SECTION("the journal has all: it goes on") {
        put(here.of(256), asked, 8);
        CHECK(blocks_in(opened(here.path, asked).study()) == 8);
        run_to_end(here.path, asked);
        CHECK(same_results(read_results(here.path).study, undisturbed(asked)));
    }
    SECTION("each has what the other lacks: nothing is lost") {
        put(here.of(700), shard, 4);
        const std::string file = bytes_of(here.path), journal = bytes_of(here.journal);
        const std::string said = refused(here.path, asked);
        CHECK(said == "cannot resume " + here.path + " (it and " + here.journal +
                          " each have trials that the other lacks). Move it away, --resume, and merge both.");
        CHECK(bytes_of(here.path) == file);
        CHECK(bytes_of(here.journal) == journal);
    }
    SECTION("another study's file, or journal, is named with what to do") {
        put(here.of(3, 9), asked, 4);
        CHECK(says(refused(here.path, asked), "Move it away to resume " + here.journal));
        CHECK(says(refused(here.path, here.of(3, 9)), "remove the journal if it is not to be finished"));
    }
    SECTION("the file that a journal grows was replaced") {
        std::filesystem::remove(here.path);
        run_to_end(here.path, here.of(600));
        run_and_die(here.path, asked, 2);
        run_to_end(here.folder / "merged.h5", here.of(256));
        std::filesystem::rename(here.folder / "merged.h5", here.path);
        CHECK(says(refused(here.path, asked), here.path + " is not the file that it extends"));
    }
}

}  // namespace credence::test::stored_run_test
