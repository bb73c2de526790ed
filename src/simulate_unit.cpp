// One unit of the engine: trials on plain doubles. CMake compiles this file once for each instruction set, with
// CREDENCE_UNIT naming it. Nothing here may emit a symbol outside that namespace: no containers, no library calls.

#include <credence/simulate.hpp>
#include <credence/trial.hpp>

namespace credence {
inline namespace CREDENCE_UNIT {

namespace {

/// Puts one trial's numbers into its place of the octets.
void scatter(const double* from, int count, double* to) {
    for (int i = 0; i < count; ++i) to[i * octet] = from[i];
}

template <Process process, int compiled_features>
void simulate_layout(const ProblemView& problem, const Batch& batch) {
    const int cells = problem.figure_count * (problem.poses - 1);
    for (int i = 0; i < batch.trials; ++i) {
        const KeyedDraws<double> draws(batch.root_seed, static_cast<std::uint64_t>(batch.first_trial + i),
                                       problem.world.truncate);
        NoObserver nobody;
        double* columns = batch.scratch;
        double* figures = columns + column_count;
        run_trial<Layout<process, compiled_features>>(problem, batch.controller, draws, nobody, columns, figures);
        const std::int64_t place = i / octet;
        scatter(columns, column_count, batch.columns + place * column_count * octet + i % octet);
        scatter(figures, cells, batch.figures + place * cells * octet + i % octet);
    }
}

template <Process process>
void simulate_process(const ProblemView& problem, const Batch& batch) {
    // The seed's three features are known to the compiler; any other number runs the same source, rolled.
    if (problem.features == 3)
        simulate_layout<process, 3>(problem, batch);
    else
        simulate_layout<process, any_count>(problem, batch);
}

}  // namespace

void simulate(const ProblemView& problem, const Batch& batch) {
    if (problem.process == Process::heading)
        simulate_process<Process::heading>(problem, batch);
    else
        simulate_process<Process::translation>(problem, batch);
}

}  // namespace CREDENCE_UNIT
}  // namespace credence
