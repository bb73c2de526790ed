#include "report/compare/compare.hpp"
#include <credence/error.hpp>
#include <credence/record.hpp>
#include <credence/detail/store.hpp>
#include <set>

#include "base/program_name.hpp"
#include "cli/command.hpp"
#include "cli/file_kind.hpp"
#include "cli/version.hpp"

namespace credence::cli {

const Command& compare_command() {
    static const Command command{
        "compare",
        "FILE.h5... [--arms A,B] [options]",
        "compare arms or runs trial by trial, A - B",
        "\nOf one file: --arms greedy.ekf,fixed.ekf (a controller alone, greedy,fixed, will do); without --arms every\n"
        "other arm against the fixed arm of its estimator, and every horizon against the greedy one. Of several "
        "files,\n"
        "which must have the same --seed and the same world: --arms A,B takes A from the first and B from the "
        "second, or\n"
        "write FILE:ARM; without --arms the arms of each further file against those of the first, so that the "
        "same world\n"
        "under --set filter.measurement=0.8 shows what that did. Records (" +
            program_name() + " judge) of the same runs are compared too.\n",
        {{"arms", "A,B", "what to compare: ARM or FILE:ARM, twice"},
         failed_option("a warning comes first"),
         format_option({"text", "json", "csv", "html"}),
         output_option("write there, not to the standard output"),
         overwrite_option()}};
    return command;
}

namespace {

void check_paths(const std::vector<std::string>& paths) {
    if (paths.empty()) throw InputError("no results file given. Name one or more FILE.h5.");
    std::set<std::string> seen;
    for (const std::string& path : paths)
        if (!seen.insert(path).second) throw InputError("repeated file " + path + ". Name each once.");
}

/// Results files, or records of the same runs.
std::vector<StudyFile> read_files(const std::vector<std::string>& paths) {
    const bool records = kind_of(paths.front()) == FileKind::record;
    for (const std::string& path : paths) check_kind(path, {records ? FileKind::record : FileKind::results});
    if (records && paths.size() == 1) throw InputError("compare takes several records of the same runs. Give another.");
    std::vector<StudyFile> files;
    for (const std::string& path : paths) {
        if (records && path != paths.front()) require_same_runs(paths.front(), path);
        files.push_back({path, records ? study_of(read_record(path, {}, segments_off)) : read_results(path, 0).study});
        if (records && files.back().study.trials != files.front().study.trials)
            throw InputError("cannot compare " + path + " with " + paths.front() + " (it has " +
                             std::to_string(files.back().study.trials) + " trials, not " +
                             std::to_string(files.front().study.trials) + "). Give records of the same runs.");
    }
    return files;
}

}  // namespace

Rendering compared(const Parsed& parsed) {
    check_paths(parsed.arguments);
    std::optional<ArmsChoice> choice;
    if (const std::optional<std::string> arms = parsed.text("arms")) choice = read_arms(*arms, parsed.arguments);
    const double failed_limit = parse_failed(parsed);
    check_output_option(parsed);
    const std::vector<StudyFile> files = read_files(parsed.arguments);
    CompareReport report = compare_studies(files, choice);
    report.failed_limit = failed_limit;
    report.of_records = kind_of(parsed.arguments.front()) == FileKind::record;
    return [report = std::move(report)](const std::string& format) {
        return format == "json"   ? compare_json(report)
               : format == "csv"  ? compare_csv(report)
               : format == "html" ? compare_html(report, made_by())
                                  : compare_text(report);
    };
}

int compare(const Parsed& parsed) {
    const std::string format = parsed.choice("format");
    write_output(parsed, compared(parsed)(format));
    return 0;
}

}  // namespace credence::cli
