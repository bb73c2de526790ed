// Files: what is written reads back, and the same study gives the same bytes.

#include "worlds/deformable/keys.hpp"

#include "store_study.hpp"
#include "study_support.hpp"

#include <chrono>
#include <thread>

namespace credence::test::store_test {

namespace {

void require_same(const Study& found, const Study& expected) {
    CHECK(found.root_seed == expected.root_seed);
    CHECK(found.trials == expected.trials);
    CHECK(found.complete == expected.complete);
    CHECK(study_hash(found) == study_hash(expected));
    CHECK(same_results(found, expected));
    REQUIRE(found.scenarios.size() == expected.scenarios.size());
    for (std::size_t s = 0; s < found.scenarios.size(); ++s) {
        const ScenarioResults &one = found.scenarios[s], &other = expected.scenarios[s];
        CHECK(scenario_text(one.scenario) == scenario_text(other.scenario));
        CHECK(one.blocks == other.blocks);
        CHECK(one.columns.size() == other.columns.size());
        CHECK(one.all_series.size() == other.all_series.size());
    }
}

}  // namespace

TEST_CASE("store: a study reads back as it was written") {
    const TemporaryFolder folder;
    Study study = made_up_study();
    for (const bool complete : {true, false}) {
        study.complete = complete;
        write_results(folder / "study.h5", study, run_facts);
        const StoredStudy stored = read_results(folder / "study.h5");
        require_same(stored.study, study);
        CHECK(stored.run == run_facts);
    }
    CHECK(folder.entries() == 1);
}

TEST_CASE("store: scenarios come back in the order of the study, not of the alphabet") {
    const TemporaryFolder folder;
    write_results(folder / "study.h5", new_study({scenario("zulu"), scenario("alpha"), scenario("mike")}, 1), {});
    const Study study = read_results(folder / "study.h5").study;
    REQUIRE(study.scenarios.size() == 3);
    CHECK(study.scenarios[0].scenario.name == "zulu");
    CHECK(study.scenarios[1].scenario.name == "alpha");
}

TEST_CASE("store: a study without trials, as of an empty shard, reads back") {
    const TemporaryFolder folder;
    const Study study = new_study({scenario("empty")}, 3);
    write_results(folder / "study.h5", study, {});
    require_same(read_results(folder / "study.h5").study, study);
}

TEST_CASE("store: a scenario text of more than 64 kB reads back") {
    const TemporaryFolder folder;
    DeformableSettings long_one = scenario("long");
    long_one.published.trace_P.assign(5000, {"greedy.ekf", 1.0 / 3});
    const Study study = new_study({long_one}, 1);
    REQUIRE(scenario_text(study.scenarios[0].scenario).size() > 65536);
    write_results(folder / "study.h5", study, {});
    require_same(read_results(folder / "study.h5").study, study);
}

TEST_CASE("store: a study that was stored and extended has the bytes of one that ran at once") {
    const TemporaryFolder folder;
    const std::vector<DeformableSettings> scenarios{scenario("one"), scenario("two", "translation")};
    Study at_once = new_study(scenarios, 5);
    run_study(at_once, {600, 1, {}});
    write_results(folder / "at_once.h5", at_once, run_facts);

    Study first = new_study(scenarios, 5);
    run_study(first, {300, 1, {}});
    write_results(folder / "extended.h5", first, {});
    Study extended = read_results(folder / "extended.h5").study;
    run_study(extended, {600, 1, {}});
    write_results(folder / "extended.h5", extended, run_facts);
    CHECK(bytes_of(folder / "extended.h5") == bytes_of(folder / "at_once.h5"));
}

TEST_CASE("store: no clock and no machine outside /run") {
    const TemporaryFolder folder;
    const Study study = made_up_study();
    write_results(folder / "a.h5", study, {{"fact", "aaaa"}});
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5's object times count seconds
    write_results(folder / "again.h5", study, {{"fact", "aaaa"}});
    write_results(folder / "b.h5", study, {{"fact", "bbbb"}});
    const std::string a = bytes_of(folder / "a.h5"), b = bytes_of(folder / "b.h5");
    CHECK(a == bytes_of(folder / "again.h5"));
    REQUIRE(a.size() == b.size());
    std::size_t differing = 0;
    for (std::size_t i = 0; i < a.size(); ++i) differing += a[i] != b[i];
    CHECK(differing >= 4);
    CHECK(differing <= 8);  // the fact's four letters, and the checksum of the group that holds it
}

TEST_CASE("store: a scenario named run is refused, its group is taken") {
    const TemporaryFolder folder;
    Study study = new_study({scenario("other")}, 1);
    study.scenarios.front().scenario.name = "run";  // past the key, which refuses it too
    CHECK(refusal<InputError>([&] { write_results(folder / "study.h5", study, {}); }).find("scenario.name=run") !=
          std::string::npos);
    CHECK(folder.entries() == 0);
}

}  // namespace credence::test::store_test
