#pragma once
// Values computed elsewhere: tests/reference/statistics.json, made by make_statistics.py with NumPy and SciPy.

#include <cmath>
#include <credence/statistics.hpp>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "catch.hpp"

namespace credence::test {

using Json = nlohmann::json;

inline const Json& reference(const char* part) {
    static const Json values = Json::parse(std::ifstream(CREDENCE_SOURCE "/tests/reference/statistics.json"));
    return values.at(part);
}

/// A number; null is NaN.
inline double number(const Json& value) {
    return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

inline std::vector<double> numbers(const Json& values) {
    std::vector<double> result;
    for (const Json& value : values) result.push_back(number(value));
    return result;
}

/// Agreement to the 1e-9 that docs/statistics.md asks for, relative; 0 must be 0, and NaN NaN.
inline void check_agrees(double value, double expected, double tolerance = 1e-9) {
    CAPTURE(value, expected);
    CHECK(
        ((std::isnan(value) && std::isnan(expected)) || std::abs(value - expected) <= tolerance * std::abs(expected)));
}

inline void check_agrees(const Interval& value, const Json& expected, double tolerance = 1e-9) {
    check_agrees(value.low, number(expected[0]), tolerance);
    check_agrees(value.high, number(expected[1]), tolerance);
}

}  // namespace credence::test
