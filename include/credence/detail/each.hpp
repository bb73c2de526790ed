#pragma once
// Module numeric: loops whose bounds may be known at compile time. Where both are known, as for three features, the
// loop is unrolled and every index in its body is a constant; otherwise it is a plain loop. The operations and their
// order are the same.

#include <credence/detail/real.hpp>

#include <type_traits>
#include <utility>

/// CREDENCE_FLAT inlines everything that a function calls, directly or not, so that unrolled code ends in one function.
/// Not in the project's tests, where it would take the compiler three times as long, nor under sanitizers, which would
/// instrument every instruction: they define CREDENCE_NOT_FLAT.
#ifdef CREDENCE_NOT_FLAT
#define CREDENCE_FLAT
#define CREDENCE_INLINE inline
#define CREDENCE_INLINE_LAMBDA
#else
#define CREDENCE_FLAT [[gnu::flatten]]
#define CREDENCE_INLINE [[gnu::always_inline]] inline
#define CREDENCE_INLINE_LAMBDA __attribute__((always_inline))
#endif

namespace credence {

/// A number that is known to the compiler; it converts to int.
template <int value>
using Known = std::integral_constant<int, value>;

inline constexpr Known<0> zero{};
inline constexpr Known<1> one{};
inline constexpr Known<2> two{};

inline namespace CREDENCE_TARGET {

template <int a, int b>
constexpr Known<a + b> operator+(Known<a>, Known<b>) { return {}; }
template <int a, int b>
constexpr Known<a - b> operator-(Known<a>, Known<b>) { return {}; }
template <int a, int b>
constexpr Known<a * b> operator*(Known<a>, Known<b>) { return {}; }

template <int a>
constexpr Known<a / 2> half(Known<a>) { return {}; }
constexpr int half(int a) { return a / 2; }

/// body(first), body(first + 1) ... body(last - 1)
template <class Body>
CREDENCE_INLINE void each(int first, int last, Body&& body) {
    for (int i = first; i < last; ++i) body(i);
}

template <int first, class Body, int... offset>
CREDENCE_INLINE void each_written_out(Body& body, std::integer_sequence<int, offset...>) {
    (body(Known<first + offset>{}), ...);
}

template <int first, int last, class Body>
CREDENCE_INLINE void each(Known<first>, Known<last>, Body&& body) {
    if constexpr (first < last) each_written_out<first>(body, std::make_integer_sequence<int, last - first>{});
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
