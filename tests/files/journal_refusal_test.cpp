// Journals of other studies are refused, and the message names the difference.
// Kind: foreign files.

#include "journal_support.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

namespace credence::test::journal_refusal_test {

namespace {

/// A journal of another version, with its checksum right.
std::string with_version(std::string header, std::size_t at, std::uint32_t version) {
    header.resize(header.size() - sizeof(std::uint32_t));
    std::memcpy(header.data() + at, &version, sizeof version);
    return sealed(header);
}

}  // namespace

TEST_CASE("journal: of another study is refused by what differs, and stays as it is") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5", journal = path + ".journal";
    run_and_die(path, {}, 2);
    const std::string before = bytes_of(journal);
    Asked other_seed, fewer_scenarios, other_order, other_key;
    other_seed.root_seed = 7;
    fewer_scenarios.scenarios.pop_back();
    std::swap(other_order.scenarios[0], other_order.scenarios[1]);
    set_key(other_key.scenarios[2], "noise.walk", "0.25");
    const std::vector<std::pair<Asked, std::string>> others{{other_seed, "its root seed is 1, not 7"},
                                                            {fewer_scenarios, "it has 3 scenarios, not 2"},
                                                            {other_order, "scenario.name is a there and b here"},
                                                            {other_key, "noise.walk is 0.3 there and 0.25 here"}};
    for (const auto& [asked, difference] : others) {
        const std::string said = refused(path, asked);
        CAPTURE(said, difference);
        CHECK(said.starts_with("cannot resume " + journal + " (it holds another study: "));
        CHECK(says(said, difference));
        CHECK(said.ends_with("."));
    }
    CHECK(bytes_of(journal) == before);
    CHECK(folder.entries() == 1);
}

TEST_CASE("journal: of another version, or none at all, is refused") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5", journal = path + ".journal";
    run_and_die(path, {}, 0);
    const std::string header = bytes_of(journal);
    const std::vector<std::pair<std::string, std::string>> others{
        {with_version(header, 16, 1), "is a journal of version 1, this program's is 10"},
        {with_version(header, header_prefix, 77), "is of schema version 77, this program's is "},
        {"trial,trace_P\n0,0.1\n", "is not a journal of credence"},
        {"credence-journey" + header.substr(16), "is not a journal of credence"},
        {"\x89HDF\r\n\x1a\n" + std::string(2000, '\0'), "is not a journal of credence"}};
    for (const auto& [bytes, why] : others) {
        put_bytes(journal, bytes);
        const std::string said = refused(path, {});
        CAPTURE(said, why);
        CHECK(said.starts_with(journal + ": " + why));
        CHECK(says(said, ". "));
        CHECK(bytes_of(journal) == bytes);
    }
}

TEST_CASE("journal: what is in its place and is no file is refused") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5", journal = path + ".journal";
    put_bytes(folder / "precious", "mine");
    const std::vector<std::function<void()>> obstacles{
        [&] { std::filesystem::create_directory(journal); },
        [&] { REQUIRE(mkfifo(journal.c_str(), 0600) == 0); },
        [&] { std::filesystem::create_symlink("nowhere", journal); },
        [&] { std::filesystem::create_symlink("precious", journal); },
        [&] { std::filesystem::create_symlink("x.h5.journal", journal); }};
    for (const auto& put : obstacles) {
        put();
        for (const Start start : {Start::fresh, Start::resume, Start::overwrite}) {
            const std::string said =
                refusal<std::runtime_error>([&] { run_to_end(path, {}, all_blocks, start); });
            CAPTURE(said);
            CHECK(says(said, "cannot write "));
            CHECK(says(said, "x.h5.journal"));
        }
        std::filesystem::remove(journal);
    }
    CHECK(bytes_of(folder / "precious") == "mine");
    CHECK(folder.entries() == 1);
}

TEST_CASE("journal: a second writer is turned away, whatever it wants") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5";
    {
        StoredRun first = opened(path, {}, Start::fresh), second = opened(path, {}, Start::fresh);
        first.begin(3);
        CHECK(says(refusal<InputError>([&] { second.begin(3); }), "another program is writing it"));
        for (const Start start : {Start::resume, Start::overwrite})
            CHECK(says(refused(path, {}, start), "another program is writing it"));
        CHECK(says(refused(path, {}, Start::fresh), "an interrupted run left"));
    }
    CHECK(refused(path, {}).empty());
    // One that looked before the other began, and begins after it died, finds that something is there.
    const std::string again = folder / "y.h5";
    StoredRun late = opened(again, {}, Start::fresh);
    run_and_die(again, {}, 1);
    CHECK(says(refusal<InputError>([&] { late.begin(3); }), "another run has just begun"));
}

TEST_CASE("journal: nothing that is there is replaced unasked") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5", journal = path + ".journal";
    run_and_die(path, {}, 2);
    const std::string before = bytes_of(journal);
    CHECK(says(refused(path, {}, Start::fresh), "an interrupted run left " + journal));
    CHECK(says(refused(path, {}, Start::fresh), "--resume or --overwrite"));
    CHECK(bytes_of(journal) == before);
    run_to_end(path, {});
    const std::string file = bytes_of(path);
    CHECK(says(refused(path, {}, Start::fresh), "it is there already"));
    CHECK(bytes_of(path) == file);
}

TEST_CASE("journal: --overwrite keeps the old file until the new one is whole, and takes a journal of any study") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5", journal = path + ".journal";
    Asked other;
    other.root_seed = 5;
    run_to_end(path, other);
    const std::string before = bytes_of(path);
    run_and_die(path, {}, 2, Start::overwrite);
    CHECK(bytes_of(path) == before);
    SECTION("it goes on") {
        CHECK(blocks_in(opened(path, {}).study()) == 2);
        run_to_end(path, {});
    }
    SECTION("it begins anew, of another study") {
        run_and_die(path, other, 1, Start::overwrite);
        CHECK(blocks_in(opened(path, other).study()) == 1);
        run_to_end(path, {}, all_blocks, Start::overwrite);
    }
    SECTION("over the torn beginning of a journal, but over no file that is none") {
        put_bytes(journal, "nonsense");
        CHECK(says(refused(path, {}, Start::overwrite), "is not a journal of credence"));
        put_bytes(journal, "credence-jour");
        run_to_end(path, {}, all_blocks, Start::overwrite);
    }
    CHECK(same_results(read_results(path).study, undisturbed({})));
    CHECK(folder.entries() == 1);
}

TEST_CASE("journal: a results file that it grows and that is gone, or another's, is refused") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5", journal = path + ".journal";
    Asked fewer;
    fewer.trials = 2;
    run_to_end(path, fewer);
    run_and_die(path, {}, 2);
    const std::string kept = bytes_of(journal);
    std::filesystem::rename(path, folder / "moved.h5");
    const std::string said = refused(path, {});
    CHECK(says(said, "cannot resume " + journal));
    CHECK(says(said, "is gone"));
    CHECK(bytes_of(journal) == kept);
    Asked other;
    other.root_seed = 5;
    std::filesystem::rename(journal, folder / "kept");
    run_to_end(path, other);
    std::filesystem::rename(folder / "kept", journal);
    CHECK(says(refused(path, {}), "its root seed is 5, not 1"));
    put_bytes(path, "nonsense");
    CHECK(says(refused(path, {}), "is not an HDF5 file"));
    std::filesystem::rename(folder / "moved.h5", path);
    run_to_end(path, {});
    CHECK(same_results(read_results(path).study, undisturbed({})));
}

}  // namespace credence::test::journal_refusal_test
