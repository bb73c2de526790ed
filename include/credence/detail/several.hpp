#pragma once
// Module numeric: N numbers that take every step together. Several<Real, N> is itself a Real, as far as elementary.hpp
// and draws.hpp need it: the steps of one logarithm depend on each other, and a processor finds independent
// instructions only within a few dozen. Part i gives the same bits as a Real.

#include <credence/detail/each.hpp>

namespace credence {
inline namespace CREDENCE_TARGET {

/// N reals, N packs of bits or N masks.
template <class T, int N>
struct Several {
    T part[N];

    Several() = default;
    /// The same number in all parts.
    template <class Number>
    explicit Several(Number number) {
        each(zero, Known<N>{}, [&](auto i) { part[i] = T(number); });
    }
};

/// f applied part by part.
template <int N, class F>
CREDENCE_INLINE auto by_part(const F& f) {
    Several<decltype(f(0)), N> result;
    each(zero, Known<N>{}, [&](auto i) CREDENCE_INLINE_LAMBDA { result.part[i] = f(i); });
    return result;
}

template <class Real, int N>
struct BitsOf<Several<Real, N>> {
    using type = Several<Bits<Real>, N>;
};

#define CREDENCE_BY_PART(expression) return by_part<N>([&](int i) CREDENCE_INLINE_LAMBDA { return expression; })

template <class T, int N>
Several<T, N> operator+(const Several<T, N>& a, const Several<T, N>& b) { CREDENCE_BY_PART(a.part[i] + b.part[i]); }
template <class T, int N>
Several<T, N> operator-(const Several<T, N>& a, const Several<T, N>& b) { CREDENCE_BY_PART(a.part[i] - b.part[i]); }
template <class T, int N>
Several<T, N> operator*(const Several<T, N>& a, const Several<T, N>& b) { CREDENCE_BY_PART(a.part[i] * b.part[i]); }
template <class T, int N>
Several<T, N> operator/(const Several<T, N>& a, const Several<T, N>& b) { CREDENCE_BY_PART(a.part[i] / b.part[i]); }
template <class T, int N>
Several<T, N> operator-(const Several<T, N>& a) { CREDENCE_BY_PART(-a.part[i]); }
template <class T, int N>
Several<T, N> operator|(const Several<T, N>& a, const Several<T, N>& b) { CREDENCE_BY_PART(a.part[i] | b.part[i]); }
template <class T, int N>
Several<T, N> operator^(const Several<T, N>& a, const Several<T, N>& b) { CREDENCE_BY_PART(a.part[i] ^ b.part[i]); }
template <class T, int N>
Several<T, N> operator+(const Several<T, N>& a, std::uint64_t b) { CREDENCE_BY_PART(a.part[i] + b); }
template <class T, int N>
Several<T, N> operator-(const Several<T, N>& a, std::uint64_t b) { CREDENCE_BY_PART(a.part[i] - b); }
template <class T, int N>
Several<T, N> operator&(const Several<T, N>& a, std::uint64_t b) { CREDENCE_BY_PART(a.part[i] & b); }
template <class T, int N>
Several<T, N> operator|(const Several<T, N>& a, std::uint64_t b) { CREDENCE_BY_PART(a.part[i] | b); }
template <class T, int N>
Several<T, N> operator^(const Several<T, N>& a, std::uint64_t b) { CREDENCE_BY_PART(a.part[i] ^ b); }
template <class T, int N>
Several<T, N> operator<<(const Several<T, N>& a, int n) { CREDENCE_BY_PART(a.part[i] << n); }
template <class T, int N>
Several<T, N> operator>>(const Several<T, N>& a, int n) { CREDENCE_BY_PART(a.part[i] >> n); }
template <class T, int N>
auto operator!=(const Several<T, N>& a, std::uint64_t b) { CREDENCE_BY_PART(a.part[i] != b); }
template <class T, int N>
auto operator<(const Several<T, N>& a, const Several<T, N>& b) { CREDENCE_BY_PART(a.part[i] < b.part[i]); }

template <class T, int N>
auto bits_of(const Several<T, N>& a) { CREDENCE_BY_PART(bits_of(a.part[i])); }
template <class T, int N>
auto from_bits(const Several<T, N>& a) { CREDENCE_BY_PART(from_bits(a.part[i])); }
template <class T, int N>
Several<T, N> sqrt(const Several<T, N>& a) { CREDENCE_BY_PART(sqrt(a.part[i])); }
template <class T, int N>
Several<T, N> fma(const Several<T, N>& a, const Several<T, N>& b, const Several<T, N>& c) {
    CREDENCE_BY_PART(fma(a.part[i], b.part[i], c.part[i]));
}
template <class T, int N>
Several<T, N> fnma(const Several<T, N>& a, const Several<T, N>& b, const Several<T, N>& c) {
    CREDENCE_BY_PART(fnma(a.part[i], b.part[i], c.part[i]));
}
template <class M, class T, int N>
Several<T, N> select(const Several<M, N>& mask, const Several<T, N>& yes, const Several<T, N>& no) {
    CREDENCE_BY_PART(select(mask.part[i], yes.part[i], no.part[i]));
}
template <class T, int N>
Several<T, N> widening_product(const Several<T, N>& a, std::uint32_t b) {
    CREDENCE_BY_PART(widening_product(a.part[i], b));
}
template <class T, int N>
Several<T, N> exclusive_or(const Several<T, N>& a, const Several<T, N>& b, const Several<T, N>& c) {
    CREDENCE_BY_PART(exclusive_or(a.part[i], b.part[i], c.part[i]));
}

#undef CREDENCE_BY_PART

}  // namespace CREDENCE_TARGET
}  // namespace credence
