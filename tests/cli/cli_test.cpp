// The program as its user meets it.
// Kind: foreign files.

#include "catch.hpp"
#include "program.hpp"
#include "store_damage.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace credence::test::cli_test {

using Catch::Contains;
using Json = nlohmann::json;

namespace {

const std::string small = " --trials 300 --threads 2 --quiet ";

}  // namespace

TEST_CASE("cli: run writes a file, and report gives JSON with an object per scenario and arm") {
    const Workplace here;
    const Outcome run = here.credence("run " + seed_scenario("ekf-straight-constant") + " " +
                                      seed_scenario("kf-circle-ranged") + small + "-o r.h5");
    INFO(run.err);
    REQUIRE(run.exit_code == 0);
    CHECK(here.names() == std::vector<std::string>{"r.h5"});
    const Outcome report = here.credence("report r.h5 --format json");
    REQUIRE(report.exit_code == 0);
    const Json arms = Json::parse(report.out);
    REQUIRE(arms.size() == 4);
    CHECK(arms[0]["scenario"] == "ekf-straight-constant");
    CHECK(arms[0]["arm"] == "fixed.ekf");
    CHECK(arms[3]["arm"] == "greedy.kf");
    for (const Json& arm : arms) {
        CHECK(arm["trials"] == 300);
        CHECK(arm["failed"] == 0);
        for (const char* figure : {"trace_P", "unseen", "pose_error", "nees_ratio", "nis_ratio"})
            for (const char* statistic : {"mean", "se", "ci95", "median", "sd"}) CHECK(arm[figure].contains(statistic));
        CHECK(arm["verdict"] == "pessimistic");
        CHECK_FALSE(arm["findings"].empty());
    }
    CHECK(arms[3]["trace_P"]["published"]["value"] == 0.1034);
    CHECK(arms[3]["paired_difference"]["pair"] == "greedy.kf - fixed.kf");
}

TEST_CASE("cli: the table names every arm, its differences and the published values") {
    const Workplace here;
    const Outcome run =
        here.credence("run " + seed_scenario("kf-circle-constant") + " --trials 300 --threads 2 -o r.h5");
    REQUIRE(run.exit_code == 0);
    for (const char* part :
         {"kf-circle-constant: Kalman filter", "trace(P), last step [dm^2]", "fixed.kf", "greedy.kf", "greedy - fixed",
          "0.1061 (", "47 (", "NEES/n", "NIS/m", "failed", "pessimistic", "mean ± 95 %", "median", "sd"})
        CHECK_THAT(run.out, Contains(part));
    const Outcome report = here.credence("report r.h5");
    CHECK(run.out.compare(0, report.out.size(), report.out) == 0);
}

TEST_CASE("cli: report as CSV has a row per arm and column, and -o writes a file") {
    const Workplace here;
    REQUIRE(here.credence("run " + seed_scenario("ekf-straight-constant") + small).exit_code == 0);
    const Outcome csv = here.credence("report credence.h5 --format csv -o t.csv");
    CHECK(csv.exit_code == 0);
    CHECK(csv.out.empty());
    CHECK(here.credence("report credence.h5 -o credence.h5").exit_code == 2);  // never over its own input
    CHECK(here.credence("report credence.h5").exit_code == 0);
    CHECK(here.credence("report credence.h5 >/dev/full").exit_code == 1);
    CHECK(here.credence("show >/dev/full").exit_code == 1);
    const auto count = [&](const std::string& pattern) {
        return std::stoi(here.shell("grep -c '" + pattern + "' t.csv").out);
    };
    const int rows = count("^ekf-straight-constant,"), of_directions = count(",direction_");
    // 2 arms and their pair, 8 columns each; and each arm's evidence: 8 blocks, 3 groups of rows, 10 lags, 9
    // components, 8 of them no group.
    CHECK(rows - of_directions == 24 + 2 * (8 * (3 + 19 * 6) + 3 * 20 + 10 + 9 * 19 + 8 + 19 + 2));
    // Directions of the 7 groups of two components or more, and those of all 9 components; shares are as many as
    // matter.
    for (const char* name : {"direction_largest:[^:,]*,", "direction_smallest:[^:,]*,", "direction_level:"})
        CHECK(count(std::string(",") + name) == 2 * 7);
    CHECK(count(",direction_spectrum:") == 2 * 9);
    CHECK(count(",direction_largest:all:") > 2);
}

