#pragma once
// The planner of the translation model where the noise is constant. A candidate's cost depends only on which features
// it sees: of the candidates that see the same set the last one wins, and the cost of each set is computed once.

#include "slam/planning/eigenvalue.hpp"
#include "slam/planning/measurement_space.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// Up to this many features, costs are tabulated by set of features.
inline constexpr int largest_tabled_count = 6;

/// The features that each candidate sees. Lanes are bits of a byte, lane 0 lowest; the bytes of eight candidates form a
/// 64-bit word.
template <class Real>
struct VisibleSets {
    static constexpr int capacity = 1 << largest_tabled_count;
    static constexpr int chunk = 128;  ///< number of candidates that are kept at a time
    static_assert(lanes<Real> <= 8);
    unsigned char seeing[largest_tabled_count][chunk];  ///< lanes that see feature j, by candidate of the chunk
    unsigned offered[capacity];                         ///< lanes in which some candidate sees the set
    Real cost[capacity];
};

/// Candidates first ... last - 1.
struct CandidateChunk {
    int first, last;

    int words() const { return (last - first + 7) / 8; }
};

template <class Real>
CandidateChunk chunk_from(int first, const ControlParameters& control) {
    const int after = first + VisibleSets<Real>::chunk;
    return {first, after < control.candidate_count ? after : control.candidate_count};
}

/// Determines what every candidate of a chunk sees.
template <class Layout, class Real, int capacity>
CREDENCE_FLAT void look_from(const CandidateChunk& chunk, const Belief<Real, capacity>& still,
                             const ControlParameters& control, const SensorParameters& sensor, const Layout& layout,
                             VisibleSets<Real>& sets) {
    // Local copies: the compiler knows that no byte written here changes them.
    const Vector2<Real> position = point_at(still.mean, Layout::position);
    const SensorParameters eye = sensor;
    Vector2<Real> feature[largest_tabled_count];
    each(zero, layout.features(), [&](auto j) { feature[j] = point_at(still.mean, Layout::feature(j)); });
    for (int i = chunk.first; i < chunk.last; ++i) {
        const Vector2<Real> there = position + broadcast<Real>(control.candidates[i].move);
        each(zero, layout.features(), [&](auto j) {
            const Mask<Real> seen = in_range(eye, squared_range(there, feature[j]));
            sets.seeing[j][i - chunk.first] = static_cast<unsigned char>(lane_bits(seen));
        });
    }
    // The last candidate fills the rest of the last word: repeating it does not change the result.
    for (int i = chunk.last - chunk.first; i < 8 * chunk.words(); ++i)
        each(zero, layout.features(), [&](auto j) { sets.seeing[j][i] = sets.seeing[j][i - 1]; });
}

/// The bitwise or of a word's bytes; and a word with the same byte for each of its candidates.
inline unsigned any_of_word(std::uint64_t word) {
    for (int half = 32; half >= 8; half /= 2) word |= word >> half;
    return word & 0xff;
}
inline std::uint64_t all_of_word(unsigned byte) { return byte * std::uint64_t{0x0101010101010101}; }

/// For each set, the lanes in which a candidate of a word sees exactly this set: that_see [2^M]. Feature j is bit j of
/// a set.
template <class Layout, class Real>
CREDENCE_INLINE void tell_apart(int word, const Layout& layout, const VisibleSets<Real>& sets,
                                std::uint64_t* that_see) {
    that_see[0] = all_of_word(lane_bits(all_lanes<Real>()));
    each(zero, layout.features(), [&](auto j) CREDENCE_INLINE_LAMBDA {
        std::uint64_t seeing;
        __builtin_memcpy(&seeing, sets.seeing[j] + 8 * word, sizeof seeing);
        const int with = 1 << j;
        for (int set = 0; set < with; ++set) {
            that_see[set + with] = that_see[set] & seeing;
            that_see[set] &= ~seeing;
        }
    });
}

/// Finds the sets that candidates see. The visibilities of the last chunk stay in `sets`.
template <class Layout, class Real, int capacity>
CREDENCE_FLAT void gather_sets(const Belief<Real, capacity>& still, const ControlParameters& control,
                               const SensorParameters& sensor, const Layout& layout, VisibleSets<Real>& sets) {
    const int set_count = 1 << layout.features();
    std::uint64_t that_see[VisibleSets<Real>::capacity], offered[VisibleSets<Real>::capacity];
    for (int set = 0; set < set_count; ++set) offered[set] = 0;
    for (int first = 0; first < control.candidate_count; first += VisibleSets<Real>::chunk) {
        const CandidateChunk chunk = chunk_from<Real>(first, control);
        look_from(chunk, still, control, sensor, layout, sets);
        for (int word = 0; word < chunk.words(); ++word) {
            tell_apart(word, layout, sets, that_see);
            for (int set = 0; set < set_count; ++set) offered[set] |= that_see[set];
        }
    }
    for (int set = 0; set < set_count; ++set) sets.offered[set] = any_of_word(offered[set]);
}

/// trace(W P+) of every set.
template <class Layout, class Real>
CREDENCE_INLINE void price_sets(const MeasurementSpace<Layout, Real>& space, const FilterParameters& filter,
                                const SensorParameters& sensor, const Layout& layout,
                                MeasurementElimination<Layout, Real>& work, VisibleSets<Real>& sets) {
    const Real N = believed_variance(filter, Real(sensor.sigma));
    near_at_hand(layout, work, [&](auto& near) CREDENCE_INLINE_LAMBDA {
        for (int set = 0; set < 1 << layout.features(); ++set) {
            each(zero, layout.features(), [&](auto j) CREDENCE_INLINE_LAMBDA {
                near.seen[j] = all_lanes<Real>();
                each(j, layout.features(), [&](auto l) CREDENCE_INLINE_LAMBDA {
                    near.S[j][l] = space.A[j][l], near.C[j][l] = space.G[j][l];
                });
                near.S[j][j] = add_noise(near.S[j][j], N);
            });
            Real cost = space.prior.constant;
            each(zero, layout.features(), [&](auto j) CREDENCE_INLINE_LAMBDA {
                if (set >> j & 1) cost = cost - take_out(layout, j, near);
            });
            sets.cost[set] = cost;
        }
    });
}

