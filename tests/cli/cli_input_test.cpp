// Files, names and surroundings that the program has to refuse, or to show without harm.

#include "catch.hpp"
#include "judgement_support.hpp"
#include "program.hpp"

#include <utility>

namespace credence::test::cli_input_test {

using Catch::Contains;

namespace {

/// The scenario small.ini and its results small.h5.
void add_results(const Workplace& here) {
    here.write("small.ini", small_world);
    REQUIRE(here.credence("run small.ini --trials 20 --quiet -o small.h5").exit_code == 0);
}

/// Nothing that a terminal obeys: no controls but tab and line feed, no turning of the direction.
void check_harmless(const std::string& text) {
    CAPTURE(text);
    for (const char c : text)
        CHECK_FALSE(((static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == 0x7f));
    for (const char* bad : {"\xc2\x9b", "\xc2\x85", "\xe2\x80\xae", "\xe2\x81\xa6"})
        CHECK(text.find(bad) == std::string::npos);
}

/// Every command that reads a file, with its other arguments.
const std::vector<std::string> commands_of_hdf5{"report", "judge", "compare", "watch", "merge -o merged.h5",
                                                "replay --scenario small --arm fixed --trial 0"};
const std::vector<std::string> commands_of_scenarios{"run", "show"};

std::size_t longest_line(const std::string& text) {
    std::size_t longest = 0, length = 0;
    for (const char c : text) {
        if (c == '\n') longest = std::max(longest, std::exchange(length, 0));
        else length += (static_cast<unsigned char>(c) & 0xc0) != 0x80;
    }
    return longest;
}

}  // namespace

TEST_CASE("cli: what is not a regular file is refused by every command, without waiting for it") {
    const Workplace here;
    here.write("small.ini", small_world);
    REQUIRE(here.shell("mkfifo pipe && mkdir folder").exit_code == 0);
    for (const std::string name : {"pipe", "folder", "/dev/null", "/dev/zero"}) {
        for (const std::string& command : commands_of_hdf5)
            check_refused(here.shell("timeout 10 " CREDENCE_PROGRAM " " + command + " " + name),
                          "is not a regular file");
        for (const std::string& command : commands_of_scenarios)
            check_refused(here.shell("timeout 10 " CREDENCE_PROGRAM " " + command + " " + name), "it is not a file");
        check_refused(here.shell("timeout 10 " CREDENCE_PROGRAM " replay small.ini --noise " + name),
                      "is not a regular file");
    }
}

TEST_CASE("cli: an error of reading is called by its name") {
    const Workplace here;  // reading /proc/self/mem from its beginning is one
    for (const std::string& command : commands_of_hdf5)
        check_refused(here.credence(command + " /proc/self/mem"), "cannot be read (input/output error)");
    for (const std::string& command : commands_of_scenarios)
        check_refused(here.credence(command + " /proc/self/mem"), "(input/output error)");
    check_refused(here.credence("report x.h5/y"), "cannot be found");
}

TEST_CASE("cli: too many open files are what a merge says, not that a file is damaged") {
    const Workplace here;
    here.write("small.ini", small_world);
    for (const std::string i : {"0", "1", "2", "3", "4", "5", "6", "7"})
        REQUIRE(here.credence("run small.ini --trials 2048 --quiet --shard " + i + "/8 -o " + i + ".h5").exit_code ==
                0);
    check_refused(here.shell("ulimit -n 10; " CREDENCE_PROGRAM " merge ?.h5 -o whole.h5"),
                  "cannot be read (too many open files). Raise the number of files that may be open (ulimit -n)");
    CHECK(here.credence("merge ?.h5 -o whole.h5").exit_code == 0);
}

TEST_CASE("cli: where nothing was committed the program does not say that something is kept") {
    const Workplace here;
    here.write("small.ini", small_world);
    for (const std::string run : {"ulimit -f 0; " CREDENCE_PROGRAM " run small.ini --quiet -o x.h5",
                                  CREDENCE_PROGRAM " run small.ini --quiet -o /proc/x.h5"}) {
        const Outcome failed = here.shell("(" + run + ") 2>&1 | cat >&2");
        CAPTURE(failed.err);
        CHECK_THAT(failed.err,
                   Contains("cannot write ") && Contains("Nothing had been committed.") && !Contains("kept"));
        CHECK(here.names() == std::vector<std::string>{"small.ini"});
    }
    CHECK(here.credence("run small.ini --quiet -o /proc/x.h5").exit_code == 1);
}

TEST_CASE("cli: titles, names and units reach a terminal without what it obeys") {
    const Workplace here;
    here.write("evil.ini", "[scenario]\nname = evil\nposes = 3\ntitle = red \xc2\x9b" "31m and \xe2\x80\xae" "turned\n"
                           "length_unit = m\xc2\x9b\n[arms]\ncontrollers = fixed, greedy\n[planner]\nspeeds = 1\n");
    const std::string name = "\"$(printf 'e\\033[31m\\302\\233.h5')\"";
    const Outcome run = here.credence("run evil.ini --trials 20 -o " + name);
    CHECK(run.exit_code == 0);
    CHECK_THAT(run.out, Contains("red \\u009b31m and \\u202eturned") && Contains("e\\u001b[31m\\u009b.h5: "));
    check_harmless(run.out);
    for (const std::string command :
         {"report --format text", "report --format html", "report --format json", "report --format csv", "compare",
          "compare --format html", "compare --format json", "watch", "watch --format json",
          "replay --scenario evil --arm fixed --trial 0", "merge --overwrite -o \"$(printf 'm\\033.h5')\""}) {
        const Outcome outcome = here.credence(command + " " + name);
        CAPTURE(command, outcome.err);
        CHECK(outcome.exit_code == 0);
        check_harmless(outcome.out);
    }
    check_harmless(here.credence("show evil.ini").out);
    check_harmless(here.credence("run evil.ini --dry-run -o \"$(printf 'd\\033.h5')\"").out);
    check_refused(here.credence("report \"$(printf 'none\\033\\377')\""),
                  "none\\u001b\\xff: the file: cannot be found");
}

TEST_CASE("cli: the names of a record's groups are escaped") {
    const Workplace here;
    write_plain_record(here.path("record.h5"), [](const hdf5::Handle& root) {
        hdf5::write_text(root, "groups", "a\x1b[31m\xc2\x9b\xe2\x80\xae 0:1");
    });
    const Outcome refused = here.credence("judge record.h5");
    check_refused(refused, "`a\\u001b[31m\\u009b\\u202e` is no name for a group");
    check_harmless(refused.err);
}

TEST_CASE("cli: a standard output that takes nothing makes every command fail") {
    const Workplace here;
    add_results(here);
    for (const std::string command : {"--help", "help", "help run", "--version", "run --help", "completion bash",
                                      "show", "report small.h5", "watch small.h5", "compare small.h5"})
        CHECK(here.credence(command + " >/dev/full").exit_code == 1);
}

TEST_CASE("cli: a stack that is too small is refused, on every thread") {
    const Workplace here;
    add_results(here);
    for (const std::string command :
         {"run small.ini --trials 600 --quiet -o x.h5", "report small.h5", "compare small.h5"}) {
        check_refused(here.shell("ulimit -s 64; " CREDENCE_PROGRAM " " + command), "cannot run with a stack of 64 kB");
        check_refused(here.shell("OMP_STACKSIZE=64k " CREDENCE_PROGRAM " " + command),
                      "cannot run with a stack of 64 kB");
    }
    CHECK(here.shell("ulimit -s 256; " CREDENCE_PROGRAM " report small.h5").exit_code == 0);
}

TEST_CASE("cli: a byte-order mark before a scenario is skipped") {
    const Workplace here;
    here.write("plain.ini", small_world);
    here.write("marked.ini", "\xEF\xBB\xBF" + small_world);
    CHECK(here.credence("show marked.ini").out == here.credence("show plain.ini").out);
}

TEST_CASE("cli: a seed may be any number of 64 bits, and the message says the largest") {
    const Workplace here;
    here.write("small.ini", small_world);
    const std::string run = "run small.ini --trials 5 -o x.h5 --overwrite --seed ";
    const Outcome largest = here.credence(run + "18446744073709551615");
    CHECK(largest.exit_code == 0);
    CHECK_THAT(largest.out, Contains("root seed 18446744073709551615."));
    for (const std::string seed : {"18446744073709551616", "1e30"})
        check_refused(here.credence(run + seed), "(must be a whole number from 0 to 18446744073709551615)");
    check_refused(here.credence("run small.ini --trials 1e30"),
                  "(not a whole number). It must be at least 1 and at most 1000000000000.");
    CHECK_THAT(here.credence(run + "1e6").out, Contains("root seed 1000000."));
}

TEST_CASE("cli: help COMMAND is COMMAND --help") {
    const Workplace here;
    for (const std::string command : {"run", "judge", "merge"})
        CHECK(here.credence("help " + command).out == here.credence(command + " --help").out);
    CHECK(here.credence("help").out == here.credence("--help").out);
    check_refused(here.credence("help rnu"), "unknown command rnu. Did you mean run?");
}

TEST_CASE("cli: replay takes a controller's name for its only arm") {
    const Workplace here;
    add_results(here);
    const std::string replay = "replay small.h5 --scenario small --trial 7 --arm ";
    const Outcome greedy = here.credence(replay + "greedy");
    CHECK(greedy.exit_code == 0);
    CHECK(greedy.out == here.credence(replay + "greedy.ekf").out);
    REQUIRE(here.credence("run small.ini --trials 5 --quiet -o two.h5 --set arms.estimators=ekf,fej").exit_code == 0);
    check_refused(here.credence("replay two.h5 --scenario small --trial 1 --arm greedy"),
                  "several arms have that controller");
    check_refused(here.credence(replay + "ekf"), "not in the scenario");
}

TEST_CASE("cli: a report or a trajectory replaces a file only with --overwrite, and never the one that it reads") {
    const Workplace here;
    add_results(here);
    write_plain_record(here.path("record.h5"));
    here.write("there", "precious");
    for (const std::string command : {"report small.h5", "compare small.h5", "judge record.h5 --quiet",
                                      "replay small.h5 --scenario small --arm fixed --trial 0"}) {
        check_refused(here.credence(command + " -o there"), "(it is there already). Give another name or --overwrite");
        CHECK(here.read("there") == "precious");
        CHECK(here.credence(command + " -o there --overwrite").exit_code == 0);
        CHECK(here.read("there") != "precious");
        here.write("there", "precious");
        const std::string input = command.find("record") == std::string::npos ? "small.h5" : "record.h5",
                          before = here.read(input);
        check_refused(here.credence(command + " --overwrite -o ./" + input),
                      "it would replace " + input + ", which is read");
        CHECK(here.read(input) == before);
    }
}

TEST_CASE("cli: no command replaces a file that it reads, by whatever name") {
    const Workplace here;
    add_results(here);
    write_plain_record(here.path("record.h5"));
    REQUIRE(here.credence("run small.ini --trials 20 --shard 0/2 --quiet -o shard.h5").exit_code == 0);
    const std::vector<std::pair<std::string, std::string>> commands{
        {"run small.ini --trials 20 --quiet", "small.ini"},
        {"report small.h5", "small.h5"},
        {"judge record.h5 --quiet", "record.h5"},
        {"compare shard.h5 small.h5", "small.h5"},
        {"merge shard.h5 small.h5", "small.h5"},
        {"replay small.h5 --scenario small --arm fixed --trial 0", "small.h5"},
        {"replay small.ini --noise record.h5", "small.ini"},
        {"replay small.ini --noise record.h5", "record.h5"}};
    for (const auto& [command, input] : commands) {
        const std::string before = here.read(input);
        const auto check_output = [&, command = command, input = input](const std::string& way,
                                                                        const std::string& output) {
            CAPTURE(command, way, input);
            here.shell("cp " + input + " kept; " + way);
            check_refused(here.credence(command + " --overwrite -o " + output), "it would replace ");
            CHECK(here.read(input) == before);
            here.shell("mv kept " + input + "; rm -f link");
        };
        check_output("true", "./" + input);
        check_output("ln -s " + input + " link", "link");
        check_output("ln " + input + " link", "link");
        // Writing goes by a temporary file, and one that is there is removed first.
        check_output("ln " + input + " link.credence-partial", "link");
        here.shell("rm -f link.credence-partial");
    }
    check_refused(here.credence("run small.ini --resume --quiet -o small.ini"),
                  "it would replace small.ini, which is read");
}

TEST_CASE("cli: a program of another name says its own in messages, help, completion and the command to resume") {
    const Workplace here;
    add_results(here);
    const auto own = [&](const std::string& words) { return here.shell("./tracker " + words); };
    here.shell("ln -s " CREDENCE_PROGRAM " tracker");
    check_refused(own("report missing.h5"), "tracker report: missing.h5");
    check_refused(own("report small.ini"), "not a results file). `tracker run small.ini` runs it.");
    check_refused(own("reprot"), "tracker reprot: unknown command");
    check_refused(own("run --zzzzz"), "`tracker run --help` lists them");
    check_refused(own("watch missing.h5"), "begin with `tracker run SCENARIO.ini");
    CHECK_THAT(own("").out, Contains("usage: tracker COMMAND") && !Contains("credence COMMAND"));
    CHECK_THAT(own("run --help").out, Contains("usage: tracker run SCENARIO.ini") && Contains("`tracker merge`"));
    for (const std::string command :
         {"run", "report", "judge", "compare", "replay", "merge", "watch", "show", "completion"})
        CHECK_THAT(own(command + " --help").out, !Contains("credence " + command));
    CHECK_THAT(own("completion bash").out, Contains("complete -F _tracker tracker\n") && !Contains("_credence"));
    REQUIRE(own("run small.ini --trials 20 --quiet -o own.h5").exit_code == 0);
    CHECK_THAT(own("report own.h5 --format html").out,
               Contains("./tracker run small.ini") && !Contains("credence run "));
    const Outcome stopped =
        here.shell("./tracker run small.ini --trials 1e8 --force --quiet -o x.h5 --commit-every 1 & run=$!\n"
                   "until [ -s x.h5.journal ]; do sleep 0.01; done; kill -INT $run; wait $run");
    CHECK_THAT(stopped.err, Contains("tracker run: stopped by SIGINT") && Contains("\n  ./tracker run small.ini"));
}

TEST_CASE("cli: show without a scenario names the worlds of the program") {
    const Workplace here;
    CHECK_THAT(here.credence("show").out,
               Contains("# the world: deformable, explore; each has keys of its own, --set "
                        "scenario.world=explore shows them\nscenario.world = deformable\n"));
    const std::string explore = here.credence("show --set scenario.world=explore").out;
    CHECK(explore.find("scenario.world = explore") == explore.rfind("scenario.world = "));
}

TEST_CASE("cli: a file of another kind is refused with the command that reads it") {
    const Workplace here;
    add_results(here);
    write_plain_record(here.path("record.h5"));
    REQUIRE(here.credence("replay small.h5 --scenario small --arm fixed --trial 0 -o trace.h5").exit_code == 0);
    const std::vector<std::pair<std::string, std::string>> kinds{{"small.ini", "scenario"},
                                                                 {"small.h5", "results file"},
                                                                 {"record.h5", "record"},
                                                                 {"trace.h5", "trajectory file of a replay"}};
    const std::vector<std::string> readers{"`credence run small.ini` runs it", "`credence report small.h5` reads it",
                                           "`credence judge record.h5` reads it", "python -m credence.pictures"};
    const auto check = [&](const std::string& command, const std::string& own) {
        for (std::size_t k = 0; k < kinds.size(); ++k) {
            // It takes both.
            if (kinds[k].second == own || (command == "compare" && kinds[k].second == "record")) continue;
            const Outcome refused = here.credence(command + " " + kinds[k].first);
            check_refused(refused, kinds[k].second + ", not a " + own + "). ");
            CHECK_THAT(refused.err, Contains(readers[k]));
        }
    };
    for (const std::string& command : commands_of_hdf5)
        if (command == "judge") check(command, "record");
        else check(command, "results file");
    for (const std::string& command : commands_of_scenarios) check(command, "scenario");
    check_refused(here.credence("replay small.ini --noise record.h5"), "it is a record, not a noise record");
    here.write("bare.ini", "# no section\nscenario.poses = 3\n");
    check_refused(here.credence("judge bare.ini"), "a scenario, not a record). `credence run bare.ini` runs it.");
    here.write("small.h5.journal", "credence-journal");
    check_refused(here.credence("report small.h5.journal"), "`credence watch small.h5.journal` follows it");
}

TEST_CASE("cli: a scenario may begin with a byte order mark, and one in UTF-16 is told to be UTF-8") {
    const Workplace here;
    here.write("marked.ini", "\xEF\xBB\xBF" + small_world);
    CHECK(here.credence("show marked.ini").exit_code == 0);
    check_refused(here.credence("report marked.ini"), "`credence run marked.ini` runs it");
    for (const std::string code : {"UTF-16", "UTF-16LE", "UTF-16BE", "UTF-32"}) {
        CAPTURE(code);
        REQUIRE(here.shell("iconv -f UTF-8 -t " + code + " marked.ini > wide.ini").exit_code == 0);
        check_refused(here.credence("run wide.ini"),
                      "scenario wide.ini (it is no text in UTF-8 but perhaps in UTF-16). Save it as UTF-8.");
    }
}

TEST_CASE("cli: the suffix of -o's file chooses the format, unless --format does") {
    const Workplace here;
    add_results(here);
    write_plain_record(here.path("record.h5"));
    for (const std::string command : {"report small.h5", "judge record.h5", "compare small.h5"})
        for (const std::string format : {"html", "json", "csv"}) {
            CAPTURE(command, format);
            REQUIRE(here.credence(command + " -o x." + format).exit_code == 0);
            CHECK(here.read("x." + format) == here.credence(command + " --format " + format).out);
            REQUIRE(here.credence(command + " --format text --overwrite -o x." + format).exit_code == 0);
            CHECK(here.read("x." + format) == here.credence(command).out);
            here.shell("rm x." + format);
        }
    for (const std::string command : {"run small.ini", "merge small.h5", "replay small.h5 --trial 0 --arm fixed"})
        for (const std::string suffix : {"html", "json", "csv", "txt"})
            check_refused(here.credence(command + " -o x." + suffix),
                          "invalid -o=x." + suffix + " (what is written there is HDF5). Give FILE.h5; ");
    CHECK(here.names() == std::vector<std::string>{"record.h5", "small.h5", "small.ini"});
}

TEST_CASE("cli: replay takes the only scenario and the only arm, and names them where there are several") {
    const Workplace here;
    here.write("small.ini", small_world);
    REQUIRE(here.credence("run small.ini --trials 20 --quiet --set arms.controllers=fixed -o one.h5").exit_code == 0);
    CHECK(here.credence("replay one.h5 --trial 3").out ==
          here.credence("replay one.h5 --scenario small --arm fixed.ekf --trial 3").out);
    check_refused(here.credence("replay one.h5"), "missing --trial. Give FILE.h5 --trial I, or");
    here.write("other.ini", "[scenario]\nname = other\nposes = 3\n");
    REQUIRE(here.credence("run small.ini other.ini --trials 20 --quiet -o two.h5").exit_code == 0);
    check_refused(here.credence("replay two.h5 --trial 3"), "missing --scenario. It is one of small, other.");
    check_refused(here.credence("replay two.h5 --trial 3 --scenario small"),
                  "missing --arm. It is one of fixed.ekf, greedy.ekf.");
}

TEST_CASE("cli: a run that asks for fewer trials than there are says so, and keeps them") {
    const Workplace here;
    add_results(here);
    const std::string before = here.read("small.h5");
    const Outcome fewer = here.credence("run small.ini --resume --trials 10 --quiet -o small.h5");
    CHECK(fewer.exit_code == 0);
    CHECK(fewer.err ==
          "credence run: note: small.h5 has 20 trials of each scenario already, more than --trials 10.\n");
    CHECK(here.read("small.h5") == before);
    CHECK(here.credence("run small.ini --resume --trials 20 --quiet -o small.h5").err.empty());
    CHECK(here.credence("run small.ini --resume --quiet -o small.h5").err.empty());
}

TEST_CASE("cli: a run says how many trials a second it computed of each arm") {
    const Workplace here;
    here.write("small.ini", small_world);
    const Outcome run = here.credence("run small.ini --trials 2000 -o small.h5");
    const std::string head = "\ntrials a second on one thread: fixed.ekf ";
    REQUIRE_THAT(run.out, Contains(head) && Contains(", greedy.ekf "));
    CHECK(std::stod(run.out.substr(run.out.find(head) + head.size())) > 100);
    CHECK_THAT(here.credence("run small.ini --resume -o small.h5").out, !Contains("trials a second"));
}

TEST_CASE("cli: lines of help, reports and progress have less than 120 columns") {
    const Workplace here;
    add_results(here);
    here.write("wide.ini",
               "[scenario]\nname = a-scenario-with-a-name-of-which-one-could-say-that-it-is-rather-too-long\n"
               "title = " +
                   std::string(40, 'w') + " " + std::string(60, 'x') + " " + std::string(60, 'y') +
                   "\nposes = 40\n[arms]\nestimators = ekf, ideal\n[planner]\nspeeds = 1\n");
    std::vector<std::string> commands{
        "--help",
        "--version",
        "show",
        "report small.h5",
        "compare small.h5",
        "watch small.h5",
        "run wide.ini --trials 40 -o wide.h5",
        "compare wide.h5",
        "watch wide.h5",
        "run wide.ini --dry-run -o y.h5",
        "run small.ini --trials 300 --until trace_P=1 -o until.h5",
        "run small.ini --trials 5 -o swept.h5 --sweep 'features.positions=0.5 0.5, 0.9 0.8, 0.3 0.4|"
        "0.5 0.5, 0.9 0.8, 0.3 0.1' "
        "--sweep filter.odometry=0.8,1.2 --sweep noise.deformation=0.1,0.2",
        "watch swept.h5",
        "compare swept.h5"};
    for (const char* command :
         {"run", "report", "judge", "compare", "replay", "merge", "watch", "show", "completion"})
        commands.push_back(std::string(command) + " --help");
    for (const std::string& command : commands) {
        const Outcome outcome = here.credence(command);
        CAPTURE(command, outcome.out, outcome.err);
        CHECK(outcome.exit_code == 0);
        CHECK(longest_line(outcome.out) < 120);
        if (!outcome.err.starts_with("credence ")) CHECK(longest_line(outcome.err) < 120);  // a message is one line
    }
}

}  // namespace credence::test::cli_input_test
