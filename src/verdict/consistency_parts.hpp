#pragma once
// Declarations shared by the two files of the verdict.

#include <credence/consistency.hpp>

#include <cmath>

namespace credence {

enum class Side { inside, above, below };

/// An estimate with the half-width of its interval.
struct Estimate {
    double value = 0, half_width = 0;
    Interval interval() const { return {value - half_width, value + half_width}; }
};

inline Side side_of(const Interval& interval, double margin) {
    if (interval.low > 1 + margin) return Side::above;
    if (interval.high < 1 - margin) return Side::below;
    return Side::inside;
}

inline bool within(const Interval& interval, double margin) {
    return interval.low >= 1 - margin && interval.high <= 1 + margin;
}

inline Fault fault_of(Side side) { return side == Side::above ? Fault::optimistic : Fault::pessimistic; }

/// `a, b, c and 2 more`, of one name or more.
std::string first_of(const std::vector<std::string>& names);

/// `steps 3 to 7, 9`, from numbers in order.
std::string listed(const std::string& what, const std::vector<int>& numbers);
inline std::string steps_text(const std::vector<int>& steps) { return listed("step", steps); }

/// Steps with a finding, and the one of them that is farthest off.
struct Found {
    std::vector<int> steps;
    double value = 0;
    Interval interval;

    void add(std::size_t k, double mean, const Interval& bounds) {
        if (steps.empty() || std::abs(mean - 1) > std::abs(value - 1)) {
            value = mean;
            interval = bounds;
        }
        steps.push_back(static_cast<int>(k) + 1);
    }
};

/// The verdict on one run whose segments do not count: what no correlation of its steps can explain.
Consistency judge_single_run(const Evidence& evidence, const Limits& limits);

/// Adds the cautions to a verdict.
void caution_about_whiteness(const Evidence& evidence, Consistency& verdict);
void caution_about_innovations(const Evidence& evidence, Consistency& verdict);
void caution_about_distribution(const Evidence& evidence, Consistency& verdict);

/// Sentences on what findings such as these often come from, by the size of the errors beside P's.
std::vector<std::string> causes_of(const Evidence& evidence, const Limits& limits);

/// A sentence on NEES that grows beyond that of a diverged trial, which it does not where a factor on P or a unit is
/// wrong from the start; empty where it does not.
std::string divergence_of(const Evidence& evidence);

/// A sentence on two detailed trials that are the same; empty where there are none.
std::string repeated_trials(const Evidence& evidence);

/// Adds hints: what findings such as these often come from.
void add_hints(const Evidence& evidence, Consistency& verdict);

}  // namespace credence
