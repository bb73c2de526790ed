#pragma once
// Synthetic values for tests that calibrate a statistic: independent standard-normal draws, one after the other, and
// what is made of them. Fixed seeds; a false-alarm rate is what another seed would have.

#include <cmath>
#include <credence/detail/draws.hpp>
#include <cstdint>
#include <limits>
#include <vector>

namespace credence::test {

/// The draws of a seed, in order.
class Normals {
public:
    explicit Normals(std::uint64_t seed) : seed_(seed) {}

    double operator()() {
        if (has_other_) return has_other_ = false, pair_.y;
        pair_ = KeyedDraws<double>(seed_, trial_++, std::numeric_limits<double>::infinity()).normal(Source::walk, 0, 0);
        has_other_ = true;
        return pair_.x;
    }

    double chi_square(int degrees) {
        double sum = 0;
        for (int i = 0; i < degrees; ++i) {
            const double x = (*this)();
            sum += x * x;
        }
        return sum;
    }

private:
    std::uint64_t seed_, trial_ = 0;
    Vector2<double> pair_{0, 0};
    bool has_other_ = false;
};

/// Asserts that `hits` of `replications` lie within four standard deviations of the expected share p; a binomial count
/// is beyond with 6e-5 (where p is not near 0 or 1).
inline bool within_binomial(int hits, int replications, double p) {
    return std::abs(hits - replications * p) < 4 * std::sqrt(replications * p * (1 - p));
}

}  // namespace credence::test
