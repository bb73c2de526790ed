// A world of one's own that ends the process.

#include <credence/own_world.hpp>
#include <credence/program.hpp>

#include "catch.hpp"
#include "program.hpp"

#include <sys/wait.h>
#include <unistd.h>

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

/// A program with that world, with its messages in `err`; its exit code.
int program_with_leaver(const Workplace& here, const std::string& forks) {
    here.write("leaver.ini", "[scenario]\nworld = leaver\nposes = 3\n[exit]\nforks = " + forks + "\n");
    const std::string scenario = here.path("leaver.ini"), results = here.path("x.h5"), err = here.path("err");
    const pid_t child = fork();
    if (child == 0) {
        if (freopen(err.c_str(), "w", stderr) == nullptr) _exit(9);
        add_own_world<Leaver>();
        std::vector<std::string> words{"build/leaver", "run", scenario, "-o", results, "--trials=3", "--quiet"};
        std::vector<char*> pointers;
        for (std::string& word : words) pointers.push_back(word.data());
        _exit(program(static_cast<int>(pointers.size()), pointers.data()));
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

TEST_CASE("cli: a world that calls exit(0) ends the run with 1 and a message") {
    const Workplace here;
    CHECK(program_with_leaver(here, "0") == 1);
    CHECK_THAT(here.read("err"),
               Contains("leaver run: cannot finish (exit() was called in the middle of it, by a world"));
}

TEST_CASE("cli: a process that a world forks may exit") {
    const Workplace here;
    CHECK(program_with_leaver(here, "1") == 0);
    CHECK(here.read("err").empty());
}

}  // namespace credence::test::exit_test
