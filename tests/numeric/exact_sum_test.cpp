// Exact sums, against a big integer.

#include "catch.hpp"

#include <credence/detail/exact_sum.hpp>
#include <credence/detail/real.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace credence::test::exact_sum_test {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// A whole number of 2^-1074 in digits of 2^32, the plainest way to add doubles without rounding.
class BigSum {
public:
    void add(double value) {
        int exponent = 0;
        const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
        const int shift = std::max(exponent - 53 + 1074, 0);
        // Numbers below the normal ones have fewer bits and come out with the right shift taken back.
        const std::int64_t whole = exponent - 53 + 1074 < 0 ? mantissa >> (-(exponent - 53 + 1074)) : mantissa;
        const __int128 wide = static_cast<__int128>(whole) * (std::int64_t{1} << (shift % 32));
        const std::size_t digit = static_cast<std::size_t>(shift / 32);
        for (std::size_t i = 0; i < 3; ++i) digits_[digit + i] += static_cast<std::int64_t>((wide >> (32 * i)) & low);
        digits_[digit + 2] += (wide < 0 ? -1 : 0) * (std::int64_t{1} << 32);
        carry();
    }

    /// Rounded to nearest, ties to even.
    double rounded() const {
        const bool negative = digits_.back() < 0;
        BigSum size = *this;
        if (negative)
            for (std::int64_t& digit : size.digits_) digit = -digit;
        size.carry();
        int highest = static_cast<int>(32 * digits_.size()) - 1;
        while (highest >= 0 && !size.bit(highest)) --highest;
        if (highest < 0) return 0;
        const int lowest = std::max(highest - 52, 0);
        std::uint64_t mantissa = 0;
        for (int i = highest; i >= lowest; --i) mantissa = 2 * mantissa + size.bit(i);
        bool sticky = false;
        for (int i = 0; i < lowest - 1; ++i) sticky = sticky || size.bit(i);
        if (lowest > 0 && size.bit(lowest - 1) && (sticky || mantissa % 2)) ++mantissa;
        const double result = std::ldexp(static_cast<double>(mantissa), lowest - 1074);
        return negative ? -result : result;
    }

private:
    static constexpr std::int64_t low = 0xffffffff;

    bool bit(int i) const { return digits_[static_cast<std::size_t>(i / 32)] >> (i % 32) & 1; }

    /// Brings all digits but the last to 0 ... 2^32 - 1.
    void carry() {
        for (std::size_t i = 0; i + 1 < digits_.size(); ++i) {
            const std::int64_t over = digits_[i] >> 32;
            digits_[i] -= over * (std::int64_t{1} << 32);
            digits_[i + 1] += over;
        }
    }

    std::array<std::int64_t, 70> digits_{};
};

/// Values of all sizes below 1e300, of both signs, with repeats and near-cancellations.
std::vector<double> nasty_values(std::mt19937_64& random, int count) {
    std::vector<double> values;
    const int spread = std::array{10, 60, 300, 1900}[random() % 4];
    while (static_cast<int>(values.size()) < count) {
        const int exponent = static_cast<int>(random() % static_cast<unsigned>(spread)) - spread / 2;
        const double value = std::ldexp(static_cast<double>(random() >> 11) * 0x1p-53, exponent);
        values.push_back(random() % 2 ? value : -value);
        if (random() % 4 == 0) values.push_back(-values[random() % values.size()]);
        if (random() % 16 == 0) values.push_back(from_bits(random() >> 12));  // below the normal numbers
        if (random() % 8 == 0) values.push_back(std::nextafter(-values.back(), infinity));
    }
    return values;
}

ExactSum sum_of(const std::vector<double>& values) {
    ExactSum sum;
    for (const double value : values) sum.add(value);
    return sum;
}

double big_sum(const std::vector<double>& values) {
    BigSum sum;
    for (const double value : values) sum.add(value);
    return sum.rounded();
}

}  // namespace

TEST_CASE("exact sum: rounds the exact sum once, whatever the values") {
    std::mt19937_64 random(1);
    for (int i = 0; i < 3000; ++i) {
        const std::vector<double> values = nasty_values(random, 1 + static_cast<int>(random() % 40));
        REQUIRE(sum_of(values).rounded() == big_sum(values));
    }
}

TEST_CASE("exact sum: the order does not matter, to the last part") {
    std::mt19937_64 random(2);
    for (int i = 0; i < 300; ++i) {
        std::vector<double> values = nasty_values(random, 30);
        const std::vector<double> parts = sum_of(values).parts();
        for (int shuffled = 0; shuffled < 10; ++shuffled) {
            std::shuffle(values.begin(), values.end(), random);
            REQUIRE(sum_of(values).parts() == parts);
        }
    }
}

