#include "record/runs.hpp"

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

std::optional<std::int64_t> CopyFinder::end_trial(std::int64_t trial) {
    constexpr std::size_t most = 1 << 18;  // runs that are remembered; together some 50 MB
    if (count_ < 2) return std::nullopt;
    if (const auto found = runs_.find(now_); found != runs_.end()) {
        ++copies_;
        return found->second;
    }
    if (runs_.size() == most) return std::nullopt;
    runs_.emplace(now_, trial);
    for (std::size_t i = 0; i < 2; ++i)
        if (!parts_[i].insert(now_[i]).second) chance_[i] = true;
    return std::nullopt;
}

std::string CopyFinder::note(std::int64_t trials) const {
    return "Only " + std::to_string(trials - copies_) + " of the " + std::to_string(trials) +
           " runs are distinct: " + std::to_string(copies_) +
           " have the errors of another one, to the last bit. A copy is not independent and counts as failed: give "
           "each run once, and draw the random numbers of each anew.";
}

}  // namespace credence
