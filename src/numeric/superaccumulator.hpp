#pragma once
// Fast exact sums of the values of a block and of their squares; with ExactSum they take some ten times as long.

#include <credence/detail/exact_sum.hpp>

#include "base/nan.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace credence {

/// The exact sum of at most 1024 doubles, and that of their squares, as integers [Neal, Fast exact summation using
/// small and large superaccumulators, 2015, arXiv 1505.05571]: first by exponent, for the exponents near that of the
/// first value, and at the end, or for the others, in chunks of the whole range.
class Superaccumulator {
public:
    void add(double value) {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        constexpr std::uint64_t one = std::uint64_t{1} << 52;
        std::uint64_t exponent = bits >> 52 & 0x7ff, mantissa = bits & (one - 1);
        if (exponent == 0)
            exponent = 1;  // subnormal
        else
            mantissa |= one;
        finite_ = finite_ && std::abs(value) < 1e300;  // the same limit as ExactSum's
        squares_finite_ = squares_finite_ && std::abs(value) < 1e150;
        if (!finite_) return;
        // |value| = mantissa 2^(exponent - 1075), and so its square is mantissa^2 2^(2 exponent - 2150).
        const std::int64_t sign = bits >> 63 == 0 ? 1 : -1;
        if (empty_) start_at(exponent);
        if (const std::uint64_t place = exponent - first_; place < near) {
            sums_[place] += sign * static_cast<std::int64_t>(mantissa);  // below 2^53: 1024 of them do not overflow
            squares_[place] += Wide{mantissa} * mantissa;                // below 2^106: nor do these
            return;
        }
        sum_.add(mantissa, exponent, sign);
        add_square(Wide{mantissa} * mantissa, exponent);
    }

    ExactSum sum() {
        gather();
        return finite_ ? sum_.total(-1075) : none();
    }
    ExactSum square_sum() {
        gather();
        return squares_finite_ ? square_sum_.total(-2150) : none();
    }

private:
    __extension__ using Wide = unsigned __int128;
    __extension__ using SignedWide = __int128;

    /// An integer of many bits: chunk c counts units of 2^(16 c).
    template <std::size_t size>
    struct Chunks {
        std::array<std::int64_t, size + 6> chunks{};
        std::size_t first = size, end = 0;

        /// sign mantissa 2^exponent
        void add(std::uint64_t mantissa, std::uint64_t exponent, std::int64_t sign) {
            const std::size_t chunk = exponent / 16;
            Wide left = Wide{mantissa} << exponent % 16;
            first = std::min(first, chunk);
            end = std::max(end, chunk + 5);
            for (std::size_t c = chunk; left != 0; c += 2, left >>= 32)
                chunks[c] += sign * static_cast<std::int64_t>(static_cast<std::uint64_t>(left) & 0xffffffff);
        }

        /// This times 2^base, in parts of 48 bits.
        ExactSum total(int base) const {
            ExactSum sum;
            SignedWide carried = 0;
            std::size_t c = first;
            for (; c < end; c += 3) {
                carried += SignedWide{chunks[c]} + SignedWide{chunks[c + 1]} * 0x10000 +
                           SignedWide{chunks[c + 2]} * 0x100000000;
                constexpr std::int64_t mask = (std::int64_t{1} << 48) - 1;
                add_part(sum, static_cast<std::int64_t>(carried) & mask, c, base);
                carried >>= 48;
            }
            add_part(sum, static_cast<std::int64_t>(carried), c, base);
            return sum;
        }

        static void add_part(ExactSum& sum, std::int64_t part, std::size_t chunk, int base) {
            if (part != 0) sum.add(std::ldexp(static_cast<double>(part), 16 * static_cast<int>(chunk) + base));
        }
    };

    void start_at(std::uint64_t exponent) {
        first_ = exponent < near / 2 ? 0 : exponent - near / 2;
        empty_ = false;
    }

    void add_square(Wide square, std::uint64_t exponent) {
        square_sum_.add(static_cast<std::uint64_t>(square), 2 * exponent, 1);
        square_sum_.add(static_cast<std::uint64_t>(square >> 64), 2 * exponent + 64, 1);
    }

    void gather() {
        for (std::uint64_t place = 0; place < near; ++place) {
            if (squares_[place] == 0) continue;
            const std::int64_t sum = sums_[place];
            sum_.add(static_cast<std::uint64_t>(sum < 0 ? -sum : sum), first_ + place, sum < 0 ? -1 : 1);
            add_square(squares_[place], first_ + place);
            sums_[place] = 0;
            squares_[place] = 0;
        }
    }

    static ExactSum none() {
        ExactSum sum;
        sum.add(nan);
        return sum;
    }

    static constexpr std::uint64_t near = 64;
    std::array<std::int64_t, near> sums_{};
    std::array<Wide, near> squares_{};
    std::uint64_t first_ = 0;
    bool empty_ = true, finite_ = true, squares_finite_ = true;
    Chunks<2048 / 16> sum_;
    Chunks<(4096 + 64) / 16> square_sum_;
};

}  // namespace credence