TEST_CASE("exact sum: parts add up to the sum, go from large to small and read back") {
    std::mt19937_64 random(3);
    for (int i = 0; i < 300; ++i) {
        const std::vector<double> values = nasty_values(random, 30);
        const std::vector<double> parts = sum_of(values).parts();
        REQUIRE(parts.front() == big_sum(values));
        for (std::size_t p = 1; p < parts.size(); ++p)  // what rounding leaves is at most half an ulp
            REQUIRE(std::abs(parts[p]) <= std::abs(parts[p - 1]) * 0x1p-53);
        std::vector<double> rest = values;
        for (const double part : parts) rest.push_back(-part);
        REQUIRE(big_sum(rest) == 0);
        REQUIRE(ExactSum::from_parts(parts).parts() == parts);
    }
}

TEST_CASE("exact sum: sums of sums are the sum of all") {
    std::mt19937_64 random(4);
    const std::vector<double> a = nasty_values(random, 50), b = nasty_values(random, 50);
    std::vector<double> both = a;
    both.insert(both.end(), b.begin(), b.end());
    ExactSum sum = sum_of(a);
    sum.add(sum_of(b));
    CHECK(sum.parts() == sum_of(both).parts());
    ExactSum twice = sum_of(a);
    twice.add(twice);
    CHECK(twice.rounded() == 2 * sum_of(a).rounded());
}

TEST_CASE("exact sum: what was added can be taken back") {
    std::mt19937_64 random(5);
    for (int i = 0; i < 100; ++i) {
        const std::vector<double> first = nasty_values(random, 20), second = nasty_values(random, 20);
        ExactSum sum = sum_of(first);
        for (const double value : second) sum.add(value);
        for (const double value : second) sum.add(-value);
        REQUIRE(sum.parts() == sum_of(first).parts());
        for (const double value : first) sum.add(-value);
        REQUIRE(sum.parts() == std::vector<double>{0});
    }
}

TEST_CASE("exact sum: ties go to even, unless something small decides them") {
    const double half = 0x1p-53;
    CHECK(sum_of({1, half}).rounded() == 1);
    CHECK(sum_of({1, half, 0x1p-1074}).rounded() == 1 + 0x1p-52);
    CHECK(sum_of({1, half, -0x1p-1074}).rounded() == 1);
    CHECK(sum_of({1 + 0x1p-52, half}).rounded() == 1 + 0x1p-51);
    CHECK(sum_of({1 + 0x1p-52, half, -0x1p-1000}).rounded() == 1 + 0x1p-52);
    CHECK(sum_of({-1, -half, -0x1p-1000}).rounded() == -1 - 0x1p-52);
    CHECK(sum_of({0x1p53, 1, 1}).rounded() == 0x1p53 + 2);
    CHECK(sum_of({1e100, 1, -1e100}).rounded() == 1);
    CHECK(sum_of({1e16, 1, 1e-16}).rounded() == 10000000000000002);  // a known case of Python's fsum
}

TEST_CASE("exact sum: of nothing and of zeros is 0") {
    CHECK(bits_of(ExactSum().rounded()) == bits_of(0.0));
    CHECK(ExactSum().parts() == std::vector<double>{0});
    CHECK(bits_of(sum_of({-0.0, 0.0, -0.0}).rounded()) == bits_of(0.0));
}

TEST_CASE("exact sum: what is not finite or too large makes it NaN for good") {
    for (const double bad : {infinity, -infinity, not_a_number, 1e300, -2e300}) {
        ExactSum sum = sum_of({1, bad});
        sum.add(-bad);
        sum.add(2);
        CHECK(std::isnan(sum.rounded()));
        CHECK(sum.parts().size() == 1);
        CHECK(std::isnan(sum.parts().front()));
        ExactSum other = sum_of({3});
        other.add(sum);
        CHECK(std::isnan(other.rounded()));
        CHECK(std::isnan(ExactSum::from_parts(sum.parts()).rounded()));
    }
    CHECK(sum_of({9e299, -9e299, 1}).rounded() == 1);
}

TEST_CASE("exact sum: a total beyond the limit of its values is NaN, and has one part") {
    for (const int count : {2, 1000}) {
        ExactSum sum = sum_of(std::vector<double>(static_cast<std::size_t>(count), 9e299));
        CHECK(std::isnan(sum.rounded()));
        CHECK(sum.parts().size() == 1);
        CHECK(std::isnan(sum.parts().front()));
        for (int i = 1; i < count; ++i) sum.add(-9e299);
        CHECK(sum.parts() == std::vector<double>{9e299});
    }
}

}  // namespace credence::test::exact_sum_test
