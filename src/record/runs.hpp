#pragma once
// What is noticed of the runs of a record: steps that are missing within them, and runs that are copies of others.

#include <credence/record.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace credence {

/// Counts the steps that the trials of a record lack, and compares NEES beside gaps with that elsewhere: errors that
/// were left out because they were large leave large ones beside them.
class GapCounter {
public:
    explicit GapCounter(std::size_t steps) { gaps_.by_step.resize(steps); }

    /// A trial of `asked` steps that did not fail; `present` are those that exist, in order, the last of them included.
    /// `nees(k)` is over the dimension, and NaN where it is not known.
    void add(std::int64_t trial, int asked, const std::vector<std::size_t>& present,
             const std::function<double(std::size_t)>& nees);
    RecordGaps finish();

private:
    RecordGaps gaps_;
    std::vector<double> beside_, elsewhere_;  ///< means over the steps of each trial that has both
};

/// Whether a run whose errors are those of an earlier one, bit for bit, is no run of its own.
enum class Copies { fail, count };

/// Notices such runs. Errors of few values may agree by chance: then runs that differ also agree in a part of their
/// numbers.
class CopyFinder {
public:
    void start_trial() {
        now_ = {};
        count_ = 0;
    }

    /// The next value of the run, which is no number if it is NaN. Numbers go to two parts by turns.
    void add(double value) {
        if (std::isnan(value)) return;
        std::uint64_t& part = now_[count_++ % 2];
        part = (part ^ std::bit_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15;
        part ^= part >> 32;
    }

    /// Whether what agrees may do so by chance.
    bool by_chance() const { return chance_[0] && chance_[1]; }

    /// The run with which this one agrees in all numbers, if there are two or more.
    std::optional<std::int64_t> end_trial(std::int64_t trial);

    std::int64_t copies() const { return copies_; }
    /// Says how many of all runs are copies.
    std::string note(std::int64_t trials) const;

private:
    std::array<std::uint64_t, 2> now_{};
    std::size_t count_ = 0;                                      ///< numbers of the run
    std::int64_t copies_ = 0;
    std::map<std::array<std::uint64_t, 2>, std::int64_t> runs_;  ///< the first run of each kind
    std::array<std::set<std::uint64_t>, 2> parts_;
    std::array<bool, 2> chance_{};                               ///< whether runs that differ agree in this part
};

}  // namespace credence
