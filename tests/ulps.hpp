#pragma once
// How far a double is from the number that it should be.

#include <algorithm>
#include <cmath>

/// |value - exact| in ulp of a double of that size; in units of 2^-1074 below the normal numbers.
inline double ulps(double value, long double exact) {
    int exponent = 0;
    std::frexp(exact, &exponent);
    const long double ulp = std::ldexp(1.0L, std::max(exponent - 53, -1074));
    return static_cast<double>(std::abs(static_cast<long double>(value) - exact) / ulp);
}
