#pragma once
// Module numeric: the functions of a filter's equations, for a double and for a pack, whose lanes get the same bits.
// Unlike those of elementary.hpp, on which they rest, they take any number and give what <cmath> does for zeros,
// infinities and NaN. Their errors are below 2.5 units in the last place (tests/numeric/functions_test.cpp).

#include <credence/detail/elementary.hpp>
#include <credence/detail/lane.hpp>

namespace credence {
inline namespace CREDENCE_TARGET {

template <int W>
constexpr bool is_pack(const Lane<W>*) { return true; }
constexpr bool is_pack(const void*) { return false; }

/// The scalar of a filter's equations: one trial's number, or a number of each lane's trial.
template <class T>
concept RealNumber = std::same_as<T, double> || is_pack(static_cast<const T*>(nullptr));

// min and max give the first where neither is beyond the other, as in <algorithm>.
inline double min(double a, double b) { return b < a ? b : a; }
inline double max(double a, double b) { return a < b ? b : a; }
template <int W>
Lane<W> min(Lane<W> a, Lane<W> b) { return select(b < a, b, a); }
template <int W>
Lane<W> max(Lane<W> a, Lane<W> b) { return select(a < b, b, a); }
inline double abs(double x) { return absolute(x); }
template <int W>
Lane<W> abs(Lane<W> x) { return absolute(x); }

/// Select where one side is a number, the same in all lanes.
template <int W, class Number>
    requires std::is_arithmetic_v<Number>
Lane<W> select(LaneMask<W> mask, Lane<W> yes, Number no) { return select(mask, yes, Lane<W>(no)); }
template <int W, class Number>
    requires std::is_arithmetic_v<Number>
Lane<W> select(LaneMask<W> mask, Number yes, Lane<W> no) { return select(mask, Lane<W>(yes), no); }

/// Angles in radians; full accuracy below 2^30.
template <RealNumber Real>
Real sin(Real angle) { return rotation(angle).sine; }
template <RealNumber Real>
Real cos(Real angle) { return rotation(angle).cosine; }

/// Natural logarithm.
template <RealNumber Real>
Real log(Real x) {
    constexpr double smallest_normal = 0x1p-1022;
    const Mask<Real> tiny = x < Real(smallest_normal);  // scaled into the normal numbers, as are 0 and what is below
    const Real scale = select(tiny, Real(54 * 0.693147180559945309417), Real(0));
    const Real value = log_of_normal(select(tiny, x * Real(0x1p54), x)) - scale;
    const Real special = select(x == Real(0), Real(-__builtin_inf()), select(x > Real(0), x, Real(__builtin_nan(""))));
    return select(both(x > Real(0), x < Real(__builtin_inf())), value, special);
}

/// e^x = 2^k e^r, |r| <= log(2)/2, e^r by its Taylor series (the next term is below 1e-17).
template <RealNumber Real>
Real exp(Real x) {
    constexpr double beyond = 800;  // from where on all is infinity or 0
    const Real inside = select(x > Real(beyond), Real(beyond), select(x < Real(-beyond), Real(-beyond), x));
    const Real shifted = fma(inside, Real(1.44269504088896340736), Real(integer_shifter));
    const Real k = shifted - Real(integer_shifter);
    Real r = fnma(k, Real(6.93147180559945286227e-01), inside);
    r = fnma(k, Real(2.31904681384629955842e-17), r);
    constexpr double factorials[] = {6227020800, 479001600, 39916800, 3628800, 362880, 40320, 5040, 720, 120, 24, 6, 2};
    Real series = Real(1 / factorials[0]);
    for (int i = 1; i < 12; ++i) series = fma(series, r, Real(1 / factorials[i]));
    const Real power = fma(r * r, series, r) + Real(1);
    // 2^k in two factors, as the exponent field has no room for all k. The offset keeps the integers positive.
    constexpr std::uint64_t shifter_bits = 0x4338000000000000u, offset = 2048;
    const Bits<Real> biased = bits_of(shifted) - shifter_bits + offset, first = biased >> 1, second = biased - first;
    return power * from_bits((first - 1u) << 52) * from_bits((second - 1u) << 52);
}

/// Angle of the point (x, y), -pi to pi. Both below 1e307 in size.
///
/// atan of the smaller over the larger, taken about 1 where it is above tan(pi/8), by its series: the rest of the way
/// is a number of eighths of a turn.
template <RealNumber Real>
Real atan2(Real y, Real x) {
    constexpr std::uint64_t sign = 0x8000000000000000u;
    constexpr double eighth = 0.785398163397448309616, rest_of_eighth = 3.06161699786838301793e-17;
    const Real size_x = absolute(x), size_y = absolute(y);
    const Mask<Real> steep = size_y > size_x;
    Real larger = select(steep, size_y, size_x), smaller = select(steep, size_x, size_y);
    const Mask<Real> infinite = larger == Real(__builtin_inf());
    smaller = select(infinite, select(smaller == larger, Real(1), select(smaller < larger, Real(0), smaller)), smaller);
    larger = select(either(infinite, larger == Real(0)), Real(1), larger);
    const Mask<Real> about_one = smaller > Real(0.414213562373095048802) * larger;
    const Real t = select(about_one, smaller - larger, smaller) / select(about_one, smaller + larger, larger);
    const Real s = t * t;
    Real series = Real(1.0 / 41);
    for (int odd = 39; odd >= 3; odd -= 2) series = fnma(series, s, Real(1.0 / odd));
    const Real angle = fnma(series * s, t, t);
    // Eighths of a turn e, and which way the angle counts from there: mirrored for steep, and again for x below 0.
    const Mask<Real> back = (bits_of(x) & sign) != 0u;
    Real e = select(about_one, Real(1), Real(0));
    e = select(steep, Real(2) - e, e);
    e = select(back, Real(4) - e, e);
    const Real way = select(steep, Real(-1), Real(1)) * select(back, Real(-1), Real(1));
    const Real turned = e * Real(eighth), lost = fma(e, Real(eighth), -turned);
    const Real size = turned + fma(way, angle, fma(e, Real(rest_of_eighth), lost));
    return from_bits(bits_of(size) | (bits_of(y) & sign));
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
