#include <credence/detail/exact_sum.hpp>

#include "base/nan.hpp"

#include <cmath>

namespace credence {

namespace {

bool is_taken(double value) { return std::abs(value) < 1e300; }

}  // namespace

void ExactSum::add(double value) {
    if (!is_taken(value)) finite_ = false;
    if (!finite_) return;
    std::size_t kept = 0;
    for (const double part : expansion_) {
        // Knuth's two-sum: sum + error is value + part exactly.
        const double sum = value + part;
        const double virtual_part = sum - value;
        const double error = (value - (sum - virtual_part)) + (part - virtual_part);
        if (error != 0) expansion_[kept++] = error;
        value = sum;
    }
    expansion_.resize(kept);
    if (value != 0) expansion_.push_back(value);
}

void ExactSum::add(const ExactSum& other, int sign) {
    finite_ = finite_ && other.finite_;
    if (!finite_) return;
    const std::vector<double> parts = other.expansion_;  // a copy: other may be this
    for (const double part : parts) add(sign * part);
}

double ExactSum::rounded() const {
    if (!finite_) return nan;
    if (expansion_.empty()) return 0;
    // From the largest part down, until the parts below no longer change the sum.
    std::size_t i = expansion_.size() - 1;
    double sum = expansion_[i], error = 0;
    while (i > 0 && error == 0) {
        const double larger = sum, part = expansion_[--i];
        sum = larger + part;
        error = part - (sum - larger);
    }
    // A tie that the parts below break the other way.
    if (i > 0 && (error < 0) == (expansion_[i - 1] < 0)) {
        const double doubled = error * 2, other = sum + doubled;
        if (doubled == other - sum) sum = other;
    }
    return is_taken(sum) ? sum : nan;
}

std::vector<double> ExactSum::parts() const {
    std::vector<double> parts;
    ExactSum rest = *this;
    do {
        parts.push_back(rest.rounded());
        rest.add(-parts.back());
    } while (rest.finite_ && !rest.expansion_.empty());
    return parts;
}

ExactSum ExactSum::from_parts(const std::vector<double>& parts) {
    ExactSum sum;
    for (const double part : parts) sum.add(part);
    return sum;
}

}  // namespace credence
