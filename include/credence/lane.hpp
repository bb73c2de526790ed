#pragma once
// Room 1: W trials at once. Lane<W> is a Real: a pack of W doubles with the operations of real.hpp, each lane giving
// the bits that a plain double would. The only place with intrinsics; everything else is the compiler's vector
// extension.

#include <credence/real.hpp>

#if defined(__AVX512F__) || defined(__AVX2__)
#include <immintrin.h>
#endif

namespace credence {
inline namespace CREDENCE_UNIT {

template <int W>
struct LaneTypes {
    typedef double Doubles __attribute__((vector_size(8 * W)));
    typedef std::int64_t Integers __attribute__((vector_size(8 * W)));
    typedef std::uint64_t Unsigned __attribute__((vector_size(8 * W)));
};

/// One bool per lane: all bits set, or none.
template <int W>
struct LaneMask {
    typename LaneTypes<W>::Integers m;
};

/// One unsigned 64-bit integer per lane.
template <int W>
struct LaneBits {
    using V = typename LaneTypes<W>::Unsigned;
    V v;
    LaneBits() : v{} {}
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
    friend LaneMask<W> operator!=(LaneBits a, LaneBits b) { return {a.v != b.v}; }
};

template <int W>
struct Lane {
    using V = typename LaneTypes<W>::Doubles;
    V v;
    Lane() : v{} {}
    Lane(V raw) : v(raw) {}
    explicit Lane(double one) : v(V{} + one) {}
    explicit Lane(int one) : Lane(static_cast<double>(one)) {}

    friend Lane operator+(Lane a, Lane b) { return a.v + b.v; }
    friend Lane operator-(Lane a, Lane b) { return a.v - b.v; }
    friend Lane operator*(Lane a, Lane b) { return a.v * b.v; }
    friend Lane operator/(Lane a, Lane b) { return a.v / b.v; }
    friend Lane operator-(Lane a) { return -a.v; }
    friend LaneMask<W> operator<(Lane a, Lane b) { return {a.v < b.v}; }
    friend LaneMask<W> operator<=(Lane a, Lane b) { return {a.v <= b.v}; }
    friend LaneMask<W> operator>(Lane a, Lane b) { return {a.v > b.v}; }
    friend LaneMask<W> operator>=(Lane a, Lane b) { return {a.v >= b.v}; }
    friend LaneMask<W> operator==(Lane a, Lane b) { return {a.v == b.v}; }
};

/// Trials in a Real.
template <class Real>
inline constexpr int lanes = static_cast<int>(sizeof(Real) / sizeof(double));

/// W trials at once; one of them is a plain double.
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
    return a.v * std::uint64_t{b};
}

template <int W>
LaneMask<W> both(LaneMask<W> a, LaneMask<W> b) { return {a.m & b.m}; }
template <int W>
LaneMask<W> either(LaneMask<W> a, LaneMask<W> b) { return {a.m | b.m}; }
template <int W>
LaneMask<W> negated(LaneMask<W> a) { return {~a.m}; }

template <int W>
bool any(LaneMask<W> mask) {
#if defined(__AVX512F__)
    if constexpr (W == 8) return _mm512_test_epi64_mask((__m512i)mask.m, (__m512i)mask.m) != 0;
#endif
#if defined(__AVX2__)
    if constexpr (W == 4) return _mm256_movemask_pd((__m256d)mask.m) != 0;
#endif
    std::int64_t all = 0;
    for (int i = 0; i < W; ++i) all |= mask.m[i];
    return all != 0;
}

template <int W>
Lane<W> select(LaneMask<W> mask, Lane<W> yes, Lane<W> no) {
    return mask.m ? yes.v : no.v;
}

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

}  // namespace CREDENCE_UNIT
}  // namespace credence
