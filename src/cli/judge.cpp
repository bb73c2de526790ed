#include "cli/command.hpp"
#include "cli/process/progress.hpp"
#include "files/record.hpp"

#include <credence/error.hpp>
#include <credence/record.hpp>
#include <credence/report.hpp>

#include <algorithm>
#include <iterator>

namespace credence::cli {

const Command& judge_command() {
    static const Command command{
        "judge",
        "RECORD.h5 [MORE.h5 ...] [options]",
        "the verdict on anyone's filter, from the errors and covariances it made",
        "\nRECORD.h5 holds, with the root's attribute record_version = 2, the datasets\n"
        "  error                  [trial, step, n]     estimate - truth, in the chart of the covariance\n"
        "  covariance             [trial, step, n, n]  or [trial, step, n]: variances only\n"
        "  steps                  [trial]              optional: steps of each run; one that ends early else has "
        "failed\n"
        "  innovation             [trial, step, m]     optional; NaN where a row was not observed\n"
        "  innovation_covariance  [trial, step, m, m]  with it\n"
        "and, on the file, the attribute `groups`, such as \"position 0 2, feature_1 3:5\" (from 0, the end of a "
        "range\n"
        "not included): parts of the state that are judged by themselves. A component is NaN where it is not in the\n"
        "state. docs/judge.md has the rest, such as covariances or NEES of groups alone, and poses on manifolds.\n"
        "Of a record of several arms, FILE:ARM is one.\n"
        "With --require consistent the exit code is 1 unless the verdict is `consistent`; with --require no-finding it "
        "is 1\nif the filter is refuted: `undecided` passes.\n",
        verdict_options({{"segments", "STEPS",
                          "count few long runs by segments of so many steps; off; or auto (the default): ten times the "
                          "steps over which errors decorrelate, for up to 200 runs"},
                         {"truth-sigma", "SIGMA",
                          "of the truth's own errors: of every component in its unit, such as 0.005, or of groups and "
                          "components, such as position=0.005,heading=0.1deg; an upper bound"},
                         {"truth-dependent", "", "the truth was made of data that the filter used"},
                         {"quiet", "", "no progress"}}),
        [](const Parsed& parsed) { return give_report(parsed, judged); }};
    return command;
}

Reported judged(const Parsed& parsed) {
    if (parsed.arguments.empty()) throw InputError("judge takes one record or several", {}, "Give RECORD.h5");
    const Limits limits = parse_limits(parsed);
    const int segments = parse_segments(parsed);
    std::vector<std::string> records;
    for (const std::string& path : parsed.arguments) {
        check_kind(path, {FileKind::record});
        std::ranges::copy(records_in(path), std::back_inserter(records));
    }
    std::vector<Report> reports;
    RunFacts facts;
    for (const std::string& path : records) {
        ProgressLine progress(parsed.has("quiet"));
        Record record = read_record(path, [&](const Progress& now) { progress(now); }, segments,
                                    parse_truth(parsed));
        progress.finish();
        if (!record.log.empty() && records.size() == 1) facts = {{"log", record.log}};
        reports.push_back(make_record_report(std::move(record), path, limits));
    }
    return {together(std::move(reports)), parsed.arguments.front(), facts};
}

}  // namespace credence::cli
