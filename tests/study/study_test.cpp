// The same results for any number of threads and any history.

#include "catch.hpp"
#include "study_support.hpp"

#include <credence/error.hpp>

#include <set>

namespace credence::test::study_test {

TEST_CASE("study: 1, 2 and 5 threads give the same bits") {
    const Study one = small_study(1, 700, 1);
    CHECK(same_results(one, small_study(1, 700, 2)));
    CHECK(same_results(one, small_study(1, 700, 5)));
    CHECK_FALSE(same_results(one, small_study(2, 700, 1)));
}

TEST_CASE("study: grown from 300 trials to 1000 in two steps it is the same as run at once") {
    Study grown = small_study(1, 300, 2);
    run_study(grown, {301, 1, {}});  // a partial block taken back and computed again
    run_study(grown, {1000, 2, {}});
    CHECK(same_results(grown, small_study(1, 1000, 1)));
}

TEST_CASE("study: running what is there already changes nothing") {
    Study study = small_study(1, 300, 1);
    run_study(study, {300, 1, {}});
    CHECK(same_results(study, small_study(1, 300, 1)));
}

TEST_CASE("study: fewer trials than there are, are refused") {
    Study study = small_study(1, 300, 1);
    CHECK_THROWS_AS(run_study(study, {299, 1, {}}), InputError);
}

TEST_CASE("study: root seeds s and s + 1 share no trial") {
    // Two trials with the same draws would end with the same trace(P) and pose error.
    std::set<std::pair<double, double>> ends;
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        const ScenarioResults results = small_study(seed, 512, 2).scenarios.front();
        const auto& columns = results.arms.front().columns.in_memory();
        for (std::size_t i = 0; i < 512; ++i)
            ends.emplace(columns[column_pose_error][i], columns[column_nees_ratio][i]);
    }
    CHECK(ends.size() == 3 * 512);
}

TEST_CASE("study: progress counts every trial once, and ends with all") {
    Study study = new_study(small_scenarios(), 1);
    std::vector<Progress> seen;
    run_study(study, {600, 2, [&](const Progress& p) { seen.push_back(p); }});
    REQUIRE(seen.size() == 1 + 2 * 3);  // at the start, and after each of 3 blocks of 2 scenarios
    CHECK(seen.front().done == 0);
    CHECK(seen.back().done == 1200);
    CHECK(seen.back().total == 1200);
}

TEST_CASE("study: scenarios of one run need different names") {
    std::vector<DeformableSettings> scenarios = small_scenarios();
    scenarios[1].name = scenarios[0].name;
    CHECK_THROWS_AS(new_study(scenarios, 1), InputError);
}

TEST_CASE("study: its hash names scenarios, seed and order, and nothing of how it was run") {
    const std::string hash = study_hash(small_study(1, 10, 1));
    CHECK(hash == study_hash(small_study(1, 700, 2)));
    CHECK(hash != study_hash(small_study(2, 10, 1)));
    std::vector<DeformableSettings> other = small_scenarios();
    other[1].noise.walk = 0.30000000000000004;  // one bit
    CHECK(hash != study_hash(new_study(other, 1)));
    std::vector<DeformableSettings> fewer_arms = small_scenarios();
    fewer_arms[0].arms.controllers = {Controller::fixed};
    CHECK(hash != study_hash(new_study(fewer_arms, 1)));
}

TEST_CASE("study: all arms of a trial share their noise") {
    // Without any choice, both arms must have the same values: a planner with one candidate, the fixed control.
    std::vector<DeformableSettings> scenarios = small_scenarios();
    DeformableSettings& s = scenarios.front();
    s.planner.turns = std::vector<double>{0.0};
    Study study = new_study({s}, 7);
    run_study(study, {256, 1, {}});
    const auto& arms = study.scenarios.front().arms;
    int same_first = 0;  // the features' truth is the same; where both arms saw all, so is the unseen count
    for (std::size_t i = 0; i < 256; ++i)
        same_first += arms[0].columns.in_memory()[column_unseen][i] == arms[1].columns.in_memory()[column_unseen][i];
    CHECK(same_first > 20);
    CHECK(same_first < 256);
}

TEST_CASE("study: the footprint grows by what a trial keeps") {
    const Study study = new_study(small_scenarios(), 1);
    const Footprint few = footprint(study, 5000, 1), many = footprint(study, 6000, 1);
    // 2 scenarios of 2 arms; a trial keeps 8 (its number) + 7 * 8 + 2 * 4 + 1 bytes in the file.
    CHECK(many.file - few.file == 1000 * 4 * (8 + 56 + 8 + 1));
    // A detailed one keeps 7 steps of NEES and n errors too, in single precision, and moments of 8 or 7 groups.
    const Footprint none = footprint(study, 1000, 1), more = footprint(study, 2000, 1);
    CHECK(more.file - none.file ==
          1000 * (4 * 73 + 2 * 7 * 4 * (10 + 9) + 2 * 8 * (moment_count(9, 8) + moment_count(8, 6))));
    CHECK(many.memory > few.memory);
}

}  // namespace credence::test::study_test
