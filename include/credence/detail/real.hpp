#pragma once
// Module numeric: the scalar type of the equations.
//
// World, sensor, filter and controller are templates on `Real`. With `double` they run one trial; with a pack of
// doubles several trials at once. The equations therefore never branch on a Real: they compare to a mask and select.
//
// Everything that a target of the engine inlines is in `inline namespace CREDENCE_TARGET`: each instruction set
// compiles its own copy under its own name, so that the linker can never combine code for different machines.

#include <cstdint>

#ifndef CREDENCE_TARGET
#define CREDENCE_TARGET portable
#endif

namespace credence {
inline namespace CREDENCE_TARGET {

/// The comparison result of a Real: one bool per lane.
template <class Real>
using Mask = decltype(Real() < Real());

/// The bits of a Real as unsigned 64-bit integers, one per lane.
template <class Real>
struct BitsOf;
template <>
struct BitsOf<double> {
    using type = std::uint64_t;
};
template <class Real>
using Bits = typename BitsOf<Real>::type;

inline std::uint64_t bits_of(double x) { return __builtin_bit_cast(std::uint64_t, x); }
inline double from_bits(std::uint64_t bits) { return __builtin_bit_cast(double, bits); }

/// a b + c, rounded once.
inline double fma(double a, double b, double c) { return __builtin_fma(a, b, c); }
/// c - a b, rounded once.
inline double fnma(double a, double b, double c) { return __builtin_fma(-a, b, c); }
inline double sqrt(double x) { return __builtin_sqrt(x); }
/// A mask that is true in every lane.
template <class Real>
Mask<Real> all_lanes() {
    return Real(0) == Real(0);
}
/// The low 32 bits of a, times b: all 64 bits of the product.
inline std::uint64_t widening_product(std::uint64_t a, std::uint32_t b) {
    return std::uint64_t{static_cast<std::uint32_t>(a)} * b;
}
inline std::uint64_t exclusive_or(std::uint64_t a, std::uint64_t b, std::uint64_t c) { return a ^ b ^ c; }
inline double select(bool mask, double yes, double no) { return mask ? yes : no; }
inline bool any(bool mask) { return mask; }
inline bool all(bool mask) { return mask; }
inline bool both(bool a, bool b) { return a && b; }
inline bool either(bool a, bool b) { return a || b; }
inline bool negated(bool mask) { return !mask; }
/// True where x is neither infinite nor NaN.
inline bool finite(double x) { return x - x == 0.0; }
/// low <= x <= high, of numbers that are not negative.
inline bool within(double x, double low, double high) { return low <= x && x <= high; }
inline double absolute(double x) { return __builtin_fabs(x); }

/// The same object, whose values the compiler must read again: values of large arrays that it kept would not fit into
/// the registers, and would be spilled to the stack.
template <class T>
T& read_anew(T& object) {
    T* place = &object;
    asm("" : "+r"(place));
    return *place;
}

/// Added to |x| < 2^51 and taken away again, it rounds x to the nearest integer, ties to even; while it is added, the
/// low bits of the sum are those of the integer.
inline constexpr double integer_shifter = 6755399441055744.0;  // 1.5 * 2^52

/// A vector of the plane. Like a Real, it is not initialised: arrays of vectors that were set to zero first would be
/// kept in memory, not in registers.
template <class Real>
struct Vector2 {
    Real x, y;
};

template <class Real>
Vector2<Real> operator+(const Vector2<Real>& a, const Vector2<Real>& b) {
    return {a.x + b.x, a.y + b.y};
}
template <class Real>
Vector2<Real> operator-(const Vector2<Real>& a, const Vector2<Real>& b) {
    return {a.x - b.x, a.y - b.y};
}

template <class Real>
Vector2<Real> scaled(Real s, const Vector2<Real>& a) {
    return {s * a.x, s * a.y};
}

/// a + s b, each component rounded once.
template <class Real>
Vector2<Real> add_scaled(const Vector2<Real>& a, Real s, const Vector2<Real>& b) {
    return {fma(s, b.x, a.x), fma(s, b.y, a.y)};
}

template <class Real>
Real squared_norm(const Vector2<Real>& a) {
    return fma(a.x, a.x, a.y * a.y);
}

/// cos and sin of a heading: R(theta) = [cos, -sin; sin, cos].
template <class Real>
struct Rotation {
    Real cosine{}, sine{};
};

/// R a: from the body frame to the world frame.
template <class Real>
Vector2<Real> rotate(const Rotation<Real>& r, const Vector2<Real>& a) {
    return {fnma(r.sine, a.y, r.cosine * a.x), fma(r.sine, a.x, r.cosine * a.y)};
}

/// R' a: from the world frame to the body frame.
template <class Real>
Vector2<Real> rotate_back(const Rotation<Real>& r, const Vector2<Real>& a) {
    return {fma(r.sine, a.y, r.cosine * a.x), fnma(r.sine, a.x, r.cosine * a.y)};
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
