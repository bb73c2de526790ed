// Results files of the schema version before: read and reported, not added to.

#include "program.hpp"
#include "files/hdf5/read.hpp"
#include "store_damage.hpp"

#include <credence/merge.hpp>
#include <credence/report.hpp>

using namespace credence;
using namespace credence::test;

namespace {

/// What the release before wrote of the same study.
void make_version_2(const Handle& root) {
    set_number<std::int32_t>(root, "/", "schema_version", 2);
    for (const std::string& scenario : hdf5::link_names(root)) {
        if (scenario == "run") continue;
        const Handle group = hdf5::open_group(root, scenario);
        for (const std::string& arm : hdf5::link_names(group)) {
            remove(root, "/" + scenario + "/" + arm + "/detailed_moments");
            remove(root, "/" + scenario + "/" + arm + "/moment");
        }
    }
}

}  // namespace

TEST_CASE("schema: a file of version 2 is reported, without directions") {
    const TemporaryFolder folder;
    Study study = new_study({scenario("one")}, 1);
    run_study(study, {300, 1, {}});
    write_results(folder / "new.h5", study, {});
    const Study old = read_results(damaged_copy(folder / "new.h5", folder / "old.h5", make_version_2)).study;
    CHECK(old.schema == 2);
    const Report now = make_report(study, 0.05), then = make_report(old, 0.05);
    REQUIRE(then.arms.size() == now.arms.size());
    for (std::size_t a = 0; a < now.arms.size(); ++a) {
        CHECK(then.arms[a].consistency.directions.unknown == "directions are not in this file");
        CHECK(now.arms[a].consistency.directions.unknown.empty());
        CHECK(then.arms[a].consistency.verdict != Verdict::consistent);
        CHECK(then.arms[a].evidence.groups.front().run.mean == now.arms[a].evidence.groups.front().run.mean);
    }
}

TEST_CASE("schema: a file of version 2 is not grown and not merged, and says so") {
    const Workplace here;
    REQUIRE(here.credence("run " + seed_scenario("kf-circle-constant") + " --trials 300 --quiet -o new.h5").exit_code ==
            0);
    damaged_copy(here.path("new.h5"), here.path("old.h5"), make_version_2);
    const std::string before = here.read("old.h5");
    const Outcome grown =
        here.credence("run " + seed_scenario("kf-circle-constant") + " --trials 600 --quiet -o old.h5 --resume");
    CHECK(grown.exit_code == 2);
    CHECK_THAT(grown.err, Catch::Contains("cannot resume old.h5 (it has schema version 2, this program writes 3)"));
    const Outcome merged = here.credence("merge old.h5 -o merged.h5");
    CHECK(merged.exit_code == 2);
    CHECK_THAT(merged.err, Catch::Contains("cannot merge old.h5 (it has schema version 2"));
    CHECK(here.read("old.h5") == before);
    CHECK(here.credence("report old.h5").exit_code == 0);
}

TEST_CASE("schema: a file of version 3 without its moments is refused") {
    const TemporaryFolder folder;
    write_results(folder / "new.h5", made_up_study(), {});
    const std::string path = damaged_copy(folder / "new.h5", folder / "bad.h5", [](const Handle& root) {
        make_version_2(root);
        set_number<std::int32_t>(root, "/", "schema_version", 3);
    });
    CHECK_THROWS_WITH(read_results(path), Catch::Contains("is missing"));
}
