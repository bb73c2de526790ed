#include "cli/command.hpp"
#include "cli/process/interrupt.hpp"

#include "base/wording.hpp"
#include <credence/error.hpp>
#include <credence/text.hpp>
#include "report/watch/watch.hpp"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>

namespace credence::cli {

namespace {

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        lines.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return lines;
}

/// Bytes of the first `columns` characters of UTF-8.
std::size_t bytes_of(const std::string& line, int columns) {
    std::size_t at = 0;
    for (; at < line.size(); ++at)
        if ((static_cast<unsigned char>(line[at]) & 0xc0) != 0x80 && columns-- == 0) break;
    return at;
}

/// Whether the standard output is a terminal with cursor control.
bool can_draw() {
    const char* terminal = std::getenv("TERM");
    return isatty(STDOUT_FILENO) == 1 && terminal != nullptr && std::string(terminal) != "dumb";
}

/// The first `lines` lines of a text, each cut to `columns` characters; a last line says where lines are left out.
/// Every character is assumed to be one column wide.
std::string cut_to_fit(const std::string& text, int lines, int columns) {
    std::vector<std::string> all = lines_of(text);
    if (const int left_out = static_cast<int>(all.size()) - lines; left_out > 0) {
        all.resize(static_cast<std::size_t>(std::max(0, lines - 1)));
        all.push_back("... " + std::to_string(left_out + 1) + " more lines (--once prints all)");
    }
    std::string fitting;
    for (std::size_t i = 0; i < all.size(); ++i)
        fitting += (i > 0 ? "\n" : "") + all[i].substr(0, bytes_of(all[i], columns));
    return fitting;
}

/// While an object exists, the terminal shows its alternate screen, which xterm introduced and other terminals have too
/// (the sequences are those of ECMA-48); its destructor restores the former content.
class Screen {
public:
    Screen() { std::cout << "\033[?1049h\033[?25l" << std::flush; }
    ~Screen() { std::cout << "\033[?25h\033[?1049l" << std::flush; }
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    /// Shows as much of the text as fits the terminal, replacing the last one.
    void draw(const std::string& text) {
        winsize size{};
        if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_row == 0 || size.ws_col == 0) size = {24, 80, 0, 0};
        std::cout << "\033[H\033[J" << cut_to_fit(text, size.ws_row, size.ws_col) << std::flush;
    }
};

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

}  // namespace

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
         format_option({"text", "json"})},
        watch};
    return command;
}

}  // namespace credence::cli
