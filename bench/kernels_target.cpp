// One instruction set's kernels. As in the engine's targets, no symbol may be emitted outside the namespace.

#include <credence/detail/lane.hpp>
#include "slam/trial/trial.hpp"

#include "kernels.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

namespace {

using Real = Pack<CREDENCE_LANES>;

double first_lane(const Real& pack) {
    double first;
    __builtin_memcpy(&first, &pack, sizeof first);
    return first;
}

double normals(std::int64_t rounds) {
    const KeyedDraws<Real> draws(1, Bits<Real>{}, std::numeric_limits<double>::infinity());
    Real sum = Real(0);
    constexpr int together = 6;  // as the trials draw them
    Vector2<Real> drawn[together];
    for (std::int64_t i = 0; i < rounds; i += together) {
        DrawKey keys[together];
        for (int j = 0; j < together; ++j) keys[j] = {Source::walk, static_cast<int>(i), j};
        draw_all(draws, keys, Known<together>{}, drawn);
        for (const Vector2<Real>& draw : drawn) sum = sum + (draw.x + draw.y);
    }
    return first_lane(sum);
}

double filter_steps(const ProblemView& problem, std::int64_t steps) {
    using Layout = credence::Layout<Process::heading, 3>;
    constexpr int room = 64;  // for the series of one step
    const Layout layout(problem.features);
    const KeyedDraws<Real> draws(1, Bits<Real>{}, std::numeric_limits<double>::infinity());
    Workspace<Layout, Real> work;
    Sums<Real> sums;
    Outcome<Real> outcome;
    Real series[room];
    WorldDraws<Layout, Real> drawn(layout);
    const Vector2<Real>* measurement = drawn.template of_features<Source::measurement>();
    drawn.draw(draws, 0);
    start_truth(work.truth, problem.world, layout, drawn, draws);
    look_first(work.truth, problem.sensor, layout.features(), measurement, work.sightings);
    start_belief(work.belief, problem.filter, layout, work.sightings);
    drawn.draw(draws, 1);
    look(work.truth, problem.sensor, layout, 1, measurement, draws, work.sightings);
    const auto edge_measurement = [&](int e) {
        return measure_edge(work.truth, problem.sensor, problem.filter.edges[e], 1, e, draws);
    };
    for (std::int64_t step = 0; step < steps; ++step) {
        predict_robot(work.belief, problem.filter, layout, Command<Real>{});
        predict_features(work.belief, problem.filter, layout, 1);
        update_belief(work.belief, problem.filter, layout, work.sightings, edge_measurement,
                      AtMean<Layout, Real>(work.belief.mean), work.update);
        evaluate_step(problem, layout, work.belief, work.truth, work.update, 1, work.elimination, sums, outcome,
                      series);
    }
    return first_lane(sums.nees + sums.nis);
}

/// More than latency times units of any processor at hand, and few enough for the registers.
constexpr int chains = 12;

#if defined(__x86_64__)
#define CREDENCE_REGISTER "+v"
#elif defined(__aarch64__)
#define CREDENCE_REGISTER "+w"
#else
#define CREDENCE_REGISTER "+m"
#endif

/// Keeps a number in its register and hides its value from the compiler: equal chains could be computed once.
template <class Number>
void forget(Number& x) {
    if constexpr (lanes<Number> == 1)
        asm volatile("" : CREDENCE_REGISTER(x));
    else
        asm volatile("" : CREDENCE_REGISTER(x.v));
}

double multiply_adds(std::int64_t rounds) {
    Real a(0), b(1), c(2), d(3), e(4), f(5), g(6), h(7), i(8), j(9), k(10), l(11), factor(0.999), term(0.001);
    forget(factor);
    forget(term);
    const auto step = [&](auto&... x) CREDENCE_INLINE_LAMBDA { ((x = fma(x, factor, term), forget(x)), ...); };
    for (std::int64_t round = 0; round < rounds; ++round) step(a, b, c, d, e, f, g, h, i, j, k, l);
    return first_lane(a + b + c + d + e + f + g + h + i + j + k + l);
}

}  // namespace

#if defined(__FMA__) || defined(__aarch64__)
constexpr bool hardware_fma = true;
#else
constexpr bool hardware_fma = false;
#endif

#define CREDENCE_TEXT_OF(x) #x
#define CREDENCE_TEXT(x) CREDENCE_TEXT_OF(x)

extern const bench::Kernels kernels;
const bench::Kernels kernels{CREDENCE_TEXT(CREDENCE_TARGET) + sizeof "bench",
                             CREDENCE_LANES,
                             chains,
                             hardware_fma,
                             normals,
                             filter_steps,
                             multiply_adds};

}  // namespace CREDENCE_TARGET
}  // namespace credence
