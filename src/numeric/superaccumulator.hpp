#pragma once
// Fast exact sums of the values of a block; ExactSum takes about five times as long.

#include <credence/detail/exact_sum.hpp>

#include "base/nan.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace credence {

/// The exact sum of at most 1024 doubles, as integers: chunk c counts units of 2^(32 c - 1075), and a double adds to
/// two of them [Neal, Fast exact summation using small and large superaccumulators, 2015, arXiv 1505.05571, section 2].
class Superaccumulator {
public:
    void add(double value) {
        finite_ = finite_ && std::abs(value) < 1e300;  // the same limit as ExactSum's
        if (!finite_) return;
        constexpr std::uint64_t one = std::uint64_t{1} << 52;
        const auto bits = std::bit_cast<std::uint64_t>(value);
        std::uint64_t exponent = bits >> 52 & 0x7ff, mantissa = bits & (one - 1);
        if (exponent == 0)
            exponent = 1;  // subnormal
        else
            mantissa |= one;
        // |value| = mantissa 2^(exponent - 1075) = (mantissa 2^(exponent mod 32)) units of the chunk.
        const std::uint64_t shift = exponent % 32;
        const std::size_t chunk = exponent / 32;
        const auto low = static_cast<std::int64_t>(mantissa << shift & 0xffffffff),
                   // Below 2^53: 1024 of them do not overflow.
                   high = static_cast<std::int64_t>(mantissa >> (32 - shift));
        const std::int64_t sign = bits >> 63 == 0 ? 1 : -1;
        chunks_[chunk] += sign * low;
        chunks_[chunk + 1] += sign * high;
    }

    ExactSum sum() const {
        ExactSum sum;
        if (!finite_) sum.add(nan);
        for (std::size_t c = 0; c < chunks_.size(); ++c) {
            if (chunks_[c] == 0) continue;
            const std::int64_t high = chunks_[c] >> 32, low = chunks_[c] & 0xffffffff;  // each exact as a double
            const int exponent = 32 * static_cast<int>(c) - 1075;
            sum.add(std::ldexp(static_cast<double>(low), exponent));
            sum.add(std::ldexp(static_cast<double>(high), exponent + 32));
        }
        return sum;
    }

private:
    std::array<std::int64_t, 65> chunks_{};
    bool finite_ = true;
};

}  // namespace credence
