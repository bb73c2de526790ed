// One unit of the engine. CMake compiles this file once for each instruction set, with CREDENCE_UNIT naming it and
// CREDENCE_LANES saying how many trials run at once. Nothing here may emit a symbol outside that namespace: no
// containers, no library calls.

#include <credence/lane.hpp>
#include <credence/simulate.hpp>
#include <credence/trial.hpp>

namespace credence {
inline namespace CREDENCE_UNIT {

namespace {

/// The trials of one pack: first, first + 1 ...
template <class Real>
Bits<Real> trials_from(std::int64_t first) {
    if constexpr (lanes<Real> == 1) {
        return static_cast<std::uint64_t>(first);
    } else {
        Bits<Real> trials(static_cast<std::uint64_t>(first));
        for (int lane = 0; lane < lanes<Real>; ++lane) trials.v[lane] += static_cast<std::uint64_t>(lane);
        return trials;
    }
}

/// Puts a pack's numbers into its places of the octets.
template <class Real>
void scatter(const Real* from, std::int64_t count, double* to) {
    for (std::int64_t i = 0; i < count; ++i) __builtin_memcpy(to + i * octet, from + i, sizeof(Real));
}

/// Simulates packs of trials; the last one may go beyond the batch, into places of its octet that nobody reads.
template <class Real, Process process, int compiled_features>
void simulate_layout(const ProblemView& problem, const Batch& batch) {
    const std::int64_t cells = static_cast<std::int64_t>(problem.figure_count) * (problem.poses - 1);
    Real* columns = reinterpret_cast<Real*>(batch.scratch);
    Real* figures = columns + column_count;
    for (int i = 0; i < batch.trials; i += lanes<Real>) {
        const KeyedDraws<Real> draws(batch.root_seed, trials_from<Real>(batch.first_trial + i), problem.world.truncate);
        NoObserver nobody;
        run_trial<Layout<process, compiled_features>>(problem, batch.controller, draws, nobody, columns, figures);
        const std::int64_t place = i / octet;
        scatter(columns, column_count, batch.columns + place * column_count * octet + i % octet);
        scatter(figures, cells, batch.figures + place * cells * octet + i % octet);
    }
}

template <Process process>
void simulate_process(const ProblemView& problem, const Batch& batch) {
    // The seed's three features are known to the compiler and run in lanes; any other number runs the same source,
    // rolled and one trial at a time (a pack of 64-feature beliefs would not fit a thread's stack).
    if (problem.features == 3)
        simulate_layout<Pack<CREDENCE_LANES>, process, 3>(problem, batch);
    else
        simulate_layout<double, process, any_count>(problem, batch);
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
