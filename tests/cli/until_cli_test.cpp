// `credence run --until` as its user meets it.

#include "catch.hpp"
#include "program.hpp"

#include <algorithm>

namespace credence::test::until_cli_test {

using Catch::Contains;

namespace {

const std::string kalman = "run " + seed_scenario("kf-circle-constant") + " --set arms.controllers=fixed --threads 2 ";

std::int64_t lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

}  // namespace

TEST_CASE("cli: run --until stops at the first interim analysis for a loose goal, and reports it") {
    const Workplace here;
    const std::string loose = kalman + "--trials 300 --until trace_P=80% --until unseen=0.5 ";
    const Outcome run = here.credence(loose);
    INFO(run.out << run.err);
    REQUIRE(run.exit_code == 0);
    CHECK_THAT(run.out,
               Contains("stopped at interim analysis 1, 300 trials: as precise as asked. Intervals at 97.5 %") &&
                   Contains("trace_P of kf-circle-constant/fixed.kf  0.56 ± 0.16, asked") &&
                   Contains("unseen of kf-circle") && Contains("asked ± 0.5"));
    CHECK(lines(run.err) == 1);
    CHECK_THAT(run.err, Contains("interim analysis 1, 300 trials: ") && Contains("; precise enough"));
    CHECK(here.credence(loose + "--quiet -o quiet.h5").err.empty());
    CHECK(here.shell("h5diff --exclude-path /run credence.h5 quiet.h5").exit_code == 0);
}

TEST_CASE("cli: run --until continues to a later interim analysis, with the number that it expects", "[long]") {
    const Workplace here;
    const Outcome run = here.credence(kalman + "--until trace_P=7%");
    INFO(run.out << run.err);
    REQUIRE(run.exit_code == 0);
    CHECK_THAT(run.err, Contains("interim analysis 1, 4096 trials: trace_P of kf-circle-constant/fixed.kf 0.4") &&
                            Contains("; about 8192\n  trials are needed\ninterim analysis 2, 8192 trials: "));
    CHECK_THAT(run.out, Contains("stopped at interim analysis 2, 8192 trials") && Contains("at 98.75 %"));
    CHECK_THAT(here.shell("h5dump -H -d /kf-circle-constant/fixed.kf/trace_P credence.h5").out, Contains("( 8192 )"));
}

TEST_CASE("cli: run --until that is not precise enough at its ceiling says so, keeps the file and exits with 0") {
    const Workplace here;
    const Outcome run = here.credence(kalman + "--until trace_P=0.5% --until unseen=10 --trials 300 --quiet");
    INFO(run.err);
    CHECK(run.exit_code == 0);
    CHECK(run.out.empty());
    CHECK(lines(run.err) == 1);
    CHECK_THAT(run.err, Contains("credence run: not as precise as asked at the ceiling of 300 trials: "
                                 "trace_P of kf-circle-constant/fixed.kf is 0.56 ± 0.16, asked ± 0.0028; ") &&
                            Contains("it needs about "));
    const Outcome shown = here.credence(kalman + "--until trace_P=0.5% --trials 300 --resume");
    CHECK(shown.exit_code == 0);
    CHECK_THAT(shown.out, Contains("stopped at interim analysis 1, 300 trials: not as precise as asked") &&
                              Contains(": not met") && Contains("credence.h5 has these trials already"));
}

TEST_CASE("cli: run --until gives the same file for any number of threads and after --resume", "[long]") {
    const Workplace here;
    const std::string run = "run " + seed_scenario("ekf-straight-constant") + " " +
                            seed_scenario("kf-straight-constant") + " --quiet --until 'unseen[greedy-fixed]=0.15' ";
    for (const char* threads : {"1", "2", "5"})
        REQUIRE(here.credence(run + "--threads " + threads + " -o " + threads + ".h5").exit_code == 0);
    REQUIRE(here.credence(run + "--trials 4500 -o grown.h5").exit_code == 0);
    REQUIRE(here.credence(run + "--resume -o grown.h5").exit_code == 0);
    for (const char* other : {"2.h5", "5.h5", "grown.h5"}) {
        CAPTURE(other);
        CHECK(here.shell(std::string("h5diff --exclude-path /run 1.h5 ") + other).exit_code == 0);
    }
    const Outcome header = here.shell("h5dump -H -d /kf-straight-constant/fixed.kf/trace_P 1.h5");
    CHECK_THAT(header.out, Contains("( 8192 )"));  // an analysis after the first
}

TEST_CASE("cli: run --until with a file that has more judges its first trials, and keeps it as it is") {
    const Workplace here;
    REQUIRE(here.credence(kalman + "--quiet --trials 400").exit_code == 0);
    const std::string before = here.read("credence.h5");
    const Outcome run = here.credence(kalman + "--until trace_P=80% --trials 300 --resume");
    CHECK(run.exit_code == 0);
    CHECK_THAT(run.out, Contains("stopped at interim analysis 1, 300 trials") && Contains("has these trials already"));
    CHECK(here.read("credence.h5") == before);
}

TEST_CASE("cli: a dry run with --until reports the cost of its ceiling") {
    const Workplace here;
    const Outcome dry = here.credence(kalman + "--until trace_P=1% --dry-run");
    CHECK(dry.exit_code == 0);
    CHECK_THAT(dry.out, Contains("trials of each: 10000000") && Contains("the cost of the ceiling"));
    CHECK_THAT(here.credence(kalman + "--until trace_P=1% --trials 9000 --dry-run").out, Contains("of each: 9000,"));
    CHECK(here.names().empty());
}

TEST_CASE("cli: goals that cannot be met by this study are refused in one line, before any work") {
    const Workplace here;
    const std::vector<std::pair<std::string, std::string>> refused{
        {"trace_P", "there is no = in it"},
        {"trace_P=0", "must be above 0"},
        {"trase_P=1%", "Did you mean trace_P? There are trace_P, unseen, pose_error, nees_ratio"},
        {"trace_P[greedy-fixed]=1%", "no scenario has an arm greedy). There are fixed.kf, fixed"}};
    for (const auto& [goal, why] : refused) {
        const Outcome run = here.credence(kalman + "--until '" + goal + "'");
        check_refused(run, why);
        CHECK_THAT(run.err, Contains("invalid --until=" + goal));
    }
    CHECK(here.names().empty());
}

}  // namespace credence::test::until_cli_test
