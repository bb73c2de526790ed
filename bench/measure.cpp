#include "measure.hpp"

#include <algorithm>
#include <ctime>
#include <iostream>
#include <stdexcept>

namespace credence::bench {

namespace {

/// Keeps what is reported to it.
class Collector : public benchmark::BenchmarkReporter {
public:
    explicit Collector(std::size_t prefix) : prefix_(prefix) {}

    bool ReportContext(const Context&) override { return true; }

    void ReportRuns(const std::vector<Run>& runs) override {
        for (const Run& run : runs) {
            if (run.run_type != Run::RT_Iteration || run.iterations == 0) continue;
            Samples& samples = collected[run.run_name.function_name.substr(prefix_)];
            const auto iterations = static_cast<double>(run.iterations);
            samples.real.push_back(run.real_accumulated_time / iterations);
            samples.cpu.push_back(run.cpu_accumulated_time / iterations);
            for (const auto& [name, counter] : run.counters) samples.counters[name].push_back(counter.value);
        }
    }

    std::map<std::string, Samples> collected;

private:
    std::size_t prefix_;
};

}  // namespace

double median(std::vector<double> values) {
    if (values.empty()) throw std::runtime_error("nothing was measured");
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

benchmark::internal::Benchmark* add(const std::string& name, const Effort& effort,
                                    const std::function<void(benchmark::State&)>& body) {
    return benchmark::RegisterBenchmark(name.c_str(), body)
        ->Repetitions(effort.repetitions())
        ->MinTime(effort.seconds())
        ->Unit(benchmark::kMicrosecond);
}

std::map<std::string, Samples> measure(const std::string& group) {
    std::cerr << "measuring " << group << std::endl;
    Collector collector(group.size() + 1);
    benchmark::RunSpecifiedBenchmarks(&collector, "^" + group + "/");
    return collector.collected;
}

double process_seconds() {
    std::timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace credence::bench
