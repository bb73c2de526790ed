#pragma once
// Room 2: draws. A draw is a pure function of (root seed, trial, pose, source, index, attempt): never of the order of
// calls, of the thread, or of what an arm saw or planned. All arms of a trial therefore share their noise.
//
// The face of a noise source, here and in recorded_noise.hpp:
//   Vector2<Real> normal(Source, int pose, int index)   two independent standard-normal draws
//   Real          uniform(Source, int pose, int index)  in [0, 1)

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

/// Philox4x32-10 [Salmon, Moraes, Dror, Shaw: Parallel Random Numbers: As Easy as 1, 2, 3, SC11]: ten rounds of a
/// keyed bijection on a 128-bit counter. Checked bit for bit against the Random123 library in tests/draws.
template <class Word>
PhiloxBlock<Word> philox(PhiloxBlock<Word> counter, std::uint32_t key0, std::uint32_t key1) {
    constexpr std::uint64_t low_half = 0xffffffffu;
    for (int round = 0; round < 10; ++round) {
        const Word product0 = widening_product(counter.word[0], 0xD2511F53u);
        const Word product1 = widening_product(counter.word[2], 0xCD9E8D57u);
        counter = {{(product1 >> 32) ^ counter.word[1] ^ std::uint64_t{key0}, product1 & low_half,
                    (product0 >> 32) ^ counter.word[3] ^ std::uint64_t{key1}, product0 & low_half}};
        key0 += 0x9E3779B9u;
        key1 += 0xBB67AE85u;
    }
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
        : key0_(static_cast<std::uint32_t>(root_seed)),
          key1_(static_cast<std::uint32_t>(root_seed >> 32)),
          trial_(trial),
          truncate_(truncate) {}

    Vector2<Real> normal(Source source, int pose, int index) const {
        Vector2<Real> draw = attempt(source, pose, index, 0);
        // Each component is redrawn by itself; the attempt's number is part of the key [model.md, Conventions].
        for (std::uint32_t again = 1; again < attempts; ++again) {
            const Mask<Real> redraw_x = absolute(draw.x) > truncate_, redraw_y = absolute(draw.y) > truncate_;
            if (!any(either(redraw_x, redraw_y))) break;
            const Vector2<Real> next = attempt(source, pose, index, again);
            draw = {select(redraw_x, next.x, draw.x), select(redraw_y, next.y, draw.y)};
        }
        return draw;
    }

    Real uniform(Source source, int pose, int index) const {
        const PhiloxBlock<Bits<Real>> random = block(source, pose, index, 0);
        return in_one_to_two<Real>(random.word[1], random.word[0]) - Real(1);
    }

private:
    static constexpr std::uint32_t attempts = 4096;

    /// Counter: trial (64 bits), pose (32), then attempt (12), source (4) and index (16).
    PhiloxBlock<Bits<Real>> block(Source source, int pose, int index, std::uint32_t attempt_number) const {
        const std::uint64_t what = std::uint64_t{attempt_number} << 20 |
                                   std::uint64_t{static_cast<std::uint32_t>(source)} << 16 |
                                   static_cast<std::uint64_t>(index);
        const Bits<Real> zero{};
        return philox<Bits<Real>>(
            {{trial_ & std::uint64_t{0xffffffff}, trial_ >> 32, zero + static_cast<std::uint64_t>(pose), zero + what}},
            key0_, key1_);
    }

    /// Box and Muller's transform: the radius from one uniform in (0, 1], the angle from another in [0, 1).
    Vector2<Real> attempt(Source source, int pose, int index, std::uint32_t number) const {
        const PhiloxBlock<Bits<Real>> random = block(source, pose, index, number);
        const Real u1 = Real(2) - in_one_to_two<Real>(random.word[1], random.word[0]);
        const Real u2 = in_one_to_two<Real>(random.word[3], random.word[2]) - Real(1);
        const Real radius = sqrt(Real(-2) * log(u1));
        const Rotation<Real> angle = rotation_of_turns(u2);
        return {radius * angle.cosine, radius * angle.sine};
    }

    std::uint32_t key0_, key1_;
    Bits<Real> trial_;
    Real truncate_;
};

}  // namespace CREDENCE_UNIT
}  // namespace credence
