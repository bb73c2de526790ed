// Worlds of one's own that go on for ever, throw, or do not repeat themselves.

#include "catch.hpp"
#include "own_program.hpp"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <thread>

namespace credence::test::own_trouble_test {

using Catch::Contains;
using Catch::Matches;

namespace {

struct Trouble {
    enum Kind { none, endless, throws_int, throws_text, calls_rand, counts, reads_clock };
    struct Settings {
        int kind = none;
    };
    static constexpr const char* name = "trouble";
    static void keys(OwnKeys<Settings>& keys) { keys.integer("trouble.kind", &Settings::kind, 0, 6, "which"); }
    static std::vector<Component> components(const Settings&) { return {{"x", "m"}, {"y", "m"}}; }
    static std::vector<ComponentGroup> groups(const Settings&) { return {}; }
    static std::vector<std::string> arms(const Settings&) { return {"kf"}; }
    static int innovation_rows(const Settings&) { return 0; }
    static void run(const Settings& s, OwnTrial& trial) {
        static int calls = 0;
        double more = 0;
        const bool is_rare = trial.uniform(1, 0) < 2e-4;
        if (is_rare && s.kind == endless)
            for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
        if (is_rare && s.kind == throws_int) throw 5;
        if (is_rare && s.kind == throws_text) throw std::out_of_range("no such landmark");
        if (s.kind == calls_rand) more = rand();
        if (s.kind == counts) more = ++calls;
        if (s.kind == reads_clock)
            more = static_cast<double>(std::chrono::steady_clock::now().time_since_epoch().count());
        for (int k = 1; k < trial.poses(); ++k)
            trial.step(trial.normal(0, k) + Eigen::Vector2d(1e-12 * more, 0), Eigen::Matrix2d::Identity());
    }
};

const bool trouble_added = (add_own_world<Trouble>(), true);

std::string command(const Workplace& here, Trouble::Kind kind, int trials) {
    REQUIRE(trouble_added);
    here.write("t.ini", "[scenario]\nworld = trouble\nposes = 3\n[trouble]\nkind = " + std::to_string(kind) + "\n");
    return "run t.ini -o x.h5 --quiet --commit-every 1 --threads 2 --trials " + std::to_string(trials);
}

int run_to_end(const Workplace& here, Trouble::Kind kind, int trials) {
    return test::own_program(here, command(here, kind, trials));
}

}  // namespace

TEST_CASE("own world: whatever a trial throws is a message that names it, and what was committed is kept") {
    const Workplace here;
    REQUIRE(run_to_end(here, Trouble::none, 20000) == 0);
    for (const auto& [kind, what] :
         {std::pair(Trouble::throws_int, "what is no std::exception"),
          std::pair(Trouble::throws_text, "`no such landmark`")}) {
        const Workplace place;
        CHECK(run_to_end(place, kind, 20000) == 1);
        const std::string said = place.read("err");
        CAPTURE(said);
        CHECK_THAT(said, Contains("own run: cannot run world trouble (trial ") &&
                             Contains(std::string(" of kf threw ") + what + "). Mend its function run. ") &&
                             Contains("What was committed is kept, and this resumes the run: "));
        CHECK(place.names() == std::vector<std::string>{"err", "out", "t.ini", "x.h5.journal"});
    }
}

TEST_CASE("own world: one that does not repeat itself is refused before any work") {
    for (const Trouble::Kind kind : {Trouble::calls_rand, Trouble::counts, Trouble::reads_clock}) {
        const Workplace here;
        CHECK(run_to_end(here, kind, 300) == 2);
        CHECK_THAT(here.read("err"),
                   Contains("cannot run world trouble (trial 0 of kf gives other numbers a second time: of a clock, of "
                            "another generator, or of what is kept from trial to trial). Draw by trial.normal"));
        CHECK(here.names() == std::vector<std::string>{"err", "out", "t.ini"});
    }
}

TEST_CASE("own world: one signal ends a run with a trial that goes on for ever, and what was committed is kept",
          "[long]") {
    using namespace std::chrono;
    const Workplace here;
    const pid_t run = test::begin_own_program(here, command(here, Trouble::endless, 10'000'000));
    const auto committed = [&] {
        std::error_code none;
        const auto size = std::filesystem::file_size(here.path("x.h5.journal"), none);
        return none ? 0 : size;
    };
    for (auto before = committed(); committed() < 20000 || committed() != before;) {  // until every thread is in one
        before = committed();
        std::this_thread::sleep_for(seconds(1));
    }
    const auto start = steady_clock::now();
    kill(run, SIGTERM);
    CHECK(test::end_of(run) == 3);
    CHECK(steady_clock::now() - start < seconds(20));
    CHECK_THAT(here.read("err"), Contains("own run: stopped by a signal, and a block did not end (does a trial go on "
                                          "for ever?). What was committed is kept, and this resumes the run: ") &&
                                     Contains(" --resume\n"));
    CHECK(committed() > 20000);
    CHECK(test::own_program(here, "watch x.h5 --once") == 0);
    CHECK_THAT(here.read("out"), Contains("  kf "));
}

}  // namespace credence::test::own_trouble_test
