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

/// Adds a pack's figures [figure_count, K - 1] to the running sums, from a pack's first place in their octets on.
/// Trials that do not count add zeros.
template <class Real>
void fold(const Real* figures, Mask<Real> counts, const ProblemView& problem, const Batch& batch, int place) {
    const int steps = problem.poses - 1;
    for (int f = 0; f < problem.figure_count; ++f) {
        Real run_sum = Real(0);
        for (int cell = f * steps; cell < (f + 1) * steps; ++cell) {
            const Real value = select(counts, figures[cell], Real(0));
            double *sum = batch.sums + cell * octet + place, *square_sum = batch.square_sums + cell * octet + place;
            store(load<Real>(sum) + value, sum);
            store(fma(value, value, load<Real>(square_sum)), square_sum);
            run_sum = run_sum + value;
        }
        double* run_square_sum = batch.run_square_sums + f * octet + place;
        store(fma(run_sum, run_sum, load<Real>(run_square_sum)), run_square_sum);
    }
}

/// The lanes 0 ... count - 1.
template <class Real>
Mask<Real> first_lanes(int count) {
    if constexpr (lanes<Real> == 1) {
        return count > 0;
    } else {
        Real number;
        for (int lane = 0; lane < lanes<Real>; ++lane) number.v[lane] = lane;
        return number < Real(count);
    }
}

/// Simulates packs of trials; the last one may go beyond the batch, into places of its octet that nobody reads.
template <class Real, Process process, int compiled_features>
struct Simulation {
    using Layout = credence::Layout<process, compiled_features>;

    static std::size_t workspace_size(const ProblemView& problem) {
        const int cells = problem.figure_count * (problem.poses - 1);
        return sizeof(Workspace<Layout, Real>) + static_cast<std::size_t>(cells) * sizeof(Real);
    }

    static void simulate(const ProblemView& problem, const Batch& batch) {
        auto& work = *static_cast<Workspace<Layout, Real>*>(batch.workspace);
        Real* figures = reinterpret_cast<Real*>(&work + 1);
        for (int i = 0; i < batch.trials; i += lanes<Real>) {
            const KeyedDraws<Real> draws(batch.root_seed, trials_from<Real>(batch.first_trial + i),
                                         problem.world.truncate);
            NoObserver nobody;
            Real columns[column_count];
            run_trial(problem, batch.controller, draws, nobody, work, columns, figures);
            double* to = batch.columns + i / octet * column_count * octet + i % octet;
            for (int c = 0; c < column_count; ++c) store(columns[c], to + c * octet);
            const Real first_failure = Real(static_cast<int>(Status::covariance_not_positive_definite));
            fold(figures, both(columns[column_status] < first_failure, first_lanes<Real>(batch.trials - i)), problem,
                 batch, i % octet);
        }
    }
};

/// Calls use(Simulation) with the one that fits: a few features are written out by the compiler, more run the same
/// source, rolled. Same bits either way.
template <Process process, class Use>
auto with_process(const ProblemView& problem, const Use& use) {
    using Real = Pack<CREDENCE_LANES>;
    switch (problem.features) {
#if CREDENCE_WRITTEN_OUT > 3
        case 1: return use(Simulation<Real, process, 1>{});
        case 2: return use(Simulation<Real, process, 2>{});
        case 4: return use(Simulation<Real, process, 4>{});
#endif
#if CREDENCE_WRITTEN_OUT > 4
        case 5: return use(Simulation<Real, process, 5>{});
        case 6: return use(Simulation<Real, process, 6>{});
#endif
        case 3: return use(Simulation<Real, process, 3>{});
        default: return use(Simulation<Real, process, any_count>{});
    }
}

template <class Use>
auto with_simulation(const ProblemView& problem, const Use& use) {
    if (problem.process == Process::heading) return with_process<Process::heading>(problem, use);
    return with_process<Process::translation>(problem, use);
}

}  // namespace

void simulate(const ProblemView& problem, const Batch& batch) {
    with_simulation(problem, [&](auto simulation) { simulation.simulate(problem, batch); });
}

std::size_t workspace_size(const ProblemView& problem) {
    return with_simulation(problem, [&](auto simulation) { return simulation.workspace_size(problem); });
}

}  // namespace CREDENCE_UNIT
}  // namespace credence
