#pragma once
// Module numeric: W trials at once. Lane<W> is a Real: a pack of W doubles with the operations of real.hpp, each lane
// giving the same bits as a plain double. Only this file and lane_mask.hpp use intrinsics; other code uses the
// compiler's vector extension.

#include <credence/detail/lane_mask.hpp>

#include <concepts>
#include <type_traits>

namespace credence {
inline namespace CREDENCE_TARGET {

template <int W>
struct Lane {
    using V = typename LaneTypes<W>::Doubles;
    V v;
    Lane() = default;
    Lane(V raw) : v(raw) {}
    /// The same number in all lanes. (Unlike one + V{}, the difference is exact for -0; the compiler removes it.)
    template <class Number>
    requires std::is_arithmetic_v<Number> Lane(Number one) : v(static_cast<double>(one) - V{}) {}
    template <std::same_as<bool> Bool>
    explicit operator Bool() const { return branch<Bool>(); }

    friend Lane operator+(Lane a, Lane b) { return a.v + b.v; }
    friend Lane operator-(Lane a, Lane b) { return a.v - b.v; }
    friend Lane operator*(Lane a, Lane b) { return a.v * b.v; }
    friend Lane operator/(Lane a, Lane b) { return a.v / b.v; }
    friend Lane operator-(Lane a) { return -a.v; }
    Lane& operator+=(Lane b) { return *this = *this + b; }
    Lane& operator-=(Lane b) { return *this = *this - b; }
    Lane& operator*=(Lane b) { return *this = *this * b; }
    Lane& operator/=(Lane b) { return *this = *this / b; }
    friend LaneMask<W> operator<(Lane a, Lane b) { return b > a; }
    friend LaneMask<W> operator<=(Lane a, Lane b) { return b >= a; }
    friend LaneMask<W> operator>(Lane a, Lane b) {
#if defined(__AVX512F__)
        if constexpr (W == 8) return {_mm512_cmp_pd_mask((__m512d)a.v, (__m512d)b.v, _CMP_GT_OQ)};
        else
#endif
        return {a.v > b.v};
    }
    friend LaneMask<W> operator>=(Lane a, Lane b) {
#if defined(__AVX512F__)
        if constexpr (W == 8) return {_mm512_cmp_pd_mask((__m512d)a.v, (__m512d)b.v, _CMP_GE_OQ)};
        else
#endif
        return {a.v >= b.v};
    }
    friend LaneMask<W> operator==(Lane a, Lane b) {
#if defined(__AVX512F__)
        if constexpr (W == 8) return {_mm512_cmp_pd_mask((__m512d)a.v, (__m512d)b.v, _CMP_EQ_OQ)};
        else
#endif
        return {a.v == b.v};
    }
    friend LaneMask<W> operator!=(Lane a, Lane b) { return negated(a == b); }
};

/// Number of trials in a Real.
template <class Real>
inline constexpr int lanes = static_cast<int>(sizeof(Real) / sizeof(double));

/// The Real for W trials at once: for one trial, a plain double.
template <int W>
struct PackOf {
    using type = Lane<W>;
};
template <>
struct PackOf<1> {
    using type = double;
};
template <int W>
using Pack = typename PackOf<W>::type;

template <int W>
struct BitsOf<Lane<W>> {
    using type = LaneBits<W>;
};

template <int W>
LaneBits<W> bits_of(Lane<W> x) { return __builtin_bit_cast(typename LaneTypes<W>::Unsigned, x.v); }
template <int W>
Lane<W> from_bits(LaneBits<W> x) { return __builtin_bit_cast(typename LaneTypes<W>::Doubles, x.v); }

template <int W>
LaneBits<W> widening_product(LaneBits<W> a, std::uint32_t b) {
#if defined(__AVX512F__)
    if constexpr (W == 8)
        return (typename LaneBits<W>::V)_mm512_maskz_mul_epu32(0xff, (__m512i)a.v, _mm512_set1_epi64(b));
#endif
#if defined(__AVX2__)
    if constexpr (W == 4) return (typename LaneBits<W>::V)_mm256_mul_epu32((__m256i)a.v, _mm256_set1_epi64x(b));
#endif
    return (a.v & std::uint64_t{0xffffffff}) * std::uint64_t{b};
}

/// a ^ b ^ c, one instruction where there is one.
template <int W>
LaneBits<W> exclusive_or(LaneBits<W> a, LaneBits<W> b, LaneBits<W> c) {
#if defined(__AVX512F__)
    if constexpr (W == 8)
        return (typename LaneBits<W>::V)_mm512_ternarylogic_epi64((__m512i)a.v, (__m512i)b.v, (__m512i)c.v, 0x96);
#endif
    return a.v ^ b.v ^ c.v;
}

/// The mask that is true in the lanes of these bits.
template <class Real>
Mask<Real> mask_of_bits(unsigned bits) {
    if constexpr (lanes<Real> == 1) {
        return bits & 1;
#if defined(__AVX512F__)
    } else if constexpr (lanes<Real> == 8) {
        return {static_cast<__mmask8>(bits)};
#endif
    } else {
        typename LaneTypes<lanes<Real>>::Unsigned own;
        for (int i = 0; i < lanes<Real>; ++i) own[i] = std::uint64_t{1} << i;
        return {(own & std::uint64_t{bits}) != std::uint64_t{0}};
    }
}

template <int W>
Lane<W> select(LaneMask<W> mask, Lane<W> yes, Lane<W> no) {
#if defined(__AVX512F__)
    if constexpr (W == 8)
        return (typename Lane<W>::V)_mm512_mask_blend_pd(mask.m, (__m512d)no.v, (__m512d)yes.v);
    else
#endif
    return mask.m ? yes.v : no.v;
}

/// low <= x <= high, of numbers that are not negative: they are ordered as their bits are, NaN last, and the difference
/// of a value below `low` wraps around to above everything, so that one comparison suffices.
template <int W>
LaneMask<W> within(Lane<W> x, Lane<W> low, Lane<W> high) {
#if defined(__AVX512F__)
    if constexpr (W == 8)
        return {_mm512_cmple_epu64_mask((__m512i)(bits_of(x) - bits_of(low)).v,
                                        (__m512i)(bits_of(high) - bits_of(low)).v)};
    else
#endif
        return both(x >= low, x <= high);
}

/// A pack loaded from its doubles in memory, with any alignment.
template <class Real>
Real load(const double* from) {
    Real pack;
    __builtin_memcpy(static_cast<void*>(&pack), from, sizeof pack);
    return pack;
}
template <class Real>
void store(const Real& pack, double* to) {
    __builtin_memcpy(to, &pack, sizeof pack);
}

/// One lane's number.
inline double lane_of(double x, int) { return x; }
template <int W>
double lane_of(const Lane<W>& x, int lane) { return x.v[lane]; }
inline void set_lane(double& x, int, double value) { x = value; }
template <int W>
void set_lane(Lane<W>& x, int lane, double value) { x.v[lane] = value; }

template <int W>
Lane<W> fma(Lane<W> a, Lane<W> b, Lane<W> c) {
#if defined(__AVX512F__)
    if constexpr (W == 8) return (typename Lane<W>::V)_mm512_fmadd_pd((__m512d)a.v, (__m512d)b.v, (__m512d)c.v);
#endif
#if defined(__AVX2__)
    if constexpr (W == 4) return (typename Lane<W>::V)_mm256_fmadd_pd((__m256d)a.v, (__m256d)b.v, (__m256d)c.v);
#endif
    Lane<W> r;
    for (int i = 0; i < W; ++i) r.v[i] = __builtin_fma(a.v[i], b.v[i], c.v[i]);
    return r;
}

template <int W>
Lane<W> fnma(Lane<W> a, Lane<W> b, Lane<W> c) {
#if defined(__AVX512F__)
    if constexpr (W == 8) return (typename Lane<W>::V)_mm512_fnmadd_pd((__m512d)a.v, (__m512d)b.v, (__m512d)c.v);
#endif
#if defined(__AVX2__)
    if constexpr (W == 4) return (typename Lane<W>::V)_mm256_fnmadd_pd((__m256d)a.v, (__m256d)b.v, (__m256d)c.v);
#endif
    return fma(-a, b, c);
}

template <int W>
Lane<W> sqrt(Lane<W> x) {
#if defined(__AVX512F__)
    if constexpr (W == 8) return (typename Lane<W>::V)_mm512_maskz_sqrt_pd(0xff, (__m512d)x.v);
#endif
#if defined(__AVX2__)
    if constexpr (W == 4) return (typename Lane<W>::V)_mm256_sqrt_pd((__m256d)x.v);
#endif
    Lane<W> r;
    for (int i = 0; i < W; ++i) r.v[i] = __builtin_sqrt(x.v[i]);
    return r;
}

template <int W>
Lane<W> absolute(Lane<W> x) { return from_bits(bits_of(x) & LaneBits<W>(0x7fffffffffffffffu)); }

}  // namespace CREDENCE_TARGET
}  // namespace credence