TEST_CASE("cli: nothing outside /run depends on threads, and growing a file gives what running at once gives",
          "[long]") {
    const Workplace here;
    const std::string scenarios =
        "run " + seed_scenario("ekf-circle-ranged") + " " + seed_scenario("kf-straight-constant") + " --quiet ";
    REQUIRE(here.credence(scenarios + "--trials 3000 --threads 1 -o one.h5").exit_code == 0);
    REQUIRE(here.credence(scenarios + "--trials 3000 --threads 2 -o two.h5").exit_code == 0);
    REQUIRE(here.credence(scenarios + "--trials 3000 --threads 5 -o five.h5").exit_code == 0);
    REQUIRE(here.credence(scenarios + "--trials 1000 --threads 2 -o grown.h5").exit_code == 0);
    REQUIRE(here.credence(scenarios + "--trials 3000 --threads 2 -o grown.h5 --resume").exit_code == 0);
    for (const char* other : {"two.h5", "five.h5", "grown.h5"}) {
        const Outcome difference = here.shell(std::string("h5diff --exclude-path /run one.h5 ") + other);
        INFO(other << difference.out << difference.err);
        CHECK(difference.exit_code == 0);
    }
    REQUIRE(here.credence(scenarios + "--trials 3000 --seed 2 -o seed.h5").exit_code == 0);
    CHECK(here.shell("h5diff --exclude-path /run one.h5 seed.h5").exit_code == 1);
}

TEST_CASE("cli: resume starts where there is nothing, ends at once where all is there, and refuses another study") {
    const Workplace here;
    const std::string run = "run " + seed_scenario("ekf-straight-constant") + small + "--resume ";
    REQUIRE(here.credence(run).exit_code == 0);
    const Outcome again = here.credence(run);
    CHECK(again.exit_code == 0);
    CHECK(again.out.empty());
    const Outcome shown = here.credence("run " + seed_scenario("ekf-straight-constant") + " --trials 300 --resume");
    CHECK_THAT(shown.out, Contains("greedy - fixed") && Contains("has these trials already"));
    check_refused(here.credence(run + "--seed 2"), "its root seed is 1, not 2");
    check_refused(here.credence(run + "--set noise.walk=0.31"), "noise.walk is 0.3 there and 0.31 here");
}

TEST_CASE(
    "cli: resume without a scenario resumes the study of the file, or of the journal of a run that was killed") {
    const Workplace here;
    const std::string run =
        "run " + seed_scenario("ekf-straight-constant") + " --seed 7 --set noise.walk=0.25 --quiet ";
    REQUIRE(here.credence(run + "--trials 700 -o whole.h5").exit_code == 0);
    REQUIRE(here.credence(run + "--trials 300 -o grown.h5").exit_code == 0);
    REQUIRE(here.credence("run --resume --trials 700 --quiet -o grown.h5").exit_code == 0);
    CHECK(here.shell("h5diff --exclude-path /run whole.h5 grown.h5").exit_code == 0);

    // Killed after its first commit, which takes longer beside other work.
    CHECK(here.shell("for seconds in 2 8 32; do rm -f killed.h5*; timeout -s KILL $seconds " CREDENCE_PROGRAM " " + run +
                     "--trials 1e8 --keep aggregates -o killed.h5; " CREDENCE_PROGRAM
                     " run --resume --dry-run -o killed.h5 >/dev/null 2>&1 && exit 0; done; exit 1")
              .exit_code == 0);
    REQUIRE(here.shell("test -e killed.h5.journal -a ! -e killed.h5").exit_code == 0);
    CHECK_THAT(here.credence("run --resume --dry-run -o killed.h5").out, Contains("scenarios: 1, trials of each: "));

    check_refused(here.credence("run --resume --seed 7 -o grown.h5"), "--seed needs a scenario");
    check_refused(here.credence("run --resume -o nothing.h5"), "nothing.h5: the file: cannot be found");
}

TEST_CASE("cli: a file that exists is kept unless --overwrite is given") {
    const Workplace here;
    here.write("credence.h5", "precious");
    check_refused(here.credence("run " + seed_scenario("ekf-straight-constant") + small), "credence.h5");
    CHECK(here.shell("cat credence.h5").out == "precious");
    CHECK(here.credence("run " + seed_scenario("ekf-straight-constant") + small + "--overwrite").exit_code == 0);
    CHECK(here.credence("report credence.h5").exit_code == 0);
}

