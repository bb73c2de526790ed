#include "record/copies.hpp"

namespace credence {

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
