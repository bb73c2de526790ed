#pragma once
// Module numeric: log and sincos from additions, multiplications and fma alone, so that every machine, compiler and
// lane width gives the same bits. Errors are below 1.5 units in the last place on the given ranges
// (tests/numeric/elementary_test.cpp).

#include <credence/detail/real.hpp>

namespace credence {
inline namespace CREDENCE_TARGET {

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double log_two_pi = 1.83787706640934548356;

/// Natural logarithm of a normal positive number. Anything else gives a meaningless value, never a trap.
///
/// x = m 2^e with sqrt(1/2) <= m < sqrt(2); log m = 2 atanh(f), f = (m - 1)/(m + 1), by its series in s = f^2 <= 0.0295
/// (11 terms leave 1e-18 of it); e log 2 is added in two parts.
template <class Real>
Real log_of_normal(Real x) {
    constexpr double ln2_high = 6.93147180369123816490e-01;  // 32 bits, so that e ln2_high is exact
    constexpr double ln2_low = 1.90821492927058770002e-10;
    constexpr std::uint64_t half_root = 0x3fe6a09e667f3bcd;  // bits of sqrt(1/2)
    // Biased so that the exponent field steps at sqrt(1/2) instead of at 1.
    const Bits<Real> shifted = bits_of(x) - half_root;
    const Bits<Real> exponent_field = shifted & 0xfff0000000000000u;
    const Real m = from_bits(bits_of(x) - exponent_field);
    // The exponent as a number: arithmetic shift by 52, done unsigned around an offset of 2^11.
    const Bits<Real> offset_exponent = (exponent_field >> 52) ^ 0x800u;
    const Real e = from_bits(offset_exponent | 0x4330000000000000u) - Real(4503599627370496.0 + 2048.0);
    const Real f = (m - Real(1)) / (m + Real(1));
    const Real s = f * f;
    Real series = Real(1.0 / 23);
    for (int odd = 21; odd >= 3; odd -= 2) series = fma(series, s, Real(1.0 / odd));
    // log m = (m - 1) - f (m - 1 - 2 s series): the large part is exact.
    const Real large = m - Real(1);
    const Real small = fma(f, fma(Real(2) * s, series, -large), e * Real(ln2_low));
    return fma(e, Real(ln2_high), large + small);
}

/// A product of positive numbers of which each is normal, and of any size itself: its exponent is kept apart.
template <class Real>
class ScaledProduct {
public:
    ScaledProduct() = default;
    explicit ScaledProduct(Real number) : fraction_(number) {}

    void multiply(Real number) {
        constexpr std::uint64_t exponent_field = 0x7ff0000000000000u, bits_of_one = 0x3ff0000000000000u;
        const Bits<Real> bits = bits_of(fraction_), field = bits & exponent_field;
        exponent_ = exponent_ + ((field >> 52) - Bits<Real>(1023));
        fraction_ = from_bits(bits - field + Bits<Real>(bits_of_one)) * number;
    }
    void multiply(const ScaledProduct& by) {
        multiply(by.fraction_);
        exponent_ = exponent_ + by.exponent_;
    }

    /// Its natural logarithm.
    Real log() const {
        constexpr double ln2 = 0.693147180559945309417;
        const Real e = from_bits(exponent_ + bits_of(Real(integer_shifter))) - Real(integer_shifter);
        return fma(e, Real(ln2), log_of_normal(fraction_));
    }

private:
    Real fraction_ = Real(1);
    Bits<Real> exponent_ = Bits<Real>(0);  ///< a signed number
};

/// Lower bound on the square root of a normal positive number or 0: at most 0.2 % below it, never above. Cheaper than
/// sqrt where a bound is enough.
///
/// One step of Newton's iteration for 1/sqrt(x), whose result is never above 1/sqrt(x), from the well-known shift,
/// which is within 3.5 %.
template <class Real>
Real sqrt_from_below(Real x) {
    const Real y = from_bits(Bits<Real>(0x5fe6eb50c7b537a9u) - (bits_of(x) >> 1));
    const Real xy = x * y;
    return xy * fnma(Real(0.5) * xy, y, Real(1.5));
}

/// sin and cos of |r| <= pi/4 by their Taylor series (next terms below 1e-17), turned by `quadrant` quarter turns, of
/// which the two lowest bits count.
template <class Real>
Rotation<Real> rotation_in_quadrant(Real r, Bits<Real> quadrant) {
    const Real s = r * r;
    Real sine = Real(1.0 / 355687428096000);                       // 1/17!
    sine = fma(sine, s, Real(-1.0 / 1307674368000));
    sine = fma(sine, s, Real(1.0 / 6227020800));
    sine = fma(sine, s, Real(-1.0 / 39916800));
    sine = fma(sine, s, Real(1.0 / 362880));
    sine = fma(sine, s, Real(-1.0 / 5040));
    sine = fma(sine, s, Real(1.0 / 120));
    sine = fma(sine, s, Real(-1.0 / 6));
    sine = fma(sine * s, r, r);
    Real cosine = Real(1.0 / 20922789888000);                      // 1/16!
    cosine = fma(cosine, s, Real(-1.0 / 87178291200));
    cosine = fma(cosine, s, Real(1.0 / 479001600));
    cosine = fma(cosine, s, Real(-1.0 / 3628800));
    cosine = fma(cosine, s, Real(1.0 / 40320));
    cosine = fma(cosine, s, Real(-1.0 / 720));
    cosine = fma(cosine, s, Real(1.0 / 24));
    cosine = fma(cosine, s, Real(-0.5));
    cosine = fma(cosine, s, Real(1));
    constexpr std::uint64_t sign = 0x8000000000000000u;
    const Mask<Real> odd = (quadrant & 1u) != 0u;
    return {from_bits(bits_of(select(odd, sine, cosine)) ^ (((quadrant + 1u) << 62) & sign)),
            from_bits(bits_of(select(odd, cosine, sine)) ^ ((quadrant << 62) & sign))};
}

/// cos and sin of an angle in radians. Full accuracy for |angle| < 2^30; beyond 2^51 the value is meaningless but the
/// same everywhere; NaN and infinities give NaN.
template <class Real>
Rotation<Real> rotation(Real angle) {
    constexpr double half_pi_high = 1.57079632679489655800;
    constexpr double half_pi_middle = 6.12323399573676603587e-17;
    constexpr double half_pi_low = -1.49738490485919837e-33;
    const Real shifted = fma(angle, Real(2 / pi), Real(integer_shifter));
    const Real quarters = shifted - Real(integer_shifter);
    Real r = fnma(quarters, Real(half_pi_high), angle);
    r = fnma(quarters, Real(half_pi_middle), r);
    r = fnma(quarters, Real(half_pi_low), r);
    return rotation_in_quadrant(r, bits_of(shifted));
}

/// cos and sin of 2 pi `turns`, turns in [0, 1).
template <class Real>
Rotation<Real> rotation_of_turns(Real turns) {
    const Real quarters = Real(4) * turns;
    const Real shifted = quarters + Real(integer_shifter);
    const Real rest = quarters - (shifted - Real(integer_shifter));
    return rotation_in_quadrant(rest * Real(pi / 2), bits_of(shifted));
}

/// A heading difference brought to [-pi, pi].
template <class Real>
Real wrapped(Real angle) {
    const Real turns = fma(angle, Real(1 / (2 * pi)), Real(integer_shifter)) - Real(integer_shifter);
    return fnma(turns, Real(2.44929359829470641435e-16), fnma(turns, Real(2 * pi), angle));
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