TEST_CASE("cli: bad input is refused in one line with exit code 2, and nothing is written") {
    const Workplace here;
    here.write("good.ini", "[noise]\nwalk = 0.2\n");
    here.write("unknown.ini", "[noise]\nwlak = 0.2\n");
    here.write("negative.ini", "[noise]\nwalk = -0.2\n");
    here.write("nan.ini", "[noise]\nwalk = nan\n");
    here.write("empty-range.ini", "[sensor]\nrange_min = 2\nrange_max = 1\n");
    here.write("repeated.ini", "[noise]\nwalk = 1\nwalk = 2\n");
    here.write("broken.ini", "[noise]\nwalk 1\n");
    here.write("foreign.h5", "not HDF5 at all");
    const std::vector<std::string> before = here.names();
    check_refused(here.credence("run unknown.ini"), "unknown.ini:2: unknown key noise.wlak. Did you mean noise.walk?");
    check_refused(here.credence("run negative.ini"), "negative.ini:2: invalid noise.walk=-0.2");
    check_refused(here.credence("run nan.ini"), "nan.ini:2: invalid noise.walk=nan");
    check_refused(here.credence("run empty-range.ini"), "empty-range.ini:3: invalid sensor.range_max=1");
    check_refused(here.credence("run repeated.ini"), "repeated.ini:3: repeated key noise.walk");
    check_refused(here.credence("run broken.ini"), "broken.ini:2: broken line");
    check_refused(here.credence("run missing.ini"), "missing.ini (there is no such file)");
    check_refused(here.credence("run good.ini --trials 0"), "invalid --trials=0 (must be at least 1 and at most 10000");
    check_refused(here.credence("run good.ini --trials x"), "invalid --trials=x (not a whole number)");
    check_refused(here.credence("run good.ini --trials 1.5"), "invalid --trials=1.5 (not a whole number)");
    check_refused(here.credence("run good.ini --seed -1"), "invalid --seed=-1 (must be a whole number from 0 to 18446");
    check_refused(here.credence("run good.ini --threads 0"), "invalid --threads=0 (must be at least 1 and at most 4");
    check_refused(here.credence("run good.ini --trials 5 --trials 6"), "repeated option --trials");
    check_refused(here.credence("run good.ini --trails 5"), "unknown option --trails. Did you mean --trials?");
    check_refused(here.credence("run good.ini --tri 5"), "unknown option --tri");
    check_refused(here.credence("run good.ini --trials"), "--trials");
    check_refused(here.credence("run good.ini --set walk"), "invalid --set=walk");
    check_refused(here.credence("run good.ini --set noise.walk=inf"), "--set noise.walk: invalid noise.walk=inf");
    check_refused(here.credence("run good.ini -o no/such/folder.h5"), "no/such");
    check_refused(here.credence("run good.ini -o ."), ".");
    check_refused(here.credence("run good.ini good.ini"), "two scenarios of the run have it");
    check_refused(here.credence("run good.ini --resume --overwrite"), "contradict");
    check_refused(here.credence("run good.ini --resume -o " + std::string(300, 'x') + ".h5"), "the name is too long");
    check_refused(here.credence("report good.ini -o good.ini"), "good.ini (it is there already)");
    check_refused(here.credence("replay good.ini --noise foreign.h5 --arm fixed.ekf"),
                  "--arm does not go with --noise");
    check_refused(here.credence("run \"$(printf 'missing\\nline.ini')\""), "missing\\nline.ini");
    check_refused(here.credence("''"), "unknown command");
    check_refused(here.credence("run"), "no scenario given");
    check_refused(here.credence("rum good.ini"), "unknown command rum. Did you mean run?");
    check_refused(here.credence("report foreign.h5"), "foreign.h5");
    check_refused(here.credence("report missing.h5"), "missing.h5");
    check_refused(here.credence("report foreign.h5 --margin 0"), "invalid --margin=0");
    check_refused(here.credence("report foreign.h5 --format xml"), "invalid --format=xml");
    check_refused(here.credence("replay good.ini --noise foreign.h5"), "foreign.h5");
    check_refused(here.credence("replay foreign.h5"), "missing --trial");
    check_refused(here.credence("show good.ini good.ini"), "show takes one scenario");
    CHECK(here.names() == before);
}

