#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include "worlds/deformable/deformable.hpp"
#include <credence/detail/store.hpp>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "../tests/temporary_folder.hpp"
#include "rows.hpp"
#include "whole.hpp"

extern char** environ;

namespace credence::bench {

namespace {

struct Case {
    const char *name, *id, *controllers;
    std::int64_t trials, quick_trials;
};

constexpr Case cases[] = {{"fixed path only", "fixed", "fixed", 1'000'000, 50'000},
                          {"the seed's arms, fixed and greedy", "both", "fixed, greedy", 100'000, 5'000},
                          {"the same, a small study", "small", "fixed, greedy", 1'000, 1'000}};

double wall_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Runs the program; returns its CPU time, user and system.
double run_program(std::vector<std::string> arguments) {
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_t child = 0;
    if (posix_spawn(&child, argv[0], nullptr, nullptr, argv.data(), environ) != 0)
        throw std::runtime_error("cannot run " + arguments[0]);
    int status = 0;
    rusage usage{};
    if (wait4(child, &status, 0, &usage) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw std::runtime_error(arguments[0] + " failed");
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Puts as many bytes on the disk as the results file has: the disk's own rate.
void write_bytes(const std::string& path, std::size_t size) {
    const std::vector<char> bytes(size, 'x');
    const int file = open(path.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
    const bool written = file >= 0 && write(file, bytes.data(), size) == static_cast<ssize_t>(size) && fsync(file) == 0;
    if (file >= 0) close(file);
    if (!written) throw std::runtime_error("cannot write " + path);
}

/// The data that the parts of a case have in common.
struct Job {
    const test::TemporaryFolder folder;
    DeformableSettings scenario;
    std::int64_t trials = 0;
    Study study;  ///< run once, for the parts that write it
    std::size_t size = 0;

    Job(const Case& c, const Effort& effort)
        : scenario(scenario_with("program", {"arms.controllers", c.controllers})),
          trials(effort.of(c.trials, c.quick_trials)),
          study(new_study({scenario_of(scenario)}, 1)) {
        run_study(study, {trials, 1, {}});
        write_results(folder / "results.h5", study, {});
        size = std::filesystem::file_size(folder / "results.h5");
        write_text_file(folder / "program.ini", std::string("[arms]\ncontrollers = ") + c.controllers + "\n");
    }

    double program() const {
        return run_program({CREDENCE_PROGRAM, "run", folder / "program.ini", "--trials", std::to_string(trials),
                            "--threads", "1", "--output", folder / "program.h5", "--overwrite", "--quiet"});
    }
    /// Removes what the parts have written: to give back the space of a former file takes time as well.
    void clear() const {
        for (const char* name : {"results.h5", "program.h5", "disk"}) std::filesystem::remove(folder / name);
    }
    void engine() const {
        Study fresh = new_study({scenario_of(scenario)}, 1);
        run_study(fresh, {trials, 1, {}});
    }
};

/// `part(job)` once an iteration; it returns its CPU time, or nothing where this process's is meant.
template <class Part>
void add_part(const std::string& name, const Effort& effort, const std::function<Job&()>& job, Part part) {
    benchmark::RegisterBenchmark(name.c_str(),
                                 [job, part](benchmark::State& state) {
                                     Job& ready = job();
                                     for (auto _ : state) {
                                         ready.clear();
                                         const double cpu = process_seconds(), wall = wall_seconds();
                                         const double child = part(ready);
                                         state.SetIterationTime(wall_seconds() - wall);
                                         state.counters["cpu"] = process_seconds() - cpu + child;
                                         state.counters["bytes"] = static_cast<double>(ready.size);
                                     }
                                 })
        ->Iterations(1)
        ->Repetitions(effort.of(5, 1))
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
}

}  // namespace

void add_program(const Effort& effort) {
    for (const Case& c : cases) {
        const auto kept = std::make_shared<std::unique_ptr<Job>>();
        const auto job = [kept, c, effort]() -> Job& {
            if (!*kept) *kept = std::make_unique<Job>(c, effort);
            return **kept;
        };
        const std::string group = std::string("program/") + c.id + "/";
        add_part(group + "program", effort, job, [](const Job& j) { return j.program(); });
        add_part(group + "engine", effort, job, [](const Job& j) { return j.engine(), 0.0; });
        add_part(group + "write", effort, job,
                 [](const Job& j) { return write_results(j.folder / "results.h5", j.study, {}), 0.0; });
        add_part(group + "disk", effort, job,
                 [](const Job& j) { return write_bytes(j.folder / "disk", j.size), 0.0; });
    }
}

Table program_table(const Effort& effort) {
    Table table{"program",
                "The whole program with its file, one thread (seconds; write share: of the CPU time)",
                {"study", "trials", "file MB", "program CPU", "program wall", "engine CPU", "write CPU",
                 "write share %", "write wall", "same bytes, disk wall"},
                {}};
    for (const Case& c : cases) {
        std::map<std::string, Samples> samples = measure(std::string("program/") + c.id);
        const auto cpu = [&](const char* part) { return median(samples[part].counters["cpu"]); };
        const auto wall = [&](const char* part) { return median(samples[part].real); };
        const double engine = cpu("engine"), write = cpu("write");
        table.rows.push_back({c.name, effort.of(c.trials, c.quick_trials),
                              1e-6 * median(samples["program"].counters["bytes"]), cpu("program"), wall("program"),
                              engine, write, 100 * write / (engine + write), wall("write"), wall("disk")});
    }
    return table;
}

}  // namespace credence::bench
