#include "command.hpp"

#include <credence/error.hpp>
#include <credence/report.hpp>
#include <credence/store.hpp>

namespace credence::cli {

const Command& report_command() {
    static const Command command{
        "report",
        "FILE.h5 [options]",
        "say what a results file proves, with confidence",
        "\nWith --require consistent the exit code is 1 unless every arm's verdict is `consistent`.\n",
        {margin_option(),
         {"format", "FORMAT", "text (default), json or csv"},
         {"require", "VERDICT", "consistent: exit with 1 unless every arm is"},
         output_option("write there, not to the standard output")}};
    return command;
}

int report(const Parsed& parsed) {
    if (parsed.arguments.size() != 1) throw InputError("report takes one results file. Give FILE.h5.");
    const std::string format = parsed.choice("format", {"text", "json", "csv"});
    const double margin = parse_margin(parsed);
    check_output_option(parsed);
    if (parsed.has("require")) parsed.choice("require", {"consistent"});
    const Report report = make_report(read_results(parsed.arguments.front()).study, margin);
    write_output(parsed, format == "json"  ? report_json(report)
                         : format == "csv" ? report_csv(report)
                                           : report_text(report));
    if (parsed.has("require")) require_consistent(report);
    return 0;
}

}  // namespace credence::cli
