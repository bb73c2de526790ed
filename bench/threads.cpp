#include <omp.h>

#include "worlds/deformable/deformable.hpp"
#include <credence/study.hpp>

#include "rows.hpp"
#include "whole.hpp"

namespace credence::bench {

namespace {

struct Case {
    const char *name, *controller, *path, *noise;
    std::int64_t trials, quick_trials;  ///< some tenths of a second on one thread
};

constexpr Case cases[] = {{"fixed straight constant", "fixed", "straight", "constant", 256 * 1200, 256 * 40},
                          {"greedy straight constant", "greedy", "straight", "constant", 256 * 120, 256 * 4},
                          {"greedy circle ranged", "greedy", "circle", "ranged", 256 * 40, 256 * 4}};

std::string benchmark_name(const Case& c) {
    return std::string("threads/") + c.controller + "-" + c.path + "-" + c.noise;
}

/// 1, 2, 4 ... and all.
std::vector<int> thread_counts() {
    std::vector<int> counts;
    for (int T = 1; T < omp_get_num_procs(); T *= 2) counts.push_back(T);
    counts.push_back(omp_get_num_procs());
    return counts;
}

}  // namespace

void add_threads(const Effort& effort) {
    for (const Case& c : cases) {
        const DeformableSettings scenario = scenario_with(
            "threads", {"arms.controllers", c.controller, "features.path", c.path, "sensor.noise", c.noise});
        for (const int T : thread_counts()) {
            const RunOptions options{effort.of(c.trials, c.quick_trials), T, {}};
            benchmark::RegisterBenchmark((benchmark_name(c) + "/" + std::to_string(T)).c_str(),
                                         [scenario, options](benchmark::State& state) {
                                             for (auto _ : state) {
                                                 Study study = new_study({scenario_of(scenario)}, 1);
                                                 run_study(study, options);
                                             }
                                         })
                ->Iterations(1)
                ->Repetitions(effort.repetitions())
                ->UseRealTime()
                ->Unit(benchmark::kMillisecond);
        }
    }
}

Table threads_table(const Effort& effort) {
    Table table{
        "threads", "Threads: run_study, wall time", {"study", "trials", "threads", "ms", "trials/s", "efficiency"}, {}};
    for (const Case& c : cases) {
        std::map<std::string, Samples> samples = measure(benchmark_name(c));
        const auto trials = effort.of(c.trials, c.quick_trials);
        const double alone = median(samples["1"].real);
        for (const int T : thread_counts()) {
            const double seconds = median(samples[std::to_string(T)].real);
            table.rows.push_back(
                {c.name, trials, T, 1e3 * seconds, static_cast<double>(trials) / seconds, alone / (T * seconds)});
        }
    }
    return table;
}

}  // namespace credence::bench
