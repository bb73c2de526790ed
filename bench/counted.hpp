#pragma once
// A Real that counts its operations: + - * / sqrt as one operation, fma as two. Comparing, selecting, changing a sign
// and all operations on bits (the generator's) are not counted.

#include <credence/detail/draws.hpp>

namespace credence {
inline namespace CREDENCE_TARGET {

struct Counted {
    double value = 0;
    static inline std::uint64_t operations = 0;

    Counted() = default;
    Counted(double x) : value(x) {}

    friend Counted operator+(Counted a, Counted b) { return counted(1, a.value + b.value); }
    friend Counted operator-(Counted a, Counted b) { return counted(1, a.value - b.value); }
    friend Counted operator*(Counted a, Counted b) { return counted(1, a.value * b.value); }
    friend Counted operator/(Counted a, Counted b) { return counted(1, a.value / b.value); }
    friend Counted operator-(Counted a) { return -a.value; }
    friend bool operator<(Counted a, Counted b) { return a.value < b.value; }
    friend bool operator<=(Counted a, Counted b) { return a.value <= b.value; }
    friend bool operator>(Counted a, Counted b) { return a.value > b.value; }
    friend bool operator>=(Counted a, Counted b) { return a.value >= b.value; }
    friend bool operator==(Counted a, Counted b) { return a.value == b.value; }

    friend Counted fma(Counted a, Counted b, Counted c) { return counted(2, fma(a.value, b.value, c.value)); }
    friend Counted fnma(Counted a, Counted b, Counted c) { return counted(2, fnma(a.value, b.value, c.value)); }
    friend Counted sqrt(Counted x) { return counted(1, sqrt(x.value)); }
    friend Counted absolute(Counted x) { return absolute(x.value); }
    friend bool within(Counted x, Counted low, Counted high) { return within(x.value, low.value, high.value); }
    friend bool finite(Counted x) { return finite(x.value); }
    friend Counted select(bool mask, Counted yes, Counted no) { return mask ? yes : no; }
    friend std::uint64_t bits_of(Counted x) { return bits_of(x.value); }
    friend double lane_of(Counted x, int) { return x.value; }
    friend void set_lane(Counted& x, int, double value) { x.value = value; }

private:
    static Counted counted(std::uint64_t number, double result) {
        operations += number;
        return result;
    }
};

/// from_bits gives a double, which becomes a Counted.
template <>
struct BitsOf<Counted> {
    using type = std::uint64_t;
};

/// A scalar of filters' equations (functions.hpp).
constexpr bool is_pack(const Counted*) { return true; }

/// One after the other: from_bits gives doubles, which Several would not convert to Counted.
template <int count>
void draw_several(const KeyedDraws<Counted>& noise, const DrawKey* keys, Vector2<Counted>* draws) {
    for (int i = 0; i < count; ++i) draws[i] = noise.normal(keys[i].source, keys[i].pose, keys[i].index);
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
