#pragma once
// A batch of trials, pack by pack of lanes, and the folding of their series into running sums; whatever the
// world.

#include <credence/detail/batch.hpp>
#include <credence/detail/draws.hpp>
#include "engine/pack_details.hpp"
#include <credence/detail/lane.hpp>

namespace credence {
inline namespace CREDENCE_TARGET {

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

/// Octets whose series are kept before they are folded, at most: the running sums then come from far away only so
/// often.
inline constexpr int fold_octets = 4;

/// As many as stay near, and one for long trials.
inline int octets_kept(const CommonView& problem) {
    constexpr int near = 1 << 16;  // numbers: half a megabyte
    const int kept = near / octet / problem.series_count / (problem.poses - 1);
    return kept < 1 ? 1 : kept > fold_octets ? fold_octets : kept;
}

/// The series [packs, series_count, K - 1] of up to fold_octets octets of trials, and which of them count.
template <class Real>
struct Unfolded {
    static constexpr int packs_per_octet = octet / lanes<Real>;
    Real* all_series = nullptr;
    std::int64_t cells = 0;
    int capacity = 0, packs = 0;
    Mask<Real> counts[fold_octets * packs_per_octet] = {};

    Unfolded(Real* room, const CommonView& problem)
        : all_series(room),
          cells(std::int64_t{problem.series_count} * (problem.poses - 1)),
          capacity(octets_kept(problem) * packs_per_octet) {}

    Real* next() { return all_series + packs * cells; }
    void keep(Mask<Real> counted) { counts[packs++] = counted; }
    bool full() const { return packs == capacity; }
    /// Octets of which pack number `start` is there: the last one may end before it.
    int octets(int start) const { return (packs - start + packs_per_octet - 1) / packs_per_octet; }
};

/// Adds one series's values, those of the packs start, start + stride ... of `octets` octets, to its running sums.
template <class Real, class Octets>
void fold_series(const Unfolded<Real>& unfolded, int f, int start, Octets octets, int steps, const RunningSums& batch) {
    constexpr int stride = Unfolded<Real>::packs_per_octet;
    const int place = start * lanes<Real>;
    Real run_sum[fold_octets];
    each(zero, octets, [&](auto i) CREDENCE_INLINE_LAMBDA { run_sum[i] = Real(0); });
    for (int cell = f * steps; cell < (f + 1) * steps; ++cell) {
        double *to = batch.sums + cell * octet + place, *to_square = batch.square_sums + cell * octet + place;
        Real sum = load<Real>(to), square_sum = load<Real>(to_square);
        each(zero, octets, [&](auto i) CREDENCE_INLINE_LAMBDA {
            const int pack = start + i * stride;
            const Real value =
                select(unfolded.counts[pack], unfolded.all_series[pack * unfolded.cells + cell], Real(0));
            sum = sum + value;
            square_sum = fma(value, value, square_sum);
            run_sum[i] = run_sum[i] + value;
        });
        store(sum, to);
        store(square_sum, to_square);
    }
    double* to = batch.run_square_sums + f * octet + place;
    Real run_square_sum = load<Real>(to);
    each(zero, octets, [&](auto i) CREDENCE_INLINE_LAMBDA {
        run_square_sum = fma(run_sum[i], run_sum[i], run_square_sum);
    });
    store(run_square_sum, to);
}

/// The coverage bound of each lane's dimension. `bounds` [dimension, coverage_level_count].
template <class Real>
Real bound_by_dimension(const double* bounds, const Real& dimension, int level) {
    Real bound(0);
    for (int lane = 0; lane < lanes<Real>; ++lane)
        set_lane(bound, lane, bounds[static_cast<int>(lane_of(dimension, lane)) * coverage_level_count + level]);
    return bound;
}

/// Counts the trials whose NEES of block b lies below each coverage bound.
template <class Real>
void fold_coverage(const Unfolded<Real>& unfolded, int b, const CommonView& problem, const RunningSums& batch) {
    const int steps = problem.poses - 1;
    const Growth& growth = problem.growth;
    const bool grows = growth.series >= 0 && (b == 0 || b == growth.features);
    const double* bounds = problem.coverage_bounds + b * coverage_level_count;
    if (grows)
        bounds = growth.bounds + (b == 0 ? 0 : (problem.state_size + 1 - growth.pose_size) * coverage_level_count);
    for (int cell = b * steps; cell < (b + 1) * steps; ++cell) {
        int count[coverage_level_count] = {};
        for (int pack = 0; pack < unfolded.packs; ++pack) {
            const Real* all_series = unfolded.all_series + pack * unfolded.cells;
            for (int level = 0; level < coverage_level_count; ++level) {
                const Real bound =
                    grows ? bound_by_dimension(bounds, all_series[(growth.series - b) * steps + cell], level)
                          : Real(bounds[level]);
                count[level] += lane_count(both(unfolded.counts[pack], all_series[cell] < bound));
            }
        }
        std::int32_t* to = batch.covered + cell * coverage_level_count;
        for (int level = 0; level < coverage_level_count; ++level) to[level] += count[level];
    }
}

/// Adds what is unfolded to the running sums, in trial order. Trials that do not count add zeros.
template <class Real>
void fold(Unfolded<Real>& unfolded, const CommonView& problem, const RunningSums& batch) {
    const int steps = problem.poses - 1;
    for (int start = 0; start < Unfolded<Real>::packs_per_octet; ++start)
        for (int f = 0; f < problem.series_count; ++f)
            if (const int octets = unfolded.octets(start); octets == fold_octets)
                fold_series(unfolded, f, start, Known<fold_octets>{}, steps, batch);
            else
                fold_series(unfolded, f, start, octets, steps, batch);
    for (int b = 0; b < problem.group_count; ++b)
        fold_coverage(unfolded, b, problem, batch);
    unfolded.packs = 0;
}

/// Adds the diverged trials of the pack from trial `first` of the batch on to running sums of their own. The packs of
/// its octet before it lie before it, too.
template <class Real>
[[gnu::cold, gnu::noinline]] void fold_diverged(Real* all_series, Mask<Real> diverged, int first,
                                                const CommonView& problem, const Batch& batch) {
    Unfolded<Real> of_octet(all_series, problem);
    for (int before = first % octet / lanes<Real>; before > 0; --before) {
        of_octet.all_series -= of_octet.cells;
        of_octet.keep(Mask<Real>{});
    }
    of_octet.keep(diverged);
    fold(of_octet, problem, batch.of_diverged(batch.owner));
}

/// Replaces the NEES of the whole state by NaN at the steps of a pack at which a part of it is absent.
template <class Real>
void forget_parts(const Real* all_series, const CommonView& problem, int trial, const Batch& batch) {
    const int steps = problem.poses - 1, padded = (batch.trials + octet - 1) / octet * octet;
    for (int k = 0; k < steps; ++k) {
        const Mask<Real> whole = all_series[problem.growth.series * steps + k] == Real(problem.state_size);
        store(select(whole, all_series[k], Real(__builtin_nan(""))), batch.nees + k * padded + trial);
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

/// Which trials a pack has: those from `first` on, in the lanes of `there`.
template <class Real>
struct PackPlace {
    std::int64_t first = 0;
    Mask<Real> there{};
};

/// Simulates packs of trials; the last one may go beyond the batch, into places of its octet that are never read.
///
/// `Trial` is a world's: the types View (a CommonView) and Real; `truncate(View)`; the numbers of its columns, of which
/// the last two are those of its status, and of an innovation's rows, `column_count(View)` and `whitened_rows(View)`;
/// `room(View)`, the bytes that a pack needs beside these; and `run(view, draws, place, room, details, columns,
/// series)`, one pack of trials of one arm.
template <class Trial>
struct BatchOf {
    using View = typename Trial::View;
    using Real = typename Trial::Real;

    static std::size_t workspace_size(const View& problem) {
        const Unfolded<Real> unfolded(nullptr, problem);
        const int columns = Trial::column_count(problem) + problem.error_columns();
        return Trial::room(problem) + (static_cast<std::size_t>(columns) +
                                       PackDetails<Real>::room(problem, Trial::whitened_rows(problem)) +
                                       static_cast<std::size_t>(unfolded.cells * unfolded.capacity)) * sizeof(Real);
    }

    static void simulate(const View& problem, const Trial& trial, const Batch& batch) {
        const int rows = Trial::whitened_rows(problem), own = Trial::column_count(problem),
                  count = own + problem.error_columns();
        Real* columns = reinterpret_cast<Real*>(static_cast<std::byte*>(batch.workspace) + Trial::room(problem));
        Real* room = columns + count;
        PackDetails<Real> details(problem, rows, batch, room);
        Unfolded<Real> unfolded(room + PackDetails<Real>::room(problem, rows), problem);
        for (int i = 0; i < batch.trials; i += lanes<Real>) {
            const PackPlace<Real> place{batch.first_trial + i, first_lanes<Real>(batch.trials - i)};
            const KeyedDraws<Real> draws(batch.root_seed, trials_from<Real>(place.first), Trial::truncate(problem),
                                         problem.other);
            Real* all_series = unfolded.next();
            details.start();
            trial.run(problem, draws, place, batch.workspace, details, columns, all_series);
            details.write_columns(own, columns);
            const Mask<Real> counts = both(columns[count - 2] == Real(0), place.there);
            double* to = batch.columns + i / octet * count * octet + i % octet;
            for (int c = 0; c < count; ++c) store(columns[c], to + c * octet);
            copy_out(all_series, problem.poses - 1, i, batch, batch.nees);
            if (problem.growth.series >= 0) forget_parts(all_series, problem, i, batch);
            details.keep(all_series, counts, i, batch);
            if (const Mask<Real> diverged = both(columns[count - 2] == Real(1), place.there); any(diverged))
                fold_diverged(all_series, diverged, i, problem, batch);
            unfolded.keep(counts);
            if (unfolded.full() || i + lanes<Real> >= batch.trials) fold(unfolded, problem, batch);
        }
    }
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
