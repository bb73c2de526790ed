// Files: which release computed which trials, and which releases may not be mixed.

#include <credence/merge.hpp>

#include "files/journal/journal.hpp"
#include "journal_support.hpp"
#include "store_damage.hpp"

using namespace credence;
using namespace credence::test;

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

TEST_CASE("provenance: a file says which release computed its blocks, and keeps it while it grows") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5";
    run_to_end(path, by(first, 600));
    CHECK(computed_by(path) == first);
    run_to_end(path, by(first, 700));
    CHECK(computed_by(path) == first);
    // Block 2 of both, which was not whole, is computed again.
    run_to_end(path, by(second, 1300), 5);
    CHECK(computed_by(path) == first + ": a 0-1; b 0-1\n" + second + ": a 2-5; b 2");
    run_to_end(path, by(first, 1300));
    CHECK(computed_by(path) == first + ": a 0-1; b 0-1 3-5\n" + second + ": a 2-5; b 2");
    CHECK(same_results(read_results(path).study, undisturbed(by(first, 1300))));
}

TEST_CASE("provenance: a journal says which release committed what") {
    for (const Keep keep : {Keep::trials, Keep::aggregates}) {
        const TemporaryFolder folder;
        const std::string path = folder / "x.h5";
        Asked one = by(first, 1300), other = by(second, 1300);
        one.keep = other.keep = keep;
        run_and_die(path, one, 4);
        run_and_die(path, other, 3);
        run_to_end(path, one);
        CHECK(computed_by(path) == first + ": a 0-3; b 1-5\n" + second + ": a 4-5; b 0");
    }
}

TEST_CASE("provenance: merged files keep what each says of the blocks that come from it") {
    const TemporaryFolder folder;
    const std::vector<std::string> paths{folder / "0.h5", folder / "1.h5", folder / "old.h5"};
    run_to_end(paths[0], by(first, 1300, {0, 2}));
    run_to_end(paths[1], by(second, 1300, {1, 2}));
    run_to_end(paths[2], by(second, 1300, {0, 3}));
    const auto merged = [&](const std::vector<std::string>& files) {
        write_results(folder / "merged.h5", merge_results(files), run_facts);
        return computed_by(folder / "merged.h5");
    };
    CHECK(merged({paths[0], paths[1]}) == first + ": a 0 2 4; b 0 2 4\n" + second + ": a 1 3 5; b 1 3 5");
    CHECK(merged({paths[0], paths[1], paths[2]}) == second + ": a 0-1 3 5; b 0-1 3 5\n" + first + ": a 2 4; b 2 4");
    CHECK(merged({paths[1]}) == second);
}

TEST_CASE("provenance: trials of a release of another version are neither gone on with nor merged") {
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
    // Files that share trials are not merged by a release that may compute others: it could not compare them.
    CHECK(says(refusal<InputError>([&] { merge_results({half, half}, most_totals_in_memory, first); }),
               "cannot merge " + half + " (the files share trials, which may have to be computed again; " + foreign +
                   " computed trials of it, and this is " + first));
    CHECK(merge_results({half, half}, most_totals_in_memory, foreign).scenarios.front().trials == 256);
    CHECK(merge_results({half}, most_totals_in_memory, first).scenarios.front().trials == 256);
    // Another revision, or a patch, may.
    CHECK(may_mix(first, second));
    CHECK_FALSE(may_mix(second, foreign));
    CHECK_FALSE(may_mix(release_name("1.2.0", "x"), release_name("0.2.0", "x")));
    CHECK_FALSE(may_mix(release_name("0.12.0", "x"), release_name("0.1.0", "x")));
    CHECK(may_mix(unknown_release, foreign));
}

TEST_CASE("provenance: of a file that has no list the release that wrote it computed all, where it says so") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.h5";
    const auto put = [&](const RunFacts& facts) {
        Study study = undisturbed(by(first, 300));
        write_results(path, study, facts);
    };
    put({{"credence_version", "0.1.0"}, {"git_revision", "aaaaaaaaaaaa"}});
    CHECK(computed_by(path).empty());
    run_to_end(path, by(second, 1300));
    CHECK(computed_by(path) == first + ": a 0; b 0\n" + second + ": a 1-5; b 1-5");
    put({});
    run_to_end(path, by(second, 1300));
    CHECK(computed_by(path) == second + ": a 1-5; b 1-5\nan unknown release: a 0; b 0");
    run_to_end(path, by(first, 1400));
    CHECK(computed_by(path) == second + ": a 1-4; b 1-4\nan unknown release: a 0; b 0\n" + first + ": a 5; b 5");
}

TEST_CASE("results format: the page shows the list of releases as it is read and written") {
    const std::string page = bytes_of(CREDENCE_SOURCE "/docs/results-format.md");
    CHECK(says(page, "`computed_by`"));
    const std::size_t begin = page.find("```text\n", page.find("## `/run`")) + 8, end = page.find("\n```", begin);
    Study study = new_study({scenario("straight"), scenario("circle")}, 1);
    for (ScenarioResults& results : study.scenarios) extend(results, 8 * block_size);
    const std::string list = page.substr(begin, end - begin);
    study.computed_by = read_provenance(list, study);
    CHECK(provenance_text(study) == list);
    CHECK(study.computed_by.size() == 2);
}

TEST_CASE("provenance: a list that cannot be is refused") {
    const TemporaryFolder folder;
    run_to_end(folder / "good.h5", by(first, 600));
    const auto said = [&](const std::string& text) {
        const std::string bad = damaged_copy(folder / "good.h5", folder / "bad.h5", [&](const Handle& root) {
            set_text(root, "/run", "computed_by", text);
        });
        return refusal<InputError>([&] { read_results(bad); });
    };
    CHECK(said(first + ": a 0-2; b 0-1\n" + second + ": b 2").empty());
    CHECK(said("somebody").empty());
    for (const std::string text : {": z 1", "x: a 2-1", "x: a 1 0", "x: a -1", "x: a 99999999999999999999", "x: a b",
                                   "x: a 0 0", "x: a 1e18", "x: a 0;; b 0", "x: a 0\ny", "x: a 0-", "x: a 0--1"}) {
        CAPTURE(text);
        CHECK(says(said(text), "/run/@computed_by: is no list of releases and of blocks that are there"));
    }
    std::string many;
    for (int i = 0; i < 2000; ++i) many += "r" + std::to_string(i) + ": a 0\n";
    CHECK_FALSE(said(many).empty());
}