/// The cost of every set that some candidate sees and that has, of the features before j, those of `set`: by the direct
/// form, whose P is conditioned on one feature after the other, once for all sets that begin alike.
template <class Index, class Layout, class Real, int capacity>
void price_sets_directly(Index j, int set, Symmetric<Real, capacity>& P, const Belief<Real, capacity>& still,
                        const ControlParameters& control, const FilterParameters& filter,
                        const SensorParameters& sensor, const Layout& layout, VisibleSets<Real>& sets) {
    constexpr bool at_end = Layout::written_out && std::is_same_v<Index, decltype(layout.features())>;
    unsigned wanted = 0;
    for (int other = set; other < 1 << layout.features(); other += 1 << j) wanted |= sets.offered[other];
    if (wanted == 0) return;
    if (at_end || j == layout.features()) {
        Symmetric<Real, capacity> room;
        Real x[capacity];
        sets.cost[set] = control.criterion == Criterion::max_eigenvalue
                             ? largest_eigenvalue_below(above_eigenvalues(P, layout, control.weights),
                                                        all_lanes<Real>(), P, control.weights, layout, room, x)
                             : cost_of(P, control, layout);
    } else if constexpr (!at_end) {
        price_sets_directly(j + one, set, P, still, control, filter, sensor, layout, sets);
        Symmetric<Real, capacity> seen;
        copy(P, layout.size(), seen);
        condition(seen, layout, sighting_rows<Layout>(still.mean, j), believed_variance(filter, Real(sensor.sigma)),
                  all_lanes<Real>());
        price_sets_directly(j + one, set + (1 << j), seen, still, control, filter, sensor, layout, sets);
    }
}

/// The lanes in which some candidate sees the set.
template <class Real>
Mask<Real> offered(int set, const VisibleSets<Real>& sets) { return mask_of_bits<Real>(sets.offered[set]); }

/// The least cost of the sets that some candidate sees; infinity where there are none.
template <class Real>
Real least_cost(int set_count, const VisibleSets<Real>& sets) {
    Real least = without_limit<Real>();
    for (int set = 0; set < set_count; ++set)
        least = select(both(offered(set, sets), sets.cost[set] < least), sets.cost[set], least);
    return least;
}

/// Of a chunk's candidates that see a good set, the last becomes the winner in each of the `undecided` lanes. Returns
/// the lanes that have a winner. good [2^M]: for each set the lanes in which it is good, for all of a word's
/// candidates.
template <class Layout, class Real>
CREDENCE_FLAT unsigned take_last(const CandidateChunk& chunk, const std::uint64_t* good, unsigned undecided,
                                 const Layout& layout, const VisibleSets<Real>& sets, Real& winner) {
    std::uint64_t that_see[VisibleSets<Real>::capacity], decided = 0;
    unsigned char wins[VisibleSets<Real>::chunk];
    for (int word = 0; word < chunk.words(); ++word) {
        tell_apart(word, layout, sets, that_see);
        std::uint64_t win = 0;
        for (int set = 0; set < 1 << layout.features(); ++set) win |= that_see[set] & good[set];
        win &= all_of_word(undecided);
        decided |= win;
        __builtin_memcpy(wins + 8 * word, &win, sizeof win);
    }
    for (int i = chunk.first; i < chunk.last; ++i)
        winner = select(mask_of_bits<Real>(wins[i - chunk.first]), Real(i), winner);
    return any_of_word(decided);
}

/// The number of the candidate that wins in each lane, -1 where there is none: among the sets that some candidate sees,
/// those that cost at most `equal` are good, and the last candidate that sees a good set wins. `sets` holds the
/// visibilities of the last chunk.
template <class Layout, class Real, int capacity>
Real last_of_best(Real equal, const Belief<Real, capacity>& still, const ControlParameters& control,
                  const SensorParameters& sensor, const Layout& layout, VisibleSets<Real>& sets) {
    std::uint64_t good[VisibleSets<Real>::capacity];
    unsigned undecided = 0;
    for (int set = 0; set < 1 << layout.features(); ++set) {
        const unsigned here = lane_bits(both(offered(set, sets), sets.cost[set] <= equal));
        good[set] = all_of_word(here);
        undecided |= here;
    }
    constexpr int chunk_size = VisibleSets<Real>::chunk;
    const int last_first = (control.candidate_count - 1) / chunk_size * chunk_size;
    Real winner = Real(-1);
    for (int first = last_first; undecided != 0 && first >= 0; first -= chunk_size) {
        const CandidateChunk chunk = chunk_from<Real>(first, control);
        if (first != last_first) look_from(chunk, still, control, sensor, layout, sets);
        undecided &= ~take_last(chunk, good, undecided, layout, sets, winner);
    }
    return winner;
}

/// The choice among the sets, given their costs.
template <class Layout, class Real, int capacity>
CREDENCE_FLAT Choice<Real> choose_among_sets(const Belief<Real, capacity>& still, const ControlParameters& control,
                                             const SensorParameters& sensor, const Layout& layout,
                                             VisibleSets<Real>& sets) {
    Choice<Real> choice = no_choice<Real>(control);
    choice.best = least_cost(1 << layout.features(), sets);
    choice.command = fetch_each(control, last_of_best(choice.equal_cost(), still, control, sensor, layout, sets));
    return choice;
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
