#include "cli/command.hpp"

#include <credence/error.hpp>
#include <credence/report.hpp>

#include <filesystem>

namespace credence::cli {

const Command& report_command() {
    static const Command command{
        "report",
        "FILE.h5 [options]",
        "say what a results file proves, with confidence",
        "\nWith --require consistent the exit code is 1 unless every arm's verdict is `consistent`; with --require\n"
        "no-finding it is 1 if an arm is refuted: `undecided` passes.\n",
        verdict_options(),
        [](const Parsed& parsed) { return give_report(parsed, reported); }};
    return command;
}

std::vector<Option> verdict_options(const std::vector<Option>& more) {
    std::vector<Option> options{
        {"margin", "SHARE", "NEES/dimension within 1 -+ this counts as consistent (default 5%)"},
        {"margin-direction", "SHARE",
         "the squared error of every combination of the state, over what P says, within 1 -+ this counts (default: "
         "twice the margin)"},
        {"bias", "SIGMAS", "a mean error of a component within this many of its sigmas counts (default 0.1)"},
        failed_option("the verdict is `failed`"),
        format_option({"text", "json", "csv", "html"}),
        {"require", "VERDICT",
         "consistent: exit with 1 unless all are shown to be; no-finding: unless none is refuted", false,
         {"consistent", "no-finding"}},
        {"strict", "", "notes count as findings for --require"},
        output_option("write there, not to the standard output"),
        overwrite_option()};
    options.insert(options.end() - 2, more.begin(), more.end());
    return options;
}

std::string rendered(const Report& report, const std::string& format, const std::string& path, const RunFacts& run) {
    if (format == "json") return report_json(report);
    if (format == "csv") return report_csv(report);
    if (format == "html") return report_html(report, {std::filesystem::path(path).filename().string(), run, made_by()});
    return report_text(report);
}

int give_report(const Parsed& parsed, Reported (*make)(const Parsed&)) {
    const std::string format = parsed.choice("format");
    check_output_option(parsed);
    if (parsed.has("require")) parsed.choice("require");
    else if (parsed.has("strict"))
        throw InputError("--strict says nothing without --require", {},
                         "Add --require no-finding or --require consistent");
    const Reported given = make(parsed);
    write_output(parsed, rendered(given.report, format, given.path, given.run));
    if (parsed.has("require"))
        require(given.report,
                parsed.choice("require") == "consistent" ? Requirement::consistent : Requirement::no_finding,
                parsed.has("strict"));
    return 0;
}

Reported reported(const Parsed& parsed) {
    if (parsed.arguments.size() != 1) throw InputError("report takes one results file", {}, "Give FILE.h5");
    const std::string& path = parsed.arguments.front();
    const Limits limits = parse_limits(parsed);
    check_kind(path, {FileKind::results});
    StoredStudy stored = read_results(path, most_totals_in_memory);
    return {make_report(stored.study, limits), path, std::move(stored.run)};
}

}  // namespace credence::cli
