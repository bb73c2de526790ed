#pragma once
// Declarations shared by the subcommands. Each subcommand has one file; program.cpp lists them.

#include <credence/ini.hpp>
#include <credence/report.hpp>
#include <credence/detail/store.hpp>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace credence::cli {

/// An option as its help shows it. Every value is read as text first: Boost's own conversions wrap -1 and refuse 1e6.
struct Option {
    std::string name;          ///< long name, with a short one after a comma: "output,o"
    std::string value;         ///< name of its value in the help, FILE or NAME.ext for a file's; empty for a switch
    std::string help;
    bool repeatable = false;
    std::vector<std::string> choices{};  ///< the values that it takes, the first by default; empty: any

    std::string long_name() const { return name.substr(0, name.find(',')); }
    /// The short name, a letter; empty where it has none.
    std::string short_name() const { return name.size() == long_name().size() ? "" : name.substr(name.find(',') + 1); }
};

class Parsed;

/// A subcommand: its help, and what it does.
struct Command {
    std::string name, arguments, summary;
    std::string details;       ///< printed after the options
    std::vector<Option> options;
    int (*work)(const Parsed&);  ///< runs it, and returns the exit code
};

/// The values of options by their long names; a switch has one, which is empty.
using Values = std::map<std::string, std::vector<std::string>>;

/// The parsed command line.
class Parsed {
public:
    std::vector<std::string> arguments;               ///< the arguments that are not options
    Values values;
    const Command* command = nullptr;                 ///< the command they belong to
    std::string line;                                 ///< the command line as given, quoted where a shell needs it

    bool has(const std::string& option) const { return values.count(option) > 0; }
    std::optional<std::string> text(const std::string& option) const;
    /// A whole number in [low, high]; throws InputError naming the option.
    std::int64_t integer(const std::string& option, std::int64_t otherwise, std::int64_t low, std::int64_t high) const;
    /// The value of --seed: any 64-bit number without a sign; throws InputError.
    std::uint64_t seed(std::uint64_t otherwise) const;
    /// A number in [low, high]; throws InputError naming the option.
    double real(const std::string& option, double otherwise, double low, double high) const;
    /// One of the option's choices, the first by default; throws InputError for another one.
    std::string choice(const std::string& option) const;
    /// `--set section.key=value`, in order.
    Overrides overrides() const;
    /// The axes of `--sweep section.key=VALUES`, in order; throws InputError.
    std::vector<SweepAxis> sweep() const;
};

/// Reads the arguments after the subcommand; throws InputError for an unknown, repeated or incomplete option, with the
/// closest known one. Nothing if `--help` was asked for and has been printed.
std::optional<Parsed> parse(const Command& command, const std::vector<std::string>& arguments);
/// The same of arguments and options that are no words, but values in memory.
Parsed parsed_of(const Command& command, std::vector<std::string> arguments, Values values);

/// --margin, --margin-direction, --bias and --failed, with their defaults; throws InputError.
Limits parse_limits(const Parsed& parsed);
/// --failed: `1%` or `0.01` as a number in [0, 1]; throws InputError.
double parse_failed(const Parsed& parsed);

/// --segments: a number of steps, segments_auto or segments_off; throws InputError.
int parse_segments(const Parsed& parsed);

/// --truth-sigma and --truth-dependent, as attributes of a record.
std::map<std::string, std::string> parse_truth(const Parsed& parsed);

/// The output file of `-o`, if it is given. Before any work, refuses files that cannot be written, files that exist
/// unless --overwrite is given, and the files that the command reads.
std::optional<Output> check_output_option(const Parsed& parsed);

/// Prints a text to the standard output, with control characters escaped for the terminal [text.hpp, shown].
void print(const std::string& text);
/// The same to the standard error, flushed at once.
void say(const std::string& text);

/// Says once what may be a mistake in the scenarios.
void say_notes(const std::vector<Scenario>& scenarios, const std::string& command);

/// Writes a text to `-o`'s file, or to the standard output.
void write_output(const Parsed& parsed, const std::string& text);

// Options that several commands share.
Option set_option();
Option sweep_option();
/// --failed; `what`: the consequence of too many failed trials.
Option failed_option(const std::string& what);
Option output_option(const std::string& help, const std::string& value = "FILE");
/// --overwrite, of the commands that write a report or a trajectory to -o.
Option overwrite_option();
/// --format: the first of `formats` by default.
Option format_option(const std::vector<std::string>& formats);

/// Options of report and judge, `more` those of one of them alone.
std::vector<Option> verdict_options(const std::vector<Option>& more = {});

/// A report, the path after which its page is called, and facts of how its numbers came about.
struct Reported {
    Report report;
    std::string path;
    RunFacts run;
};
/// What `report` says of a results file, and `judge` of records.
Reported reported(const Parsed& parsed);
Reported judged(const Parsed& parsed);
std::string rendered(const Report& report, const std::string& format, const std::string& path, const RunFacts& run);
/// Checks the options of report and judge, renders what is made, and returns the exit code.
int give_report(const Parsed& parsed, Reported (*make)(const Parsed&));

/// What is said of files, computed once: its text in a format of the command.
using Rendering = std::function<std::string(const std::string& format)>;
Rendering compared(const Parsed& parsed);
Rendering budgeted(const Parsed& parsed);
/// Writes what is made in the format that is asked for, and returns the exit code.
int give(const Parsed& parsed, Rendering (*make)(const Parsed&));

// The kind of a file that a command was given: a wrong one is refused with the name of the command that reads it.

/// `unknown` includes files that cannot be read: the command itself reports why.
enum class FileKind { scenario, results, trajectories, record, noise, journal, unknown };

/// Of a record also by the path FILE:ARM.
FileKind kind_of(const std::string& path);

/// Throws InputError, naming the command that reads the file, where the file is of a known kind that is not one of
/// `accepted`, the first of which is the command's main kind.
void check_kind(const std::string& path, const std::vector<FileKind>& accepted);

// Facts of the build, for --version and for /run of every file.

std::string version_text();

/// `credence VERSION, git revision REVISION`
std::string made_by();

/// Version, git revision, compiler, flags, processor, instruction set, lane width.
RunFacts build_facts();

// The subcommands.
const Command& run_command();
const Command& report_command();
const Command& judge_command();
const Command& compare_command();
const Command& budget_command();
const Command& replay_command();
const Command& show_command();
const Command& merge_command();
const Command& watch_command();
const Command& completion_command();

/// Runs the words of a command line, without `credence`, and returns the exit code; errors are thrown.
int obey(const std::vector<std::string>& words);
/// Runs the command whose options these are; their line is made up from them.
int obey(Parsed parsed);
/// Throws InputError where this process cannot do the command's work, whatever its arguments: such faults of its
/// environment need not be those of a process on another machine.
void check_process(const std::vector<std::string>& words);

/// The key of the world, which is one of every scenario, with the names of all worlds.
DescribedKey described_world();

/// All subcommands, in the order in which they are shown.
std::vector<const Command*> all_commands();

}  // namespace credence::cli
