// The keyed draws, against the Random123 library and against what normal draws must be. Statistical tests run
// on fixed seeds, so they either always pass or always fail; the false-alarm rates are what another seed would have.

#include "catch.hpp"

#include <credence/detail/draws.hpp>

#include <Random123/philox.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <vector>

namespace credence::test::draws_test {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr Source all_sources[] = {Source::odometry_heading, Source::odometry_position, Source::walk,
                                  Source::deformation,      Source::measurement,       Source::edge,
                                  Source::detection,        Source::landmark_prior};

/// The four words that belong to a key, by Random123 and the counter's documented layout.
philox4x32_ctr_t reference_words(std::uint64_t seed, std::uint64_t trial, int pose, Source source, int index,
                                 int attempt) {
    const auto what = static_cast<std::uint32_t>(attempt) << 20 | static_cast<std::uint32_t>(source) << 16 |
                      static_cast<std::uint32_t>(index);
    const philox4x32_ctr_t counter{{static_cast<std::uint32_t>(trial), static_cast<std::uint32_t>(trial >> 32),
                                    static_cast<std::uint32_t>(pose), what}};
    const philox4x32_key_t key{{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}};
    return philox4x32(counter, key);
}

/// 52 bits of two words, as a fraction in [0, 1).
double fraction(std::uint32_t low, std::uint32_t high) {
    return static_cast<double>((std::uint64_t{high} << 32 | low) >> 12) * 0x1p-52;
}

/// Box and Muller's pair by the C library, from Random123's words.
Vector2<double> reference_normal(std::uint64_t seed, std::uint64_t trial, int pose, Source source, int index,
                                 int attempt) {
    const philox4x32_ctr_t words = reference_words(seed, trial, pose, source, index, attempt);
    const double radius = std::sqrt(-2 * std::log(1 - fraction(words[0], words[1])));
    const double angle = 2 * pi * fraction(words[2], words[3]);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

double distance(const Vector2<double>& a, const Vector2<double>& b) { return std::hypot(a.x - b.x, a.y - b.y); }

bool same(const Vector2<double>& a, const Vector2<double>& b) { return a.x == b.x && a.y == b.y; }

/// Draws so many keys together, a number that the compiler knows or not, and compares each with the draw alone.
template <class Count>
void check_together(const KeyedDraws<double>& draws, Count count) {
    CAPTURE(static_cast<int>(count));
    std::vector<DrawKey> keys;
    for (int i = 0; i < count; ++i) keys.push_back({all_sources[i % 8], 100 - 3 * i, 7 * i % 5});
    const Vector2<double> none{never, never};
    std::vector<Vector2<double>> together(keys.size() + 1, none);
    draw_all(draws, keys.data(), count, together.data());
    for (std::size_t i = 0; i < keys.size(); ++i)
        CHECK(same(together[i], draws.normal(keys[i].source, keys[i].pose, keys[i].index)));
    CHECK(same(together.back(), none));
}

}  // namespace

TEST_CASE("draws: philox gives Random123's published known answers") {
    // kat_vectors of Random123: philox4x32 10, counter and key of zeros, of ones, and of pi's digits.
    const auto words = [](std::uint64_t a, std::uint64_t b, std::uint64_t c, std::uint64_t d, std::uint32_t k0,
                          std::uint32_t k1) {
        const PhiloxBlock<std::uint64_t> r = philox<std::uint64_t>({{a, b, c, d}}, PhiloxKeys(k0, k1));
        std::vector<std::uint64_t> low;
        for (const std::uint64_t word : r.word) low.push_back(word & 0xffffffff);
        return low;
    };
    const std::uint64_t ones = 0xffffffff;
    CHECK(words(0, 0, 0, 0, 0, 0) == std::vector<std::uint64_t>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
    CHECK(words(ones, ones, ones, ones, 0xffffffff, 0xffffffff) ==
          std::vector<std::uint64_t>{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
    CHECK(words(0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344, 0xa4093822, 0x299f31d0) ==
          std::vector<std::uint64_t>{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("draws: philox is Random123's, bit for bit, on random counters and keys") {
    std::mt19937 random(1);
    const auto any_word = [&] { return static_cast<std::uint32_t>(random()); };
    for (int i = 0; i < 20000; ++i) {
        const philox4x32_ctr_t counter{{any_word(), any_word(), any_word(), any_word()}};
        const philox4x32_key_t key{{any_word(), any_word()}};
        const philox4x32_ctr_t expected = philox4x32(counter, key);
        const PhiloxBlock<std::uint64_t> words =
            philox<std::uint64_t>({{counter[0], counter[1], counter[2], counter[3]}}, PhiloxKeys(key[0], key[1]));
        for (unsigned w = 0; w < 4; ++w) REQUIRE((words.word[w] & 0xffffffff) == expected[w]);
    }
}

TEST_CASE("draws: uniforms are 52 bits of the words of their key, bit for bit") {
    // This pins the counter's layout: a stored study can only be replayed while it stays.
    std::mt19937_64 random(2);
    for (int i = 0; i < 5000; ++i) {
        const std::uint64_t seed = random(), trial = random();
        const int pose = static_cast<int>(random() % 100000), index = static_cast<int>(random() % 65536);
        const Source source = all_sources[random() % std::size(all_sources)];
        const philox4x32_ctr_t words = reference_words(seed, trial, pose, source, index, 0);
        REQUIRE(KeyedDraws<double>(seed, trial, never).uniform(source, pose, index) == fraction(words[0], words[1]));
    }
}

TEST_CASE("draws: normals are Box and Muller's of the words of their key") {
    std::mt19937_64 random(3);
    for (int i = 0; i < 20000; ++i) {
        const std::uint64_t seed = random(), trial = random() % 100000;
        const int pose = static_cast<int>(random() % 20), index = static_cast<int>(random() % 3);
        const Source source = all_sources[random() % std::size(all_sources)];
        // The C library's log, sqrt, sin and cos and ours err by a few ulp of at most 8.5.
        REQUIRE(distance(KeyedDraws<double>(seed, trial, never).normal(source, pose, index),
                         reference_normal(seed, trial, pose, source, index, 0)) < 2e-14);
    }
}

TEST_CASE("draws: a truncated component is that of the first attempt within, the attempt being part of the key") {
    const double t = 0.7;
    for (std::uint64_t trial = 0; trial < 2000; ++trial) {
        Vector2<double> expected{2 * t, 2 * t};
        for (int attempt = 0; std::abs(expected.x) > t || std::abs(expected.y) > t; ++attempt) {
            const Vector2<double> next = reference_normal(9, trial, 5, Source::edge, 2, attempt);
            if (std::abs(expected.x) > t) expected.x = next.x;
            if (std::abs(expected.y) > t) expected.y = next.y;
        }
        REQUIRE(distance(KeyedDraws<double>(9, trial, t).normal(Source::edge, 5, 2), expected) < 2e-14);  // as above
    }
}

TEST_CASE("draws: 52 random bits become every number from 1 to below 2") {
    CHECK(in_one_to_two<double>(0, 0) == 1.0);
    CHECK(in_one_to_two<double>(0xffffffff, 0xffffffff) == 2 - 0x1p-52);
    CHECK(in_one_to_two<double>(0x80000000, 0) == 1.5);
    CHECK(in_one_to_two<double>(0, 0x1000) == 1 + 0x1p-52);
    CHECK(in_one_to_two<double>(0, 0x0fff) == 1.0);
    // So Box and Muller's u1 = 2 - that is never 0, and the radius at most sqrt(104 log 2).
    CHECK(std::sqrt(-2 * log_of_normal(2 - in_one_to_two<double>(0xffffffff, 0xffffffff))) ==
          Approx(std::sqrt(104 * std::log(2.0))));
}

TEST_CASE("draws: changing any part of the key changes the draw") {
    const auto draw = [](std::uint64_t seed, std::uint64_t trial, Source source, int pose, int index) {
        return KeyedDraws<double>(seed, trial, never).normal(source, pose, index);
    };
    const Vector2<double> base = draw(1, 2, Source::walk, 3, 4);
    CHECK(same(base, draw(1, 2, Source::walk, 3, 4)));
    for (int bit = 0; bit < 64; ++bit) {
        const std::uint64_t flip = std::uint64_t{1} << bit;
        CAPTURE(bit);
        CHECK_FALSE(same(base, draw(1 ^ flip, 2, Source::walk, 3, 4)));
        CHECK_FALSE(same(base, draw(1, 2 ^ flip, Source::walk, 3, 4)));
        if (bit < 31) CHECK_FALSE(same(base, draw(1, 2, Source::walk, 3 ^ (1 << bit), 4)));
        if (bit < 16) CHECK_FALSE(same(base, draw(1, 2, Source::walk, 3, 4 ^ (1 << bit))));
    }
    for (const Source source : all_sources)
        CHECK(same(base, draw(1, 2, source, 3, 4)) == (source == Source::walk));
}

TEST_CASE("draws: the order of asking does not matter") {
    const KeyedDraws<double> draws(7, 11, 2.0);
    std::vector<std::pair<Source, int>> keys;
    for (const Source source : all_sources)
        for (int pose = 0; pose < 50; ++pose) keys.emplace_back(source, pose);
    std::map<std::pair<Source, int>, Vector2<double>> forwards;
    for (const auto& key : keys) forwards[key] = draws.normal(key.first, key.second, 1);
    std::shuffle(keys.begin(), keys.end(), std::mt19937(5));
    const KeyedDraws<double> again(7, 11, 2.0);
    for (const auto& key : keys) {
        again.uniform(Source::detection, key.second, 0);
        CHECK(same(again.normal(key.first, key.second, 1), forwards[key]));
    }
}

TEST_CASE("draws: several together are the bits of each alone, however many there are") {
    for (const double truncate : {never, 1.0}) {
        CAPTURE(truncate);
        const KeyedDraws<double> draws(7, 11, truncate);
        each(zero, Known<20>{}, [&](auto count) {
            check_together(draws, count);
            check_together(draws, int{count});
        });
    }
}

TEST_CASE("draws: neighbouring seeds share no draw over a block") {
    // 256 trials x 20 poses x 21 draws x 2 seeds: 2e5 pairs. Two of them agree in x by chance with 2e-6.
    std::set<std::uint64_t> seen;
    std::size_t asked = 0;
    for (const std::uint64_t seed : {41u, 42u})
        for (std::uint64_t trial = 0; trial < 256; ++trial)
            for (int pose = 0; pose < 20; ++pose)
                for (const Source source : all_sources)
                    for (int index = 0; index < 3; ++index) {
                        const KeyedDraws<double> draws(seed, trial, never);
                        seen.insert(bits_of(draws.normal(source, pose, index).x));
                        ++asked;
                    }
    CHECK(seen.size() == asked);
}

}  // namespace credence::test::draws_test
