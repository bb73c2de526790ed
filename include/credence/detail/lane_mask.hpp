#pragma once
// Module numeric: masks and bits of W trials at once, as the lanes of lane.hpp have them.

#include <credence/detail/real.hpp>

#include <concepts>

#if defined(__AVX512F__) || defined(__AVX2__)
#include <immintrin.h>
#endif

namespace credence {
inline namespace CREDENCE_TARGET {

template <int W>
struct LaneTypes {
    typedef double Doubles __attribute__((vector_size(8 * W)));
    typedef std::int64_t Integers __attribute__((vector_size(8 * W)));
    typedef std::uint64_t Unsigned __attribute__((vector_size(8 * W)));
};

/// What a branch on a mask or a Real gives: a sentence from the compiler.
template <std::same_as<bool> Bool>
Bool branch() {
    static_assert(
        !std::same_as<Bool, bool>,
        "a Real has several trials, which cannot take different branches: write select(mask, yes, no); both, "
        "either and negated for &&, || and !; any(mask) or all(mask) where one answer for all lanes is meant");
    return {};
}

/// One bool per lane: all bits set, or none; with AVX-512 a bit each.
template <int W>
struct LaneMask {
    using M = typename LaneTypes<W>::Integers;
    M m;
    template <std::same_as<bool> Bool>
    explicit operator Bool() const { return branch<Bool>(); }
};
#if defined(__AVX512F__)
template <>
struct LaneMask<8> {
    using M = __mmask8;
    M m;
    template <std::same_as<bool> Bool>
    explicit operator Bool() const { return branch<Bool>(); }
};
#endif

/// One unsigned 64-bit integer per lane.
template <int W>
struct LaneBits {
    using V = typename LaneTypes<W>::Unsigned;
    V v;
    LaneBits() = default;
    LaneBits(V raw) : v(raw) {}
    LaneBits(std::uint64_t one) : v(V{} + one) {}

    friend LaneBits operator+(LaneBits a, LaneBits b) { return a.v + b.v; }
    friend LaneBits operator-(LaneBits a, LaneBits b) { return a.v - b.v; }
    friend LaneBits operator*(LaneBits a, LaneBits b) { return a.v * b.v; }
    friend LaneBits operator&(LaneBits a, LaneBits b) { return a.v & b.v; }
    friend LaneBits operator|(LaneBits a, LaneBits b) { return a.v | b.v; }
    friend LaneBits operator^(LaneBits a, LaneBits b) { return a.v ^ b.v; }
    friend LaneBits operator<<(LaneBits a, int n) { return a.v << n; }
    friend LaneBits operator>>(LaneBits a, int n) { return a.v >> n; }
    friend LaneMask<W> operator!=(LaneBits a, LaneBits b) {
#if defined(__AVX512F__)
        if constexpr (W == 8) return {_mm512_cmpneq_epi64_mask((__m512i)a.v, (__m512i)b.v)};
        else
#endif
        return {a.v != b.v};
    }
};

template <int W>
LaneMask<W> both(LaneMask<W> a, LaneMask<W> b) { return {static_cast<typename LaneMask<W>::M>(a.m & b.m)}; }
template <int W>
LaneMask<W> either(LaneMask<W> a, LaneMask<W> b) { return {static_cast<typename LaneMask<W>::M>(a.m | b.m)}; }
template <int W>
LaneMask<W> negated(LaneMask<W> a) { return {static_cast<typename LaneMask<W>::M>(~a.m)}; }

/// The lanes of a mask as bits, lane 0 lowest.
inline unsigned lane_bits(bool mask) { return mask; }
template <int W>
unsigned lane_bits(LaneMask<W> mask) {
#if defined(__AVX512F__)
    if constexpr (W == 8) return mask.m;
    else
#endif
#if defined(__AVX2__)
    if constexpr (W == 4) return static_cast<unsigned>(_mm256_movemask_pd((__m256d)mask.m));
    else
#endif
    {
        unsigned bits = 0;
        for (int i = 0; i < W; ++i) bits |= static_cast<unsigned>(mask.m[i] & 1) << i;
        return bits;
    }
}

/// Number of lanes in which a mask is true.
inline int lane_count(bool mask) { return mask; }
template <int W>
int lane_count(LaneMask<W> mask) {
    const unsigned bits = lane_bits(mask);
#if defined(__POPCNT__)
    return __builtin_popcount(bits);
#else
    int count = 0;  // the builtin would be a call into a library
    for (int i = 0; i < W; ++i) count += static_cast<int>(bits >> i & 1);
    return count;
#endif
}

template <int W>
bool any(LaneMask<W> mask) { return lane_bits(mask) != 0; }
template <int W>
bool all(LaneMask<W> mask) { return lane_bits(mask) == (1u << W) - 1; }

}  // namespace CREDENCE_TARGET
}  // namespace credence
