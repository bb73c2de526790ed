// Numbers in reports: as many digits as their uncertainty asks for.

#include "report/format.hpp"

#include <cmath>

#include "catch.hpp"
#include "report/table.hpp"

namespace credence::test::format_test {

TEST_CASE("format: a half-width has two significant digits, however small, and its mean as many decimals") {
    CHECK(with_interval(1.25, {1, 1.5}) == "1.25 ± 0.25");
    CHECK(with_interval(123.456, {111.1, 135.8}) == "123 ± 12");
    CHECK(with_interval(0.0205, {0.0205 - 2.34e-7, 0.0205 + 2.34e-7}) == "0.02050000 ± 2.3e-07");
    CHECK(with_interval(3e-9, {3e-9 - 2.3e-11, 3e-9 + 2.3e-11}) == "3.000e-09 ± 2.3e-11");
    CHECK(mean_cell(3e-9, {3e-9 - 2.3e-11, 3e-9 + 2.3e-11}).text() == "3.000e-09 ± 2.3e-11");
    CHECK(with_interval(0.5, {0.5 - 1e-300, 0.5 + 1e-300}) == "0.5000 ± 0");  // the sum is 0.5 again
}

TEST_CASE("format: what does not vary has four significant digits at least and the half-width 0") {
    CHECK(with_interval(0.0205, {0.0205, 0.0205}) == "0.02050 ± 0");
    CHECK(with_interval(4.0123456e-8, {4.0123456e-8, 4.0123456e-8}) == "4.012e-08 ± 0");
    CHECK(with_interval(1234.5678, {1234.5678, 1234.5678}) == "1234.5678 ± 0");
    CHECK(with_interval(0, {0, 0}) == "0.0000 ± 0");
    CHECK(with_interval(4.0123456e-8, {NAN, NAN}) == "4.012e-08");
    CHECK(with_interval(0.25, {NAN, NAN}) == "0.2500");
}

}  // namespace credence::test::format_test
