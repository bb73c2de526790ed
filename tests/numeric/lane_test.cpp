// Packs of doubles. That whole trials are the same in every lane, the digest says.

#include "catch.hpp"
#include "lane_masks.hpp"

#include "slam/planning/screening.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#ifdef CREDENCE_LANE_MASKS_V4
#include "worlds/simulate.hpp"

namespace credence::lane_masks_v4 {
int wrong_masks_of_eight(const double* numbers, int count, double low, double high);
}
#endif

namespace credence::test::lane_test {

namespace {

#ifdef CREDENCE_LANE_MASKS_V4
bool runs_v4() {
    const std::vector<Target> targets = runnable_targets();
    return std::any_of(targets.begin(), targets.end(),
                       [](const Target& target) { return std::string(target.name) == "v4"; });
}
#endif

constexpr double infinite = std::numeric_limits<double>::infinity(),
                 no_number = std::numeric_limits<double>::quiet_NaN();
const std::vector<double> ends{0, std::numeric_limits<double>::denorm_min(), 0.01, 4, 1e300, infinite};

/// Every end, its neighbours and what is no number, in every lane of eight.
std::vector<double> numbers() {
    std::vector<double> all{no_number, -no_number, 1, 1e-300, std::numeric_limits<double>::max()};
    for (const double end : ends)
        for (const double x : {end, std::nextafter(end, infinite), std::nextafter(end, 0.0)}) all.push_back(x);
    std::vector<double> lanes;
    for (std::size_t i = 0; i < 8 * all.size(); ++i) lanes.push_back(all[(i + i / 8) % all.size()]);
    return lanes;
}

}  // namespace

TEST_CASE("lanes: a pack is within bounds where its numbers are, ends included, and no NaN is") {
    const std::vector<double> x = numbers();
    const int count = static_cast<int>(x.size());
    for (const double low : ends)
        for (const double high : ends) {
            if (high < low) continue;
            CAPTURE(low, high);
            CHECK(wrong_masks<1>(x.data(), count, low, high) == 0);
            CHECK(wrong_masks<2>(x.data(), count, low, high) == 0);
            CHECK(wrong_masks<4>(x.data(), count, low, high) == 0);
            CHECK(wrong_masks<8>(x.data(), count, low, high) == 0);
#ifdef CREDENCE_LANE_MASKS_V4
            if (runs_v4())
                CHECK(lane_masks_v4::wrong_masks_of_eight(x.data(), count, low, high) == 0);
#endif
        }
}

TEST_CASE("lanes: eight rows of bits become eight columns") {
    std::mt19937_64 random(3);
    for (int sample = 0; sample < 100; ++sample) {
        const std::uint64_t rows = random(), columns = transposed_bits(rows);
        for (int i = 0; i < 8; ++i)
            for (int j = 0; j < 8; ++j) REQUIRE((rows >> (8 * i + j) & 1) == (columns >> (8 * j + i) & 1));
    }
}

TEST_CASE("lanes: each lane takes the candidates that are left in it, in order, and no other") {
    using Real = Lane<4>;
    using StateLayout = Layout<Process::heading, 3>;
    std::mt19937 random(4);
    for (const int count : {1, 7, 8, 9, 64, 65, 127, 128}) {
        CAPTURE(count);
        constexpr int first = 256;
        std::vector<Control> candidates(first + 128);
        for (std::size_t i = 0; i < candidates.size(); ++i) candidates[i].turn = static_cast<double>(i);
        ControlParameters control;
        control.candidates = candidates.data();
        ScreeningWorkspace<StateLayout, Real> work;
        std::vector<double> expected[4], taken[4];
        for (int i = 0; i < (count + 7) / 8 * 8; ++i) {
            // Behind the last one too, where it must not matter.
            work.left[i] = static_cast<std::uint8_t>(random() % 16);
            if (i >= count) continue;
            for (int lane = 0; lane < 4; ++lane)
                if (work.left[i] >> lane & 1) expected[lane].push_back(first + i);
        }
        queue_left(count, work);
        Command<Real> command;
        for (Mask<Real> offered; any(offered = take_queued(control, first, work, command));)
            for (int lane = 0; lane < 4; ++lane)
                if (lane_bits(offered) >> lane & 1) taken[lane].push_back(lane_of(command.turn, lane));
        for (int lane = 0; lane < 4; ++lane) CHECK(taken[lane] == expected[lane]);
    }
}

}  // namespace credence::test::lane_test
