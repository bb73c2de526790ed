// Files: what is written reads back, and the same study gives the same bytes.

#include "worlds/deformable/keys.hpp"

#include "store_study.hpp"

#include <chrono>
#include <thread>

namespace credence::test::store_test {

namespace {

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

bool same(const std::vector<double>& a, const std::vector<double>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) { return same(x, y); });
}

bool same(const std::vector<ExactSum>& a, const std::vector<ExactSum>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const ExactSum& x, const ExactSum& y) { return same(x.parts(), y.parts()); });
}

void require_same(const ArmResults& found, const ArmResults& expected) {
    REQUIRE(found.name == expected.name);
    CHECK(found.totals.trials.counted() == expected.totals.trials.counted());
    REQUIRE(found.totals.series.size() == expected.totals.series.size());
    for (std::size_t f = 0; f < found.totals.series.size(); ++f) {
        INFO("figure " << f);
        CHECK(same(found.totals.series[f].sum, expected.totals.series[f].sum));
        CHECK(same(found.totals.series[f].square_sum, expected.totals.series[f].square_sum));
        CHECK(same(found.totals.series[f].run_square_sum.parts(), expected.totals.series[f].run_square_sum.parts()));
        CHECK(found.totals.series[f].covered == expected.totals.series[f].covered);
    }
    CHECK(found.totals.cells == expected.totals.cells);
    CHECK(same(found.totals.products.sum, expected.totals.products.sum));
    CHECK(same(found.totals.products.square_sum, expected.totals.products.square_sum));
    CHECK(found.totals.products.count == expected.totals.products.count);
    CHECK(same(found.errors, expected.errors));
    CHECK(same(found.nees, expected.nees));
}

void require_same(const Study& found, const Study& expected) {
    CHECK(found.root_seed == expected.root_seed);
    CHECK(found.trials == expected.trials);
    CHECK(found.complete == expected.complete);
    CHECK(study_hash(found) == study_hash(expected));
    REQUIRE(found.scenarios.size() == expected.scenarios.size());
    for (std::size_t s = 0; s < found.scenarios.size(); ++s) {
        const ScenarioResults &one = found.scenarios[s], &other = expected.scenarios[s];
        CHECK(scenario_text(one.scenario) == scenario_text(other.scenario));
        CHECK(one.trials == other.trials);
        CHECK(one.blocks == other.blocks);
        CHECK(one.columns.size() == other.columns.size());
        CHECK(one.all_series.size() == other.all_series.size());
        REQUIRE(one.arms.size() == other.arms.size());
        const WithTotals of_one(one), of_other(other);
        for (std::size_t a = 0; a < one.arms.size(); ++a) {
            require_same((*of_one).arms[a], (*of_other).arms[a]);
            for (std::size_t c = 0; c < one.columns.size(); ++c)
                CHECK(same(column_values(one, one.arms[a], c), column_values(other, other.arms[a], c)));
        }
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
