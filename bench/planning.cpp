// The cost of a step with each controller: the fixed path, the greedy planner, and horizons of two and three steps, on
// the best target. All are measured in turns in one process, by the processor's time; medians, since the clock drifts.
//   credence_bench_planning [ROUNDS]      (default 5)

#include "worlds/deformable/deformable.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "rows.hpp"

namespace credence::bench {
namespace {

// Beyond the detailed trials.
constexpr std::int64_t block_index = 20;

double processor_seconds() {
    timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// One arm of one cell, and its times.
struct Measured {
    Row row;
    int trials = octet;  ///< as many as take a tenth of a second, or a block
    std::vector<double> microseconds;

    Measured(const std::string& name, const DeformableSettings& scenario) : row(name, scenario, block_size) {}

    double seconds(int count) const {
        const double start = processor_seconds();
        run_block(row.problem, 1, block_index, count);
        return processor_seconds() - start;
    }
    void settle() {
        while (trials < block_size && seconds(trials) < 0.1) trials *= 2;
    }
    void measure() {
        int runs = 0;
        double sum = 0;
        while (sum < 0.1) sum += seconds(trials), ++runs;
        microseconds.push_back(1e6 * sum / runs / trials / (row.problem.view().poses - 1));
    }
    double median() {
        std::sort(microseconds.begin(), microseconds.end());
        return microseconds[microseconds.size() / 2];
    }
};

/// Three digits, and all of those before the point.
std::string number_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, value < 100 ? "%.3g" : "%.0f", value);
    return text;
}

/// A line: the median of each arm in microseconds a step, those of the horizons over the greedy planner's.
void measure_cell(const std::string& process, const std::string& path, const std::string& noise, int rounds) {
    const std::vector<std::string> cell{"model.process", process, "features.path", path, "sensor.noise", noise};
    const auto with = [&](const std::vector<std::string>& more) {
        std::vector<std::string> all = cell;
        all.insert(all.end(), more.begin(), more.end());
        return scenario_with("cell", all);
    };
    Measured arms[]{{"fixed", with({"arms.controllers", "fixed"})},
                    {"greedy", with({"arms.controllers", "greedy"})},
                    {"horizon 2", with({"arms.controllers", "horizon", "planner.horizon", "2"})},
                    {"horizon 3", with({"arms.controllers", "horizon", "planner.horizon", "3"})}};
    for (Measured& arm : arms) arm.settle();
    for (int round = 0; round < rounds; ++round)
        for (Measured& arm : arms) arm.measure();
    const double greedy = arms[1].median(), two = arms[2].median(), three = arms[3].median();
    std::printf("| %s, %s, %s | %d | %s | %s | %s | %s | %s | %s |\n", process == "heading" ? "ekf" : "kf", path.c_str(),
                noise.c_str(), candidate_count(arms[1].row.problem.scenario()), number_text(arms[0].median()).c_str(),
                number_text(greedy).c_str(), number_text(two).c_str(), number_text(two / greedy).c_str(), number_text(three).c_str(),
                number_text(three / greedy).c_str());
    std::fflush(stdout);
}

}  // namespace
}  // namespace credence::bench

int main(int argc, char** argv) {
    const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
    std::printf("| cell | candidates | fixed, µs/step | greedy | horizon 2 | × greedy | horizon 3 | × greedy |\n");
    std::printf("|---|---|---|---|---|---|---|---|\n");
    for (const char* process : {"translation", "heading"})
        for (const char* path : {"straight", "circle"})
            for (const char* noise : {"constant", "ranged"})
                credence::bench::measure_cell(process, path, noise, rounds);
}
