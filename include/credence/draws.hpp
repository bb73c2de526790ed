#pragma once
// Room 2: draws. A draw is a pure function of (root seed, trial, pose, source, index, attempt): never of the order of
// calls, of the thread, or of what an arm saw or planned. All arms of a trial therefore share their noise.
//
// The face of a noise source, here and in recorded_noise.hpp:
//   Vector2<Real> normal(Source, int pose, int index)   two independent standard-normal draws
//   Real          uniform(Source, int pose, int index)  in [0, 1)

#include <credence/each.hpp>
#include <credence/elementary.hpp>

namespace credence {

/// What a draw is for. The numbers are part of the key: never renumber them within a schema version.
enum class Source : std::uint32_t {
    odometry_heading = 0,   ///< first of the pair; on arrival at the pose, at pose 0 the initial heading
    odometry_position = 1,  ///< on arrival at the pose, at pose 0 the initial position
    walk = 2,               ///< by feature, leaving the pose
    deformation = 3,        ///< by feature
    measurement = 4,        ///< by feature; at pose 0 the initial estimate
    edge = 5,               ///< by edge in graph order
    detection = 6,          ///< by feature, uniform
};

inline namespace CREDENCE_UNIT {

/// Four 32-bit words, each in the low half of a 64-bit one (one per lane).
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

/// Philox4x32-10 [Salmon, Moraes, Dror, Shaw: Parallel Random Numbers: As Easy as 1, 2, 3, SC11]: ten rounds of a
/// keyed bijection on a 128-bit counter. Checked bit for bit against the Random123 library in tests/draws.
template <class Word>
PhiloxBlock<Word> philox(PhiloxBlock<Word> counter, const PhiloxKeys& keys) {
    // What the rounds leave in the upper halves is never read: products take the lower ones.
    for (const auto& [key0, key1] : keys.round) {
        const Word product0 = widening_product(counter.word[0], 0xD2511F53u);
        const Word product1 = widening_product(counter.word[2], 0xCD9E8D57u);
        counter = {{exclusive_or(product1 >> 32, counter.word[1], Word(key0)), product1,
                    exclusive_or(product0 >> 32, counter.word[3], Word(key1)), product0}};
    }
    for (Word& word : counter.word) word = word & std::uint64_t{0xffffffff};
    return counter;
}

/// 52 bits as a number in [1, 2).
template <class Real>
Real in_one_to_two(Bits<Real> high, Bits<Real> low) {
    return from_bits((((high << 32) | low) >> 12) | 0x3ff0000000000000u);
}

/// Keyed noise of one trial (of each lane's trial).
template <class Real>
class KeyedDraws {
public:
    /// `truncate`: multiple of sigma beyond which a scalar draw is redrawn; infinity for never.
    KeyedDraws(std::uint64_t root_seed, Bits<Real> trial, double truncate)
        : keys_(static_cast<std::uint32_t>(root_seed), static_cast<std::uint32_t>(root_seed >> 32)),
          trial_(trial),
          truncates_(truncate < largest_draw),
          truncate_(truncate) {}

    Vector2<Real> normal(Source source, int pose, int index) const {
        return truncated(transformed(block(source, pose, index, 0)), source, pose, index);
    }

    /// The same for `count` draws, stage by stage: the stages of one draw wait for each other, those of several do not.
    template <int count>
    void normals(Source source, int pose, int first, Known<count>, Vector2<Real>* draws) const {
        PhiloxBlock<Bits<Real>> random[count];
        Real radius[count];
        each(zero, Known<count>{}, [&](auto i) { random[i] = block(source, pose, first + i, 0); });
        each(zero, Known<count>{}, [&](auto i) { radius[i] = radius_of(random[i]); });
        each(zero, Known<count>{}, [&](auto i) {
            draws[i] = truncated(at_angle(radius[i], random[i]), source, pose, first + i);
        });
    }

    Real uniform(Source source, int pose, int index) const {
        const PhiloxBlock<Bits<Real>> random = block(source, pose, index, 0);
        return in_one_to_two<Real>(random.word[1], random.word[0]) - Real(1);
    }

private:
    static constexpr std::uint32_t attempts = 4096;
    /// sqrt(-2 log 2^-52) = 8.5: the transform gives nothing beyond.
    static constexpr double largest_draw = 9;

    Vector2<Real> truncated(const Vector2<Real>& draw, Source source, int pose, int index) const {
        return truncates_ ? redrawn(draw, source, pose, index) : draw;
    }

    /// The draw, or where a component lies beyond the truncation, what came of drawing it again. Kept out of the way of
    /// those who do not truncate.
    [[gnu::noinline]] Vector2<Real> redrawn(Vector2<Real> draw, Source source, int pose, int index) const {
        // Each component is redrawn by itself; the attempt's number is part of the key [model.md, Conventions].
        for (std::uint32_t again = 1; again < attempts; ++again) {
            const Mask<Real> redraw_x = absolute(draw.x) > truncate_, redraw_y = absolute(draw.y) > truncate_;
            if (!any(either(redraw_x, redraw_y))) break;
            const Vector2<Real> next = transformed(block(source, pose, index, again));
            draw = {select(redraw_x, next.x, draw.x), select(redraw_y, next.y, draw.y)};
        }
        return draw;
    }

    /// Counter: trial (64 bits), pose (32), then attempt (12), source (4) and index (16).
    PhiloxBlock<Bits<Real>> block(Source source, int pose, int index, std::uint32_t attempt_number) const {
        const std::uint64_t what = std::uint64_t{attempt_number} << 20 |
                                   std::uint64_t{static_cast<std::uint32_t>(source)} << 16 |
                                   static_cast<std::uint64_t>(index);
        const Bits<Real> zero{};
        return philox<Bits<Real>>(
            {{trial_ & std::uint64_t{0xffffffff}, trial_ >> 32, zero + static_cast<std::uint64_t>(pose), zero + what}},
            keys_);
    }

    /// Box and Muller's transform: the radius from one uniform in (0, 1], the angle from another in [0, 1).
    static Real radius_of(const PhiloxBlock<Bits<Real>>& random) {
        const Real u1 = Real(2) - in_one_to_two<Real>(random.word[1], random.word[0]);
        return sqrt(Real(-2) * log(u1));
    }

    static Vector2<Real> at_angle(Real radius, const PhiloxBlock<Bits<Real>>& random) {
        const Real u2 = in_one_to_two<Real>(random.word[3], random.word[2]) - Real(1);
        const Rotation<Real> angle = rotation_of_turns(u2);
        return {radius * angle.cosine, radius * angle.sine};
    }

    static Vector2<Real> transformed(const PhiloxBlock<Bits<Real>>& random) {
        return at_angle(radius_of(random), random);
    }

    PhiloxKeys keys_;
    Bits<Real> trial_;
    bool truncates_;
    Real truncate_;
};

/// Draws of one source and pose for indices 0 ... count - 1, from any source of noise.
template <class Noise, class Count, class Real>
void draw_all(const Noise& noise, Source source, int pose, Count count, Vector2<Real>* draws) {
    each(zero, count, [&](auto i) { draws[i] = noise.normal(source, pose, i); });
}

/// Keyed draws, several at a time; one copy of the code for all who draw.
template <class Real, int count>
[[gnu::noinline]] CREDENCE_FLAT void draw_all(const KeyedDraws<Real>& noise, Source source, int pose, Known<count> all,
                            Vector2<Real>* draws) {
    noise.normals(source, pose, 0, all, draws);
}

template <class Real>
[[gnu::noinline]] CREDENCE_FLAT void draw_all(const KeyedDraws<Real>& noise, Source source, int pose, int count, Vector2<Real>* draws) {
    constexpr Known<4> group{};
    int i = 0;
    for (; i + group <= count; i += group) noise.normals(source, pose, i, group, draws + i);
    for (; i < count; ++i) draws[i] = noise.normal(source, pose, i);
}

}  // namespace CREDENCE_UNIT
}  // namespace credence
