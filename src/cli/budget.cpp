#include "cli/process/progress.hpp"
#include "cli/run/request.hpp"

#include "base/wording.hpp"
#include "report/budget.hpp"

#include <credence/detail/store.hpp>
#include <credence/error.hpp>

#include <omp.h>

namespace credence::cli {

const Command& budget_command() {
    static const Command command{
        "budget",
        "SCENARIO.ini... [options] | FILE.h5 [--of GROUP] [options]",
        "why an error is what it is: by its sources, beside what P counts for each",
        "\nEach source of noise is drawn anew with all others held. The worlds that this takes are run in memory;\n"
        "as a study in FILE.h5, with shards and --resume, by `" +
            program_name() + " run SCENARIO.ini --budget last -o FILE.h5`.\n",
        {{"of", "GROUP", "the component, or group of one unit, that the text is of (default: the first)"},
         {"at", "WHEN", "errors at the last step, or their mean over the steps", false, {"last", "mean"}},
         {"trials", "N", "trials of each world (default 10000)"},
         {"seed", "N", "root seed, from 0 to 2^64 - 1 (default 1)"},
         {"threads", "N", "threads (default: all processors)"},
         set_option(),
         sweep_option(),
         {"quiet", "", "no progress"},
         format_option({"text", "json", "csv", "html"}),
         output_option("write there, not to the standard output"),
         overwrite_option()},
        [](const Parsed& parsed) { return give(parsed, budgeted); }};
    return command;
}

namespace {

void check_of(const Parsed& parsed, const Scenario& scenario) {
    if (const std::optional<std::string> of = parsed.text("of")) check_part(scenario.components, scenario.groups, *of);
}

Study study_in_file(const Parsed& parsed) {
    for (const char* option : {"at", "trials", "seed", "threads", "set", "sweep"})
        if (parsed.has(option))
            throw InputError(as_option(option) + " needs a scenario", "the trials in the file are as they are",
                             "Leave it out, or name SCENARIO.ini");
    if (parsed.arguments.size() > 1) throw InputError("budget takes one results file", {}, "Give FILE.h5");
    Study study = read_results(parsed.arguments.front(), 0).study;
    for (const ScenarioResults& results : study.scenarios) check_of(parsed, results.scenario);
    return study;
}

Study study_run(const Parsed& parsed) {
    RunOptions options;
    options.trials = parsed.integer("trials", options.trials, 2, most_trials);
    options.threads = static_cast<int>(parsed.integer("threads", omp_get_max_threads(), 1, 4096));
    const std::vector<Scenario> worlds = scenarios_of(parsed, kept_errors(parsed, "at").value_or(KeptErrors::last));
    for (const Scenario& world : worlds) check_of(parsed, world);
    Study study = new_study(worlds, parsed.seed(1));
    ProgressLine progress(parsed.has("quiet"));
    options.progress = [&](const Progress& now) { progress(now); };
    run_study(study, options);
    progress.finish();
    return study;
}

}  // namespace

Rendering budgeted(const Parsed& parsed) {
    parsed.choice("format");
    parsed.choice("at");
    check_output_option(parsed);
    if (parsed.arguments.empty()) throw InputError("no scenario given", {}, "Name SCENARIO.ini or FILE.h5");
    const bool is_stored = kind_of(parsed.arguments.front()) == FileKind::results;
    const Study study = is_stored ? study_in_file(parsed) : study_run(parsed);
    return [report = BudgetReport{budgets_of(study), study.root_seed, parsed.text("of").value_or("")}](
               const std::string& format) {
        return format == "html" ? budget_html(report, made_by()) : budget_in(report, format);
    };
}

}  // namespace credence::cli
