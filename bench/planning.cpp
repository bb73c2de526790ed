// The cost of a step with each controller: the fixed path, the greedy planner, and horizons of two and three steps; and
// of the greedy planner with each of its criteria; on the best target. All are measured in turns in one process, by the
// processor's time; medians, since the clock drifts.
//   credence_bench_planning [ROUNDS]      (default 5)

#include "worlds/deformable/deformable.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <deque>
#include <iterator>
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

/// A cell of the reference study.
struct Cell {
    std::string process, path, noise;

    std::string name() const { return (process == "heading" ? "ekf, " : "kf, ") + path + ", " + noise; }
    DeformableSettings with(const std::vector<std::string>& more) const {
        std::vector<std::string> all{"model.process", process, "features.path", path, "sensor.noise", noise};
        all.insert(all.end(), more.begin(), more.end());
        return scenario_with("cell", all);
    }
};

template <class Arms>
void measure_in_turns(Arms& arms, int rounds) {
    for (Measured& arm : arms) arm.settle();
    for (int round = 0; round < rounds; ++round)
        for (Measured& arm : arms) arm.measure();
}

/// A line: the median of each arm in microseconds a step, those of the horizons over the greedy planner's.
void measure_controllers(const Cell& cell, int rounds) {
    Measured arms[]{{"fixed", cell.with({"arms.controllers", "fixed"})},
                    {"greedy", cell.with({"arms.controllers", "greedy"})},
                    {"horizon 2", cell.with({"arms.controllers", "horizon", "planner.horizon", "2"})},
                    {"horizon 3", cell.with({"arms.controllers", "horizon", "planner.horizon", "3"})}};
    measure_in_turns(arms, rounds);
    const double greedy = arms[1].median(), two = arms[2].median(), three = arms[3].median();
    std::printf("| %s | %d | %s | %s | %s | %s | %s | %s |\n", cell.name().c_str(),
                candidate_count(arms[1].row.problem.scenario()), number_text(arms[0].median()).c_str(),
                number_text(greedy).c_str(), number_text(two).c_str(), number_text(two / greedy).c_str(),
                number_text(three).c_str(), number_text(three / greedy).c_str());
    std::fflush(stdout);
}

/// The trace first: the others are measured against it.
constexpr const char* criteria[]{"trace", "pose_trace", "features_trace", "pose_log_det", "log_det", "max_eigenvalue"};

/// A line: the greedy planner by the trace in microseconds a step, by each other criterion over that.
void measure_criteria(const Cell& cell, int rounds) {
    std::deque<Measured> arms;
    for (const char* criterion : criteria)
        arms.emplace_back(criterion, cell.with({"arms.controllers", "greedy", "planner.criterion", criterion}));
    measure_in_turns(arms, rounds);
    std::printf("| %s | %s", cell.name().c_str(), number_text(arms[0].median()).c_str());
    for (std::size_t i = 1; i < arms.size(); ++i)
        std::printf(" | %s", number_text(arms[i].median() / arms[0].median()).c_str());
    std::printf(" |\n");
    std::fflush(stdout);
}

template <class Measure>
void measure_cells(const Measure& measure, int rounds) {
    for (const char* process : {"translation", "heading"})
        for (const char* path : {"straight", "circle"})
            for (const char* noise : {"constant", "ranged"}) measure({process, path, noise}, rounds);
}

}  // namespace
}  // namespace credence::bench

int main(int argc, char** argv) {
    const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
    std::printf("| cell | candidates | fixed, µs/step | greedy | horizon 2 | × greedy | horizon 3 | × greedy |\n");
    std::printf("|---|---|---|---|---|---|---|---|\n");
    credence::bench::measure_cells(credence::bench::measure_controllers, rounds);
    std::printf("\n| cell | trace, µs/step");
    for (std::size_t i = 1; i < std::size(credence::bench::criteria); ++i)
        std::printf(" | %s, × trace", credence::bench::criteria[i]);
    std::printf(" |\n|---|---|---|---|---|---|---|\n");
    credence::bench::measure_cells(credence::bench::measure_criteria, rounds);
}
