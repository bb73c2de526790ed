// Which arms of which files are compared, and what is refused.

#include <nlohmann/json.hpp>

#include "compare_support.hpp"
#include "program.hpp"
#include "store_study.hpp"
#include "study_support.hpp"

namespace credence::test::compare_choice_test {

using Catch::Contains;
using Json = nlohmann::json;

namespace {

/// A study that has run no trial.
StudyFile unrun(const std::string& path, const std::vector<DeformableSettings>& scenarios, std::uint64_t seed = 1) {
    return {path, new_study(scenarios, seed)};
}

std::vector<std::string> names(const std::vector<StudyFile>& files, const std::string& arms = "") {
    const CompareReport report = compared(files, arms);
    std::vector<std::string> pairs;
    for (const ComparedPair& pair : report.pairs)
        pairs.push_back(pair.comparison.scenario + ": " + pair.comparison.name());
    return pairs;
}

std::string refused(const std::vector<StudyFile>& files, const std::string& arms = "") {
    return refusal<InputError>([&] { names(files, arms); });
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("compare: without --arms, a horizon is compared with greedy, or without that with fixed") {
    const auto arms_of = [](std::vector<Controller> controllers) {
        DeformableSettings planned = scenario("h");
        planned.arms.controllers = std::move(controllers);
        planned.planner.horizon.reset();
        return unrun("one.h5", {resolved(planned)});
    };
    CHECK(names({arms_of({Controller::fixed, Controller::greedy, Controller::horizon})}) ==
          Names{"h: greedy.ekf - fixed.ekf", "h: horizon.ekf - greedy.ekf"});
    CHECK(names({arms_of({Controller::horizon, Controller::greedy})}) == Names{"h: horizon.ekf - greedy.ekf"});
    CHECK(names({arms_of({Controller::fixed, Controller::horizon})}) == Names{"h: horizon.ekf - fixed.ekf"});
}

TEST_CASE("compare: without --arms, planned against fixed; later files against the first") {
    const DeformableSettings heading = scenario("h"), translation = scenario("t", "translation");
    const StudyFile one = unrun("one.h5", {heading, translation}), two = unrun("d/two.h5", {translation}),
                    three = unrun("three.h5", {heading});
    CHECK(names({one}) == Names{"h: greedy.ekf - fixed.ekf", "t: greedy.kf - fixed.kf"});
    CHECK(names({one, two}) == Names{"t: two:fixed.kf - one:fixed.kf", "t: two:greedy.kf - one:greedy.kf"});
    CHECK(names({one, two, three}) == Names{"t: two:fixed.kf - one:fixed.kf", "t: two:greedy.kf - one:greedy.kf",
                                            "h: three:fixed.ekf - one:fixed.ekf",
                                            "h: three:greedy.ekf - one:greedy.ekf"});
    // Two files of one stem go by their paths.
    CHECK(names({unrun("a/s.h5", {heading}), unrun("b/s.h5", {heading})}).front() ==
          "h: b/s.h5:fixed.ekf - a/s.h5:fixed.ekf");
}

TEST_CASE("compare: --arms names arms, controllers, and files") {
    const DeformableSettings heading = scenario("h"), translation = scenario("t", "translation");
    const StudyFile one = unrun("one.h5", {heading, translation}), two = unrun("d/two.h5", {translation});
    CHECK(names({one}, "fixed.ekf,greedy.ekf") == Names{"h: fixed.ekf - greedy.ekf"});
    CHECK(names({one}, " greedy , fixed ") == Names{"h: greedy.ekf - fixed.ekf", "t: greedy.kf - fixed.kf"});
    CHECK(names({one}, "one:greedy,fixed") == Names{"h: greedy.ekf - fixed.ekf", "t: greedy.kf - fixed.kf"});
    CHECK(names({one, two}, "greedy.kf,fixed.kf") == Names{"t: one:greedy.kf - two:fixed.kf"});
    CHECK(names({one, two}, "d/two.h5:greedy,one:fixed") == Names{"t: two:greedy.kf - one:fixed.kf"});
    CHECK(names({two, one}, "fixed,fixed") == Names{"t: two:fixed.kf - one:fixed.kf"});
    const StudyFile drive = unrun("c:x.h5", {translation});
    CHECK(names({drive, two}, "c:x.h5:fixed,two:fixed") == Names{"t: c:x:fixed.kf - two:fixed.kf"});
}

TEST_CASE("compare: --arms that cannot be read, or that nothing has, are refused in words that help") {
    const DeformableSettings heading = scenario("h"), translation = scenario("t", "translation");
    const StudyFile one = unrun("one.h5", {heading, translation}), two = unrun("two.h5", {translation}),
                    three = unrun("three.h5", {heading});
    for (const char* text : {"greedy.ekf", "a,b,c", ",", "a,", "one:,fixed", ":greedy,fixed"})
        CHECK_THAT(refused({one}, text),
                   Contains("invalid --arms=" + std::string(text) + " (") && Contains("Write --arms A,B"));
    CHECK_THAT(refused({one}, "greedy.ekf,fixd.ekf"),
               Contains("(no scenario of one.h5 has fixd.ekf). Did you mean fixed.ekf?") &&
                   Contains("one.h5 has fixed.ekf, greedy.ekf, fixed.kf, greedy.kf in h, t"));
    CHECK_THAT(refused({one}, "greedi,fixed"), Contains("Did you mean greedy?"));
    CHECK_THAT(refused({one}, "greedy.ekf,fixed.kf"), Contains("no scenario has both"));
    CHECK_THAT(refused({one}, "fixed.ekf,fixed"), Contains("both are the same arm"));
    CHECK_THAT(refused({one, two}, "one:fixed,fixed"), Contains("fixed does not say of which file it is"));
    CHECK_THAT(refused({one, two, three}, "greedy,fixed"), Contains("greedy does not say of which file it is"));
    CHECK_THAT(refused({one, two, three}, "one:greedy,two:fixed"), Contains("three.h5 takes no part"));
    CHECK_THAT(refused({one, two}, "one:greedy,four:fixed"),
               Contains("four is not one of the files). The files are one, two"));
    StudyFile ambiguous = one;
    ambiguous.study.scenarios[0].arms.push_back(ambiguous.study.scenarios[0].arms[1]);
    ambiguous.study.scenarios[0].arms.back().name = "greedy.other";
    CHECK_THAT(refused({ambiguous}, "greedy,fixed"), Contains("greedy in scenario h is greedy.ekf or greedy.other"));
    CHECK(names({ambiguous}, "greedy.other,greedy.ekf") == Names{"h: greedy.other - greedy.ekf"});
}

TEST_CASE("compare: where there is nothing to compare, what there is is named") {
    const DeformableSettings fixed_only = changed(scenario("h"), "arms.controllers", "fixed"),
                   greedy_only = changed(scenario("h"), "arms.controllers", "greedy");
    CHECK_THAT(refused({unrun("one.h5", {fixed_only})}),
               Contains("nothing to compare in one.h5 (no arm has that of a simpler controller") &&
                   Contains("Give a further file to compare its arm with: one.h5 has fixed.ekf in h."));
    StudyFile own = unrun("own.h5", {scenario("h")});  // arms of a user's program have names of their own
    own.study.scenarios[0].arms[0].name = "local";
    own.study.scenarios[0].arms[1].name = "global";
    CHECK_THAT(refused({own}),
               Contains("Choose two arms, such as --arms local,global: own.h5 has local, global in h."));
    CHECK_THAT(
        refused({unrun("one.h5", {fixed_only}), unrun("two.h5", {greedy_only})}),
        Contains("cannot compare two.h5 with one.h5 (no scenario of the same name has an arm of the same name)"));
    CHECK_THAT(refused({unrun("one.h5", {scenario("h")}), unrun("two.h5", {scenario("other")})}),
               Contains("two.h5 has fixed.ekf, greedy.ekf in other"));
    // The arms themselves may differ between files.
    CHECK(names({unrun("one.h5", {fixed_only}), unrun("two.h5", {greedy_only})}, "fixed,greedy") ==
          Names{"h: one:fixed.ekf - two:greedy.ekf"});
}

TEST_CASE("compare: files of other seeds or other worlds do not share their draws") {
    const DeformableSettings h = scenario("h");
    const StudyFile one = unrun("one.h5", {h});
    CHECK_THAT(
        refused({one, unrun("two.h5", {h}, 2)}),
        Contains(
            "cannot compare two.h5 with one.h5 (its root seed is 2, not 1: their trials do not share their draws)"));
    const std::vector<std::pair<std::string, std::string>> worlds{{"scenario.length_unit", "m"},
                                                                  {"scenario.poses", "5"},
                                                                  {"features.positions", "1 1, 2 2"},
                                                                  {"features.path", "circle"},
                                                                  {"features.step", "1"},
                                                                  {"features.sway_amplitude", "0.1"},
                                                                  {"noise.walk", "0.31"},
                                                                  {"noise.truncate", "2"},
                                                                  {"noise.initial_heading", "0.1"},
                                                                  {"truth.deformation", "walk"},
                                                                  {"truth.edge_noise", "independent"},
                                                                  {"edges.graph", "chain"},
                                                                  {"model.process", "translation"}};
    for (const auto& [key, value] : worlds) {
        DeformableSettings other = h;
        if (key == "model.process")
            other = scenario("h", "translation");
        else if (key == "features.positions")
            set_key(other, "edges.graph", "all"), other = changed(other, key, value);
        else
            other = changed(other, key, value);
        const std::string message = refused({one, unrun("two.h5", {other})}, "fixed,fixed");
        CHECK_THAT(message, Contains("scenario h is another world: " + key + " is ") &&
                                Contains("Compare runs that differ in filter, control"));
    }
    const std::vector<std::pair<std::string, std::string>> same{
        {"scenario.title", "another"}, {"filter.measurement", "0.8"},
        {"filter.covariance", "1.1"},  {"control.path", "circle"},
        {"planner.speeds", "3"},       {"planner.turns", "0"},
        {"sensor.range_max", "3"},     {"sensor.sigma", "0.1"},
        {"sensor.detection", "0.9"},   {"sensor.every", "2"},
        {"arms.controllers", "fixed"}, {"published.trace_P", "fixed.ekf 1"}};
    for (const auto& [key, value] : same)
        CHECK(refused({one, unrun("two.h5", {changed(h, key, value)})}, "fixed,fixed").empty());
}

TEST_CASE("compare: scenarios whose sensors differ are said to be different worlds") {
    const DeformableSettings h = scenario("h");
    const auto report = [&](const char* key, const char* value) {
        return compare_studies({unrun("one.h5", {h}), unrun("two.h5", {changed(h, key, value)})}, std::nullopt);
    };
    const CompareReport other = report("sensor.sigma", "0.1"), same = report("filter.measurement", "0.8");
    CHECK_THAT(compare_text(other), Contains("note: A and B are different worlds, as their sensors differ: h"));
    CHECK_THAT(compare_text(same), !Contains("different worlds"));
    CHECK(Json::parse(compare_json(other))[0]["same_world"] == false);
    CHECK(Json::parse(compare_json(same))[0]["same_world"] == true);
}

TEST_CASE("compare: scenarios that are left out are named") {
    const DeformableSettings h = scenario("h"), t = scenario("t", "translation");
    const CompareReport report =
        compare_studies({unrun("one.h5", {h, t})}, read_arms("greedy.kf,fixed.kf", {"one.h5"}));
    CHECK(report.left_out == Names{"h (no arm greedy.kf)"});
    CHECK_THAT(compare_text(report), Contains("note: left out: h (no arm greedy.kf)"));
    const CompareReport files =
        compare_studies({unrun("one.h5", {h, t}), unrun("two.h5", {h, scenario("u")})}, std::nullopt);
    CHECK(files.left_out == Names{"u (not in one.h5)", "t (not in two.h5)"});
}

TEST_CASE("compare: CSV quotes what a file's name brings, JSON what is no UTF-8") {
    const std::vector<StudyFile> files{unrun("one.h5", {scenario("h")}), unrun("a,\"b\".h5", {scenario("h")}),
                                       unrun("\xff.h5", {scenario("h")})};
    const CompareReport report = compare_studies(files, std::nullopt);
    CHECK_THAT(compare_csv(report), Contains("h,\"a,\"\"b\"\":fixed.ekf\",one:fixed.ekf,trace_P,"));
    CHECK(Json::parse(compare_json(report)).size() == 4);
}

TEST_CASE("compare: the program compares, in every format") {
    const Workplace here;
    const std::string run =
        "run " + seed_scenario("ekf-circle-constant") + " --threads 2 --quiet --set scenario.poses=8 ";
    REQUIRE(here.credence(run + "--trials 300 -o one.h5").exit_code == 0);
    REQUIRE(here.credence(run + "--trials 200 --set filter.measurement=0.8 -o two.h5").exit_code == 0);
    const Outcome text = here.credence("compare one.h5");
    CHECK(text.exit_code == 0);
    CHECK(text.out.find("greedy.ekf - fixed.ekf, trial by trial: 300 pairs. Negative: greedy.ekf is lower.\n") == 0);
    const Json pairs = Json::parse(here.credence("compare one.h5 two.h5 --format json").out);
    REQUIRE(pairs.size() == 2);
    CHECK(pairs[0]["a"] == "two:fixed.ekf");
    CHECK(pairs[0]["pairs"] == 200);
    CHECK(pairs[0]["differences"]["filter.measurement"] == Json::array({"0.8", "1"}));
    CHECK(pairs[0]["nees_ratio"]["ci95"][0] > 0);
    CHECK(here.credence("compare two.h5 one.h5 --arms one:greedy,two:fixed --format csv -o t.csv").exit_code == 0);
    CHECK(here.shell("grep -c '^ekf-circle-constant,one:greedy.ekf,two:fixed.ekf,' t.csv").out == "8\n");
    CHECK_THAT(here.credence("compare --help").out, Contains("usage: credence compare FILE.h5"));
    CHECK_THAT(here.credence("--help").out, Contains("compare  "));
}

TEST_CASE("compare: the program refuses bad input in one line with exit code 2, and writes nothing") {
    const Workplace here;
    const std::string study = "run " + seed_scenario("ekf-circle-constant") + " --threads 1 --quiet ";
    const std::string run = study + "--trials 20 ";
    REQUIRE(here.credence(run + "-o one.h5").exit_code == 0);
    REQUIRE(here.credence(run + "--seed 2 -o seed.h5").exit_code == 0);
    REQUIRE(here.credence(run + "--set noise.walk=0.31 -o walk.h5").exit_code == 0);
    for (const char* shard : {"0/2 -o even.h5", "1/2 -o odd.h5"})
        REQUIRE(here.credence(study + "--set scenario.poses=2 --trials 300 --shard " + shard).exit_code == 0);
    const std::vector<std::string> before = here.names();
    const auto refused_with = [&](const std::string& arguments, const std::string& what) {
        check_refused(here.credence("compare " + arguments), what);
    };
    refused_with("", "no results file given");
    refused_with("one.h5 one.h5", "repeated file one.h5");
    refused_with("missing.h5", "missing.h5");
    refused_with("one.h5 --format xml", "invalid --format=xml");
    refused_with("one.h5 -o one.h5", "one.h5 (it is there already)");
    refused_with("one.h5 -o no/such.txt", "no/such.txt");
    refused_with("missing.h5 --arms greedy", "invalid --arms=greedy (not two arms");
    refused_with("one.h5 --arms greedy.kf,fixed.kf -o t.txt", "no scenario of one.h5 has greedy.kf");
    refused_with("one.h5 seed.h5", "its root seed is 2, not 1");
    refused_with("one.h5 walk.h5", "noise.walk is 0.31 in walk.h5 and 0.3 in one.h5");
    refused_with("even.h5 odd.h5", "odd.h5 and even.h5: have no trial of ekf-circle-constant in common");
    refused_with("one.h5 --arm x", "Did you mean --arms?");
    CHECK(here.names() == before);
}

}  // namespace credence::test::compare_choice_test
