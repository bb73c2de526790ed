#include "cli/command.hpp"
#include "cli/file_kind.hpp"
#include "cli/process/interrupt.hpp"
#include "cli/process/screen.hpp"

#include "base/program_name.hpp"
#include <credence/error.hpp>
#include <credence/text.hpp>
#include "report/watch/watch.hpp"

#include <poll.h>

#include <chrono>

namespace credence::cli {

const Command& watch_command() {
    static const Command command{
        "watch",
        "FILE.h5 [options]",
        "follow a run: what is committed so far, with intervals",
        "\nReads FILE.h5.journal while the run goes on and FILE.h5 when it is done; the run does not notice. On a\n"
        "terminal the table is drawn again until the run ends (exit code 0) or Ctrl-C ends the watching (3); the run\n"
        "goes on then. When output is not a terminal, one snapshot is printed. To watch and stop when an interval is\n"
        "narrow enough is not `" + program_name() + " run --until`, whose intervals allow for its interim analyses.\n",
        {{"every", "SECONDS", "seconds between two snapshots on a terminal (default 2)"},
         {"once", "", "one snapshot, on a terminal too"},
         format_option({"text", "json"})}};
    return command;
}

namespace {

/// Waits in slices, so that a signal is noticed soon.
void wait(double seconds) {
    using namespace std::chrono;
    constexpr int slice = 100;  // ms
    const auto end = steady_clock::now() + duration<double>(seconds);
    while (!Interrupt::came() && steady_clock::now() < end) {
        const double left = duration<double, std::milli>(end - steady_clock::now()).count();
        poll(nullptr, 0, left < slice ? static_cast<int>(left) + 1 : slice);
    }
}

/// The last snapshot.
Snapshot follow(RunWatch& run, double every) {
    Snapshot snapshot = run.snapshot();
    if (snapshot.ended()) return snapshot;
    Screen screen;
    for (; !snapshot.ended() && !Interrupt::came(); snapshot = run.snapshot()) {
        screen.draw(shown(watch_text(snapshot)));
        wait(every);
    }
    return snapshot;
}

/// FILE.h5, also where the name of its journal was given.
std::string results_path(const std::string& given) {
    const std::string journal = ".journal";
    return given.ends_with(journal) ? given.substr(0, given.size() - journal.size()) : given;
}

}  // namespace

int watch(const Parsed& parsed) {
    if (parsed.arguments.size() != 1) throw InputError("watch takes one results file", {}, "Give FILE.h5");
    const std::string format = parsed.choice("format");
    const double every = parsed.real("every", 2, 0.1, 3600);
    check_kind(parsed.arguments.front(), {FileKind::results, FileKind::journal});
    RunWatch run(results_path(parsed.arguments.front()));
    if (format == "json" || parsed.has("once") || !can_draw()) {
        const Snapshot snapshot = run.snapshot();
        print(format == "json" ? watch_json(snapshot) : watch_text(snapshot));
        return 0;
    }
    const Interrupt interrupt;
    const Snapshot snapshot = follow(run, every);
    print(watch_text(snapshot));
    return snapshot.ended() ? 0 : 3;
}

}  // namespace credence::cli