TEST_CASE("cli: a damaged file that HDF5 cannot close again is refused like any other") {
    const Workplace here;
    check_refused(here.credence("report " CREDENCE_SOURCE "/tests/fuzz/found/results/cannot-be-closed.h5"),
                  "/one/fixed.ekf: cannot be listed in the order in which it was made");
}

TEST_CASE("cli: replay of a stored trial checks it, and writes its trajectory") {
    const Workplace here;
    REQUIRE(here.credence("run " + seed_scenario("ekf-circle-ranged") + small).exit_code == 0);
    const std::string which = "replay credence.h5 --scenario ekf-circle-ranged --arm greedy.ekf ";
    const Outcome replay = here.credence(which + "--trial 299 --format json -o t.h5");
    INFO(replay.err);
    REQUIRE(replay.exit_code == 0);
    const Json one = Json::parse(replay.out);
    REQUIRE(one.size() == 1);
    CHECK(one[0]["status"] == "completed");
    CHECK(one[0]["trace_P"].get<double>() > 0);
    CHECK(here.names() == std::vector<std::string>{"credence.h5", "t.h5"});
    check_refused(here.credence(which + "--trial 300"), "invalid --trial=300 (must be at least 0 and at most 299)");
    check_refused(here.credence("replay credence.h5 --scenario x --arm greedy.ekf --trial 1"), "invalid --scenario=x");
    check_refused(here.credence("replay credence.h5 --scenario ekf-circle-ranged --arm greedy.kf --trial 1"),
                  "It has fixed.ekf, greedy.ekf");
    check_refused(here.credence(which + "--trial 1 -o t.h5"), "t.h5");
}

TEST_CASE("cli: a replay that differs from what is stored fails with exit code 1") {
    const Workplace here;
    REQUIRE(here.credence("run " + seed_scenario("ekf-straight-constant") + small).exit_code == 0);
    // One bit of one stored trace(P) is turned over in the bytes of the file.
    REQUIRE(
        here.shell("h5dump -d /ekf-straight-constant/fixed.ekf/trace_P -b LE -o column.bin credence.h5").exit_code ==
        0);
    const std::string column = here.read("column.bin");
    std::string bytes = here.read("credence.h5");
    const std::size_t at = bytes.find(column);
    REQUIRE(column.size() == 300 * sizeof(double));
    REQUIRE(at != std::string::npos);
    bytes[at + 42 * sizeof(double)] ^= 1;
    here.write("credence.h5", bytes);
    const std::string arm = " --scenario ekf-straight-constant --arm fixed.ekf --trial ";
    check_refused(here.credence("replay credence.h5" + arm + "41"), "checksum");
    damaged_copy(here.path("credence.h5"), here.path("other.h5"), [](const Handle& root) {
        forget_checksum(open(root, "/ekf-straight-constant/fixed.ekf/trace_P"));
    });
    CHECK(here.credence("replay other.h5" + arm + "41").exit_code == 0);
    const Outcome replay = here.credence("replay other.h5" + arm + "42");
    CHECK(replay.exit_code == 1);
    CHECK_THAT(replay.err, Contains("differs") && Contains("trace_P"));
}

TEST_CASE("cli: report --require consistent fails for a pessimistic filter and passes for a matched one", "[long]") {
    const Workplace here;
    here.write("matched.ini",
               "[model]\nprocess = translation\n[truth]\ndeformation = walk\nedge_noise = independent\n"
               "[sensor]\nrange_min = 0\nrange_max = inf\n[arms]\ncontrollers = fixed\n");
    REQUIRE(here.credence("run matched.ini --trials 20000 --quiet -o m.h5").exit_code == 0);
    CHECK(here.credence("report m.h5 --require consistent").exit_code == 0);
    CHECK(here.credence("report m.h5 --require consistent --margin 0.1%").exit_code == 1);
    REQUIRE(here.credence("run " + seed_scenario("ekf-straight-constant") + small).exit_code == 0);
    const Outcome refused = here.credence("report credence.h5 --require consistent");
    CHECK(refused.exit_code == 1);
    CHECK_THAT(refused.err, Contains("ekf-straight-constant/fixed.ekf is pessimistic"));
    CHECK_THAT(refused.out, Contains("pessimistic"));  // the report itself is printed all the same
    check_refused(here.credence("report m.h5 --require optimistic"), "invalid --require=optimistic");
}

}  // namespace credence::test::cli_test
