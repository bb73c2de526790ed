#include "record/gaps.hpp"

#include <cmath>
#include <credence/statistics.hpp>

namespace credence {

void GapCounter::add(std::int64_t trial, int asked, const std::vector<std::size_t>& present,
                     const std::function<double(std::size_t)>& nees) {
    const std::int64_t missing = asked - std::ssize(present);
    gaps_.steps += asked;
    gaps_.missing += missing;
    if (missing == 0) return;
    ++gaps_.runs;
    if (missing > gaps_.of_trial) gaps_.trial = trial, gaps_.of_trial = missing;
    double sums[2] = {}, counts[2] = {};  // elsewhere, beside
    for (std::size_t i = 0, next = 0; i < present.size(); next = present[i++] + 1) {
        const std::size_t k = present[i];
        for (; next < k; ++next) ++gaps_.by_step[next];
        const bool after = i > 0 && present[i - 1] + 1 < k, before = i + 1 < present.size() && k + 1 < present[i + 1];
        if (std::isnan(nees(k))) continue;
        sums[after || before] += nees(k);
        ++counts[after || before];
    }
    if (counts[0] == 0 || counts[1] == 0) return;
    elsewhere_.push_back(sums[0] / counts[0]);
    beside_.push_back(sums[1] / counts[1]);
}

RecordGaps GapCounter::finish() {
    constexpr std::size_t least = 10;
    if (beside_.size() < least) return gaps_;
    std::vector<double> differences;
    for (std::size_t i = 0; i < beside_.size(); ++i) differences.push_back(beside_[i] - elsewhere_[i]);
    const Summary difference = summarise(std::move(differences));
    gaps_.beside = summarise(std::move(beside_)).mean;
    gaps_.elsewhere = summarise(std::move(elsewhere_)).mean;
    gaps_.difference = difference.mean / difference.standard_error;
    return gaps_;
}

}  // namespace credence
