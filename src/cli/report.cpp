#include "cli/command.hpp"
#include "cli/file_kind.hpp"
#include "cli/version.hpp"

#include <credence/error.hpp>
#include <credence/report.hpp>
#include <credence/store.hpp>

#include <filesystem>

namespace credence::cli {

const Command& report_command() {
    static const Command command{
        "report",
        "FILE.h5 [options]",
        "say what a results file proves, with confidence",
        "\nWith --require consistent the exit code is 1 unless every arm's verdict is `consistent`.\n",
        {margin_option(),
         margin_direction_option(),
         bias_option(),
         failed_option("the verdict is `failed`"),
         format_option({"text", "json", "csv", "html"}),
         {"require", "VERDICT", "consistent: exit with 1 unless every arm is", false, {"consistent"}},
         output_option("write there, not to the standard output"),
         overwrite_option()}};
    return command;
}

ReportRequest read_report_request(const Parsed& parsed) {
    const ReportRequest request{parsed.choice("format"), parse_limits(parsed)};
    check_output_option(parsed);
    if (parsed.has("require")) parsed.choice("require");
    return request;
}

int give_report(const Parsed& parsed, const ReportRequest& request, const Report& report, const std::string& path,
                const RunFacts& run) {
    const auto page = [&] {
        return report_html(report, {std::filesystem::path(path).filename().string(), run, made_by()});
    };
    write_output(parsed, request.format == "json"   ? report_json(report)
                         : request.format == "csv"  ? report_csv(report)
                         : request.format == "html" ? page()
                                                    : report_text(report));
    if (parsed.has("require")) require_consistent(report);
    return 0;
}

int report(const Parsed& parsed) {
    if (parsed.arguments.size() != 1) throw InputError("report takes one results file. Give FILE.h5.");
    const ReportRequest request = read_report_request(parsed);
    const std::string& path = parsed.arguments.front();
    check_kind(path, {FileKind::results});
    const StoredStudy stored = read_results(path, most_totals_in_memory);
    return give_report(parsed, request, make_report(stored.study, request.limits), path, stored.run);
}

}  // namespace credence::cli
