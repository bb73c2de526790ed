#pragma once
// Module numeric: draws. A draw is a pure function of (root seed, trial, pose, source, index, attempt): it does not
// depend on the order of calls, on the thread, or on an arm's measurements and plans. All arms of a trial therefore
// share their noise.
//
// The interface of a noise source, here and in recorded_noise.hpp:
//   Vector2<Real> normal(Source, int pose, int index)   two independent standard-normal draws
//   Real          uniform(Source, int pose, int index)  in [0, 1)

#include <credence/detail/elementary.hpp>
#include <credence/detail/several.hpp>

namespace credence {

/// The purpose of a draw. The numbers are part of the key: never renumber them within a schema version.
enum class Source : std::uint32_t {
    odometry_heading = 0,   ///< first of the pair; on arrival at the pose, at pose 0 the initial heading
    odometry_position = 1,  ///< on arrival at the pose, at pose 0 the initial position
    walk = 2,               ///< by feature, leaving the pose
    deformation = 3,        ///< by feature
    measurement = 4,        ///< by feature; at pose 0 the initial estimate
    edge = 5,               ///< by edge in graph order
    detection = 6,          ///< by feature, uniform
    landmark_prior = 7,     ///< by landmark: the error of its prior estimate
    control = 8,            ///< uniform: which candidate the controller `random` takes
    placement = 9,          ///< uniform, two by feature, at pose 0
    odometry_bias = 10,     ///< at pose 0
    outlier = 11,           ///< by feature, uniform
};

/// The key of a draw, beside the trial. Its index has 16 bits.
struct DrawKey {
    Source source;
    int pose, index;
};

/// The number of sources that a key can distinguish.
constexpr int source_count = 16;

/// The bit of a source's draws among those of a set of sources: they are apart at pose 0, at which trials start.
constexpr std::uint32_t source_bit(Source source, int pose) {
    return std::uint32_t{1} << (static_cast<int>(source) + (pose == 0 ? source_count : 0));
}

/// The largest index of draws that are never truncated.
constexpr int largest_wide_index = (1 << 27) - 1;

/// The index of a key whose draw is never truncated, from one up to largest_wide_index: the attempt of such a draw is
/// 0, so the bits above the sixteenth are stored in the attempt's place. Below 65536 it is the index itself.
constexpr int wide_index(int index) { return (index & 0xffff) | (index >> 16) << 20; }

inline namespace CREDENCE_TARGET {

/// Four 32-bit words, each in the low half of a 64-bit one (one per lane); the high halves are unspecified.
template <class Word>
struct PhiloxBlock {
    Word word[4];
};

/// The round keys of Philox4x32-10, in 64 bits as the lanes are.
struct PhiloxKeys {
    static constexpr int rounds = 10;
    std::uint64_t round[rounds][2];

    PhiloxKeys(std::uint32_t key0, std::uint32_t key1) {
        for (auto& pair : round) {
            pair[0] = key0;
            pair[1] = key1;
            key0 += 0x9E3779B9u;
            key1 += 0xBB67AE85u;
        }
    }
};

/// Philox4x32-10 [Salmon, Moraes, Dror, Shaw: Parallel Random Numbers: As Easy as 1, 2, 3, SC11]: ten rounds of a keyed
/// bijection on a 128-bit counter. Checked bit for bit against the Random123 library in tests/numeric/draws_test.cpp.
template <class Word>
PhiloxBlock<Word> philox(PhiloxBlock<Word> counter, const PhiloxKeys& keys) {
    Word w0 = counter.word[0], w1 = counter.word[1], w2 = counter.word[2], w3 = counter.word[3];
    each(zero, Known<PhiloxKeys::rounds>{}, [&](auto round) CREDENCE_INLINE_LAMBDA {
        const Word product0 = widening_product(w0, 0xD2511F53u), product1 = widening_product(w2, 0xCD9E8D57u);
        w0 = exclusive_or(product1 >> 32, w1, Word(keys.round[round][0]));
        w2 = exclusive_or(product0 >> 32, w3, Word(keys.round[round][1]));
        w1 = product1;
        w3 = product0;
    });
    return {{w0, w1, w2, w3}};
}

/// 52 bits of two words as a number in [1, 2).
template <class Real>
Real in_one_to_two(Bits<Real> high, Bits<Real> low) {
    constexpr std::uint64_t lower_half = 0xffffffff;
    return from_bits((((high << 32) | (low & lower_half)) >> 12) | 0x3ff0000000000000u);
}

/// Box and Muller's transform: the radius from one uniform in (0, 1], the angle from another in [0, 1).
template <class Real>
Vector2<Real> box_muller(const PhiloxBlock<Bits<Real>>& random) {
    const Real u1 = Real(2) - in_one_to_two<Real>(random.word[1], random.word[0]);
    const Real u2 = in_one_to_two<Real>(random.word[3], random.word[2]) - Real(1);
    const Real radius = sqrt(Real(-2) * log_of_normal(u1));
    const Rotation<Real> angle = rotation_of_turns(u2);
    return {radius * angle.cosine, radius * angle.sine};
}

/// Keyed noise of one trial (of each lane's trial).
template <class Real>
class KeyedDraws {
public:
    /// `truncate`: multiple of sigma beyond which a scalar draw is redrawn; infinity for never. `other`: the sources
    /// [source_bit] whose draws are those of an independent world.
    KeyedDraws(std::uint64_t root_seed, Bits<Real> trial, double truncate, std::uint32_t other = 0)
        : keys_(static_cast<std::uint32_t>(root_seed), static_cast<std::uint32_t>(root_seed >> 32)),
          trial_(trial),
          truncates_(truncate < largest_draw),
          truncate_(truncate),
          other_(other) {}

    Vector2<Real> normal(Source source, int pose, int index) const {
        const DrawKey key{source, pose, index};
        Vector2<Real> draw = box_muller<Real>(philox(counter_of(key, 0), keys_));
        if (truncates_) redraw(draw, key);
        return draw;
    }

    /// The same for several draws, whose steps are interleaved. `keys` [count], `draws` [count].
    template <int count>
    void normals(const DrawKey* keys, Vector2<Real>* draws) const {
        using Together = Several<Real, count>;
        const Vector2<Together> together = box_muller<Together>(random_words<count>(keys));
        each(zero, Known<count>{}, [&](auto i) { draws[i] = {together.x.part[i], together.y.part[i]}; });
        if (truncates_)
            for (int i = 0; i < count; ++i) redraw(draws[i], keys[i]);
    }

    Real uniform(Source source, int pose, int index) const {
        const PhiloxBlock<Bits<Real>> random = philox(counter_of({source, pose, index}, 0), keys_);
        return in_one_to_two<Real>(random.word[1], random.word[0]) - Real(1);
    }

private:
    static constexpr std::uint32_t attempts = 4096;
    /// sqrt(-2 log 2^-52) = 8.5: the largest value of the transform.
    static constexpr double largest_draw = 9;

    /// Draws values beyond the truncation again. Not inlined, so that draws without truncation stay short.
    [[gnu::noinline]] void redraw(Vector2<Real>& draw, const DrawKey& key) const {
        // Each component is redrawn by itself; the number of the attempt is part of the key.
        for (std::uint32_t again = 1; again < attempts; ++again) {
            const Mask<Real> redraw_x = absolute(draw.x) > truncate_, redraw_y = absolute(draw.y) > truncate_;
            if (!any(either(redraw_x, redraw_y))) break;
            const Vector2<Real> next = box_muller<Real>(philox(counter_of(key, again), keys_));
            draw = {select(redraw_x, next.x, draw.x), select(redraw_y, next.y, draw.y)};
        }
    }

    /// Counter: trial (64 bits), whether of the other world (1), pose (31), then attempt (12), source (4), index (16).
    PhiloxBlock<Bits<Real>> counter_of(const DrawKey& key, std::uint32_t attempt) const {
        const std::uint64_t what = std::uint64_t{attempt} << 20 |
                                   std::uint64_t{static_cast<std::uint32_t>(key.source)} << 16 |
                                   static_cast<std::uint64_t>(key.index);
        const std::uint64_t world = (other_ & source_bit(key.source, key.pose)) != 0;
        const Bits<Real> none{};
        return {{trial_ & std::uint64_t{0xffffffff}, trial_ >> 32,
                 none + (world << 31 | static_cast<std::uint64_t>(key.pose)), none + what}};
    }

    /// The words of several draws, as many at a time as fit into registers: 32 for Reals of 64 bytes, otherwise 16.
    template <int count>
    CREDENCE_INLINE PhiloxBlock<Several<Bits<Real>, count>> random_words(const DrawKey* keys) const {
        constexpr int held = sizeof(Real) == 64 ? 6 : 3;
        PhiloxBlock<Several<Bits<Real>, count>> random;
        if constexpr (count > held) {
            const auto first = random_words<held>(keys);
            const auto rest = random_words<count - held>(keys + held);
            each(zero, Known<4>{}, [&](auto word) {
                each(zero, Known<held>{}, [&](auto i) { random.word[word].part[i] = first.word[word].part[i]; });
                each(Known<held>{}, Known<count>{},
                     [&](auto i) { random.word[word].part[i] = rest.word[word].part[i - held]; });
            });
            return random;
        } else {
            each(zero, Known<count>{}, [&](auto i) {
                const PhiloxBlock<Bits<Real>> own = counter_of(keys[i], 0);
                each(zero, Known<4>{}, [&](auto word) { random.word[word].part[i] = own.word[word]; });
            });
            return philox(random, keys_);
        }
    }

    PhiloxKeys keys_;
    Bits<Real> trial_;
    bool truncates_;
    Real truncate_;
    std::uint32_t other_;
};

/// A number of draws, from any source of noise. `keys` [count], `draws` [count].
template <int count, class Noise, class Real>
void draw_several(const Noise& noise, const DrawKey* keys, Vector2<Real>* draws) {
    for (int i = 0; i < count; ++i) draws[i] = noise.normal(keys[i].source, keys[i].pose, keys[i].index);
}

/// Keyed draws, interleaved; one copy of the code for all callers.
template <int count, class Real>
[[gnu::noinline]] CREDENCE_FLAT void draw_several(const KeyedDraws<Real>& noise, const DrawKey* keys,
                                                  Vector2<Real>* draws) {
    noise.template normals<count>(keys, draws);
}

/// Draws of all keys, six at a time: fewer do not fill the processor's pipelines, more do not fit its reorder buffer.
/// Of a last group that lacks one, the first is drawn twice: code of its own for five would take the room of other code
/// in the processor's cache of decoded operations. `keys` [count], `draws` [count].
template <class Noise, class Count, class Real>
void draw_all(const Noise& noise, const DrawKey* keys, Count count, Vector2<Real>* draws) {
    constexpr int most = 6;
    int i = 0;
    const auto in_groups = [&](auto group) CREDENCE_INLINE_LAMBDA {
        for (; i + group <= count; i += group) draw_several<group>(noise, keys + i, draws + i);
    };
    in_groups(Known<most>{});
    if constexpr (std::is_same_v<Count, int>) {
        in_groups(Known<most / 2>{});
        in_groups(one);
    } else if constexpr (count > most && count % most == most - 1) {
        DrawKey filled[most];
        Vector2<Real> drawn[most];
        for (int j = 0; j < most; ++j) filled[j] = keys[i + j % (most - 1)];
        draw_several<most>(noise, filled, drawn);
        for (int j = 0; j < most - 1; ++j) draws[i + j] = drawn[j];
    } else if constexpr (count % most != 0) {
        in_groups(Known<count % most>{});
    }
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
