// A world of one's own that ends the process.

#include "catch.hpp"
#include "own_program.hpp"

#include <cstdlib>

namespace credence::test::exit_test {

using Catch::Contains;

namespace {

/// A point that stands still, whose trials call exit(), or leave that to a process of their own.
struct Leaver {
    struct Settings {
        int forks = 0;
    };
    static constexpr const char* name = "leaver";
    static void keys(OwnKeys<Settings>& keys) { keys.integer("exit.forks", &Settings::forks, 0, 1, "1: a fork exits"); }
    static std::vector<Component> components(const Settings&) { return {{"x", "m"}}; }
    static std::vector<ComponentGroup> groups(const Settings&) { return {}; }
    static int innovation_rows(const Settings&) { return 0; }
    static std::vector<std::string> arms(const Settings&) { return {"kf"}; }

    static void run(const Settings& s, OwnTrial& trial) {
        const pid_t fork = s.forks == 1 ? ::fork() : 0;
        if (fork == 0) std::exit(0);
        waitpid(fork, nullptr, 0);
        using One = Eigen::Matrix<double, 1, 1>;  // normal() gives pairs
        for (int k = 1; k < trial.poses(); ++k) trial.step(One(trial.normal(0, k)[0]), One::Identity());
    }
};

const bool leaver_added = (add_own_world<Leaver>(), true);

/// Runs the program with that world.
int program_with_leaver(const Workplace& here, const std::string& forks) {
    REQUIRE(leaver_added);
    here.write("leaver.ini", "[scenario]\nworld = leaver\nposes = 3\n[exit]\nforks = " + forks + "\n");
    return test::own_program(here, "run leaver.ini -o x.h5 --trials=3 --quiet");
}

}  // namespace

TEST_CASE("cli: a world that calls exit(0) ends the run with 1 and a message") {
    const Workplace here;
    CHECK(program_with_leaver(here, "0") == 1);
    CHECK_THAT(here.read("err"),
               Contains("own run: cannot finish (exit() was called in the middle of it, by a world"));
}

TEST_CASE("cli: a process that a world forks may exit") {
    const Workplace here;
    CHECK(program_with_leaver(here, "1") == 0);
    CHECK(here.read("err").empty());
}

}  // namespace credence::test::exit_test
