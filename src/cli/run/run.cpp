#include "cli/process/interrupt.hpp"
#include "cli/process/progress.hpp"
#include "cli/run/request.hpp"

#include "base/wording.hpp"
#include <credence/error.hpp>
#include <credence/report.hpp>
#include <credence/detail/store.hpp>
#include <credence/text.hpp>

#include <algorithm>
#include <chrono>
#include <ctime>

namespace credence::cli {

namespace {

bool nothing_missing(const Study& study, const RunOptions& options) {
    for (const ScenarioResults& results : study.scenarios)
        if (!missing_blocks(results, options.trials, options.shard).empty()) return false;
    return study.trials >= options.trials;
}

std::string now_text() {
    const std::time_t now = std::time(nullptr);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
    return text;
}

/// The outcome of a run.
struct Work {
    bool changed = false;
    double seconds = 0;
    std::map<std::string, ArmTime> times;
    std::optional<InterimAnalysis> last_analysis;  ///< with --until
};

/// Runs the missing blocks of the request.
Work work_on(StoredRun& stored, const RunRequest& request) {
    const auto start = std::chrono::steady_clock::now();
    Work work;
    RunOptions options = request.options;
    options.stop = Interrupt::came_after_block;
    options.times = &work.times;
    if (request.goals.empty() && nothing_missing(stored.study(), options)) return work;
    // With --until the number of trials is not known yet: each interim analysis asks for its own.
    options.keeper = &stored.begin(request.goals.empty() ? options.trials : 0, request.commit_every, options.shard);
    if (!request.goals.empty()) {
        work.last_analysis = grow_until_precise(stored.study(), request, options);
    } else {
        ProgressLine progress(request.quiet);
        options.progress = [&](const Progress& now) { progress(now); };
        run_study(stored.study(), options);
        progress.finish();
    }
    Interrupt::end_blocks();
    work.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return work;
}

RunFacts facts_of(const RunRequest& request, const Work& work, const std::string& started,
                  const std::string& command_line) {
    RunFacts facts = build_facts();
    facts.emplace_back("started", started);
    facts.emplace_back("threads", std::to_string(request.options.threads));
    facts.emplace_back("wall_seconds", to_text(work.seconds));
    facts.emplace_back("command_line", command_line);
    return facts;
}

/// The command that resumes a run that was stopped.
std::string resuming(std::string command_line, const Shard& shard) {
    const std::string overwrite = " --overwrite", resume = " --resume";
    if (const std::size_t at = command_line.find(overwrite); at != std::string::npos)
        command_line.erase(at, overwrite.size());
    for (const std::string before : {" --shard ", " --shard="})  // the launcher's shard applied to that job only
        if (const std::size_t at = command_line.find(before + "auto"); at != std::string::npos)
            command_line.replace(at + before.size(), 4,
                                 std::to_string(shard.index) + "/" + std::to_string(shard.count));
    return wording().resumption(command_line.find(resume) == std::string::npos ? command_line + resume : command_line);
}

int stopped(const StoredRun& stored, const RunRequest& request, const std::string& command_line) {
    std::int64_t done = 0;
    for (const ScenarioResults& results : stored.study().scenarios) done += results.trials;
    say(program_name() + " run: stopped by " + Interrupt::name() + " with " + std::to_string(done) +
        " trials kept in " + printable(request.output) + " (complete = 0). To resume it:\n  " +
        resuming(command_line, request.options.shard) + "\n");
    return 3;
}

/// How fast each arm was computed, by a thread.
std::string speeds_text(const Work& work) {
    std::vector<std::string> speeds;
    for (const auto& [arm, time] : work.times) {
        const double rate = static_cast<double>(time.trials) / std::max(time.seconds, 1e-9);
        speeds.push_back(arm + " " + number(rate, rate < 10 ? 2 : 0));
    }
    return speeds.empty() ? "" : wrapped_list("trials a second on one thread:", speeds, 0) + "\n";
}

void print_table(const Study& study, const RunRequest& request, const Work& work) {
    print(report_text(make_report(study, {})) + "\n" + (work.last_analysis ? stopping_text(*work.last_analysis) : "") +
          printable(request.output) +
          (work.changed ? ": " + file_size_text(request.output) + ", computed in " + duration_text(work.seconds) +
                              " on " + std::to_string(request.options.threads) + " threads\n"
                        : " has these trials already\n") + speeds_text(work));
}

/// Runs and writes the results. Failures are thrown with the progress that is kept.
Work keep(StoredRun& stored, const RunRequest& request, const std::string& command_line) {
    const std::string started = now_text();
    try {
        Interrupt::begin_blocks(program_name() +
                                " run: stopped by a signal, and a block did not end (does a trial go on for ever?). "
                                "What was committed is kept, and this resumes the run: " +
                                resuming(command_line, request.options.shard) + "\n");
        Work work = work_on(stored, request);
        work.changed = stored.finish(facts_of(request, work, started, command_line));
        return work;
    } catch (const InputError&) {
        stored.keeps_something();  // or its journal is removed
        throw;
    } catch (const Failure& failure) {
        Complaint complaint = failure.complaint();
        if (!complaint.remedy.empty() && !complaint.remedy.ends_with('.')) complaint.remedy += ".";
        complaint.remedy += std::string(complaint.remedy.empty() ? "" : " ") +
                            (stored.keeps_something() ? "What was committed is kept, and this resumes the run: `" +
                                                            resuming(command_line, request.options.shard) + "`"
                                                      : "Nothing had been committed");
        throw Failure(complaint);
    }
}

int run(const Parsed& parsed) {
    RunRequest request = read_request(parsed);
    const Interrupt interrupt;
    StoredRun stored = starting_run(request);
    if (!request.quiet) say_notes(request.scenarios, "run");
    if (parsed.has("dry-run")) return dry_run(request, stored.study());
    if (!parsed.has("force")) check_fit(request, stored.study());

    const std::int64_t there = least_trials(stored.study());
    if (request.trials_given && request.goals.empty() && there > request.options.trials)
        say(program_name() + " run: note: " + printable(request.output) + " has " + std::to_string(there) +
            " trials of each scenario already, more than " +
            as_option("trials", std::to_string(request.options.trials)) + ".\n");
    const Work work = keep(stored, request, parsed.line);
    if (Interrupt::came() && !stored.study().complete) return stopped(stored, request, parsed.line);
    if (work.last_analysis && !work.last_analysis->met)
        say(program_name() + " run: " + imprecision_text(*work.last_analysis, request.rule()) + "\n");
    if (!request.quiet) print_table(stored.study(), request, work);
    return 0;
}

}  // namespace

const Command& run_command() {
    static const Command command{
        "run",
        "SCENARIO.ini... [options] | --resume -o FILE.h5 [options]",
        "run a study: every scenario under all its arms",
        "\nThe same scenarios and seed give the same results for any number of threads, shards and interruptions.\n"
        "Until the results file is written, FILE.h5.journal beside it keeps what is done. Ctrl-C stops the run with\n"
        "everything kept (exit code 3), and --resume resumes it; without scenarios, with those of the file.\n",
        {output_option("results file (default credence.h5)", "FILE.h5"),
         {"trials", "N", "trials of each scenario (default 10000)"},
         {"seed", "N", "root seed, from 0 to 2^64 - 1 (default 1)"},
         {"threads", "N", "threads (default: all processors)"},
         set_option(),
         sweep_option(),
         {"until", "METRIC=HALFWIDTH",
          "stop at the first interim analysis (4096 trials, 8192 ...) at which this mean is known to +- HALFWIDTH, "
          "such as trace_P=0.5% or 'trace_P[greedy-fixed]=0.01'; --trials is the ceiling then (default 10^7); "
          "repeatable: all must be met",
          true},
         {"shard", "I/N",
          "run block b of 256 trials where b mod N = I only; `" + program_name() +
              " merge` joins the files; auto: the "
              "shard that the Slurm array, srun or mpirun names; {shard} in the name of the results file becomes I"},
         {"resume", "",
          "run what is missing after an interruption, or to a larger --trials; start where there is nothing"},
         {"overwrite", "", "replace a results file that exists"},
         {"keep",
          "WHAT",
          "trials: one number a trial of every column (default); aggregates: their totals over the trials only, in "
          "memory, journal and file alike, for studies of more trials than a disk holds: no medians, no distributions",
          false,
          {"trials", "aggregates"}},
         {"budget", "WHEN",
          "run the worlds of a budget, which `" + program_name() + " budget` reads from the results file: with errors "
          "at the last step, or their mean over the steps",
          false, {"last", "mean"}},
         {"commit-every", "BLOCKS",
          "blocks of 256 trials after which the journal is made to last (default: after half a second)"},
         {"dry-run", "", "say what time, memory and file size to expect, and stop"},
         {"force", "", "start a run that --dry-run says cannot fit"},
         {"quiet", "", "no progress and no table"}},
        run};
    return command;
}

}  // namespace credence::cli
