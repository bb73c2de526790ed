#pragma once
// The interface between Google Benchmark, which times, and the tables: measured times by name.

#include <benchmark/benchmark.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace credence::bench {

/// How long to measure.
struct Effort {
    bool quick = false;
    int repetitions() const { return quick ? 3 : 9; }
    double seconds() const { return quick ? 0.001 : 0.03; }  ///< at least, of one repetition
    /// The full number, or the one for a quick run.
    template <class Number>
    Number of(Number full, Number when_quick) const {
        return quick ? when_quick : full;
    }
};

/// The results of a benchmark's repetitions, seconds per iteration.
struct Samples {
    std::vector<double> real, cpu;
    std::map<std::string, std::vector<double>> counters;
};

double median(std::vector<double> values);

/// Registers a benchmark that is measured for effort.seconds() in each of effort.repetitions().
benchmark::internal::Benchmark* add(const std::string& name, const Effort& effort,
                                    const std::function<void(benchmark::State&)>& body);

/// Runs the registered benchmarks of a group, `group/...`, their repetitions in random order, so that a drifting clock
/// affects all of them alike. Results are by name without the group.
std::map<std::string, Samples> measure(const std::string& group);

/// Seconds of CPU time that this process has used, all threads.
double process_seconds();

}  // namespace credence::bench
