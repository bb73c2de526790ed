// Files: which releases computed their trials, which may not be mixed, and files of another schema version.

#include "files/merge/merge.hpp"

#include "files/journal/journal.hpp"
#include "journal_support.hpp"
#include "store_damage.hpp"

namespace credence::test::releases_test {

namespace {

const std::string first = release_name("0.1.0", "aaaaaaaaaaaa"),
                  second = release_name("0.1.7", "v0.1.7-3-gbbbbbbbbbbbb-dirty"),
                  foreign = release_name("0.2.0", "cccccccccccc");

Asked by(const std::string& release, std::int64_t trials, Shard shard = {}) {
    return {trials, 1, shard, {tiny("a"), tiny("b")}, 1, Keep::trials, release};
}

/// The entry in /run on the releases that computed the trials.
std::string computed_by(const std::string& path) {
    for (const auto& [name, text] : read_results(path).run)
        if (name == "computed_by") return text;
    return {};
}

}  // namespace

TEST_CASE("releases: a file names those that computed its trials, and keeps them while it grows") {
    for (const Keep keep : {Keep::trials, Keep::aggregates}) {
        const TemporaryFolder folder;
        const std::string path = folder / "x.h5";
        Asked of_first = by(first, 600), of_second = by(second, 1300);
        of_first.keep = of_second.keep = keep;
        run_to_end(path, of_first);
        CHECK(computed_by(path) == first);
        run_and_die(path, of_second, 3);  // the journal says it as well
        of_first.trials = 1300;
        run_to_end(path, of_first);
        CHECK(computed_by(path) == first + "\n" + second);
        CHECK(same_results(read_results(path).study, undisturbed(of_first)));
    }
}

TEST_CASE("releases: a merged file names those of all its parts") {
    const TemporaryFolder folder;
    run_to_end(folder / "0.h5", by(first, 1300, {0, 2}));
    run_to_end(folder / "1.h5", by(second, 1300, {1, 2}));
    write_results(folder / "merged.h5", merge_results({folder / "0.h5", folder / "1.h5"}), run_facts);
    CHECK(computed_by(folder / "merged.h5") == first + "\n" + second);
    write_results(folder / "one.h5", merge_results({folder / "1.h5"}), run_facts);
    CHECK(computed_by(folder / "one.h5") == second);
}

TEST_CASE("releases: trials of another version are neither resumed nor merged") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5";
    run_to_end(path, by(foreign, 300));
    const std::string file = bytes_of(path), said = refused(path, by(first, 600));
    CHECK(said == "cannot resume " + path + " (" + foreign + " computed trials of it, and this is " + first +
                      "; draws and columns may differ between them). Go on with that release, or name another output.");
    CHECK(bytes_of(path) == file);
    run_and_die(path, by(foreign, 600), 1);
    const std::string journal = bytes_of(path + ".journal");
    CHECK(says(refused(path, by(first, 600)), foreign + " computed trials of it"));
    CHECK(bytes_of(path + ".journal") == journal);
    std::filesystem::remove(path + ".journal");
    const std::string half = folder / "half.h5", rest = folder / "rest.h5";
    run_to_end(half, by(foreign, 300, {0, 2}));
    run_to_end(rest, by(first, 300, {1, 2}));
    for (const std::vector<std::string>& paths : {std::vector{half, rest}, std::vector{rest, half}})
        CHECK(says(refusal<InputError>([&] { merge_results(paths); }),
                   "cannot merge " + paths[1] + " with " + paths[0] + " (credence 0."));
    CHECK(merge_results({half}).scenarios.front().trials == 256);
    // Another revision, or a patch, may.
    CHECK(may_mix(first, second));
    CHECK_FALSE(may_mix(second, foreign));
    CHECK_FALSE(may_mix(release_name("1.2.0", "x"), release_name("0.2.0", "x")));
    CHECK_FALSE(may_mix(release_name("0.12.0", "x"), release_name("0.1.0", "x")));
    CHECK(may_mix(unknown_release, foreign));
}

TEST_CASE("releases: a file that does not name them was computed by the one that wrote it, if it says which") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5";
    const auto put = [&](const RunFacts& facts) { write_results(path, undisturbed(by(first, 300)), facts); };
    put({{"credence_version", "0.1.0"}, {"git_revision", "aaaaaaaaaaaa"}});
    CHECK(computed_by(path).empty());
    run_to_end(path, by(second, 1300));
    CHECK(computed_by(path) == first + "\n" + second);
    put({});
    run_to_end(path, by(second, 1300));
    CHECK(computed_by(path) == unknown_release + "\n" + second);
}

TEST_CASE("releases: a file of another schema version is refused with the release that made it") {
    const TemporaryFolder folder;
    write_results(folder / "x.h5", undisturbed(by(first, 300)), {{"credence_version", "0.1.0"}});
    const auto of_schema_2 = [](const Handle& root) { set_number<std::int32_t>(root, "/", "schema_version", 2); };
    const std::string old = damaged_copy(folder / "x.h5", folder / "old.h5", of_schema_2);
    const std::string said = refusal<InputError>([&] { read_results(old); });
    CHECK(said == old + ": /@schema_version: is 2, this program's is " + std::to_string(schema_version) +
                      "; the file was made by release 0.1.0. Report it with that release, or run the study again.");
    CHECK(refusal<InputError>([&] { merge_results({old}); }) == said);
    CHECK(refused(old, by(first, 600)) == said);
}

}  // namespace credence::test::releases_test
