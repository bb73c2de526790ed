#include "report/compare/compare.hpp"
#include <credence/error.hpp>
#include <credence/record.hpp>
#include <credence/text.hpp>
#include <credence/detail/store.hpp>
#include <algorithm>
#include <set>
#include <utility>

#include "files/record.hpp"
#include "base/wording.hpp"
#include "cli/command.hpp"

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
            program_name() + " judge) of the same runs are compared\n"
            "too; of a record of several arms, FILE:ARM is one.\n",
        {{"arms", "A,B", "what to compare: ARM or FILE:ARM, twice"},
         failed_option("a warning comes first"),
         format_option({"text", "json", "csv", "html"}),
         output_option("write there, not to the standard output"),
         overwrite_option()},
        [](const Parsed& parsed) { return give(parsed, compared); }};
    return command;
}

namespace {

void check_paths(const std::vector<std::string>& paths) {
    if (paths.empty()) throw InputError("no results file given", {}, "Name one or more FILE.h5");
    std::set<std::string> seen;
    for (const std::string& path : paths)
        if (!seen.insert(path).second) throw InputError("repeated file " + path, {}, "Name each once");
}

/// Files to compare, and, of records that all have it, with the covariance of the truth's errors added to P.
struct ReadFiles {
    std::vector<StudyFile> files, added{};
};

/// Those of a path are arms of one scenario. `all`: the paths of the records, each of the file in `file_of`.
std::vector<StudyFile> files_of(std::vector<Record> records, const SharedSteps& shared,
                                const std::vector<std::string>& paths, const std::vector<std::string>& all,
                                const std::vector<std::size_t>& file_of) {
    std::vector<StudyFile> files;
    if (records.empty()) return files;
    for (const std::string& path : paths) files.push_back({path, {}, true, {}, {}, shared.of_any, shared.of_all});
    for (std::size_t i = 0; i < all.size(); ++i) {
        StudyFile& file = files[file_of[i]];
        Study one = study_of(std::move(records[i]));
        file.steps_of_arms.push_back(shared.of_each[i]);
        if (file.study.scenarios.empty()) {
            file.study = std::move(one);
            file.study.scenarios.front().scenario.title = "record " + printable(file.path);
            continue;
        }
        ScenarioResults &arms = file.study.scenarios.front(), &other = one.scenarios.front();
        const auto named = [](const Column& column) { return column.name + " " + column.unit; };
        if (!std::ranges::equal(arms.columns, other.columns, {}, named, named))
            throw InputError("cannot compare " + all[i] + " with " + all.front(),
                             "they have other columns, or in other units", "Give records of the same runs");
        arms.arms.push_back(std::move(other.arms.front()));
    }
    return files;
}

/// Records are called by their arms, or by scenario and arm.
void name_records(std::vector<StudyFile>& files) {
    std::vector<std::string> scenarios, arms;
    for (StudyFile& file : files) {
        ScenarioResults& results = file.study.scenarios.front();
        scenarios.push_back(std::exchange(results.scenario.name, "record"));
        arms.push_back(results.arms.size() == 1 ? std::exchange(results.arms.front().name, "record") : "record");
    }
    if (!std::ranges::count(arms, "record")) {
        const bool differ = std::set<std::string>(arms.begin(), arms.end()).size() == arms.size();
        for (std::size_t i = 0; i < files.size(); ++i)
            files[i].label = differ ? arms[i] : scenarios[i] + ":" + arms[i];
    }
}

/// Records of the same runs.
ReadFiles read_record_files(const std::vector<std::string>& paths) {
    std::vector<std::string> all;
    std::vector<std::size_t> file_of;
    for (std::size_t i = 0; i < paths.size(); ++i)
        for (const std::string& record : records_in(paths[i])) all.push_back(record), file_of.push_back(i);
    if (all.size() == 1) throw InputError("compare takes several records of the same runs", {}, "Give another");
    SharedSteps shared;
    std::vector<Record> added, records = read_same_runs(all, shared, added);
    ReadFiles read{files_of(std::move(records), shared, paths, all, file_of),
                   files_of(std::move(added), shared, paths, all, file_of)};
    name_records(read.files);
    name_records(read.added);
    return read;
}

/// Results files, or records.
ReadFiles read_files(const std::vector<std::string>& paths) {
    const bool records = kind_of(paths.front()) == FileKind::record;
    for (const std::string& path : paths) check_kind(path, {records ? FileKind::record : FileKind::results});
    if (records) return read_record_files(paths);
    ReadFiles read;
    for (const std::string& path : paths) read.files.push_back({path, read_results(path, 0).study});
    return read;
}

}  // namespace

Rendering compared(const Parsed& parsed) {
    check_paths(parsed.arguments);
    std::optional<ArmsChoice> choice;
    if (const std::optional<std::string> arms = parsed.text("arms")) choice = read_arms(*arms, parsed.arguments);
    const double failed_limit = parse_failed(parsed);
    check_output_option(parsed);
    const auto [files, added] = read_files(parsed.arguments);
    CompareReport report = compare_studies(files, choice);
    if (!added.empty()) require_same_sign(report, compare_studies(added, choice));
    report.failed_limit = failed_limit;
    report.of_records = files.front().is_record;
    return [report = std::move(report)](const std::string& format) {
        return format == "json"   ? compare_json(report)
               : format == "csv"  ? compare_csv(report)
               : format == "html" ? compare_html(report, made_by())
                                  : compare_text(report);
    };
}

}  // namespace credence::cli
