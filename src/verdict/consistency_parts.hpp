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

/// Sentences on what findings such as these often come from. Says in the verdict whether that is a mix-up.
std::vector<std::string> causes_of(const Evidence& evidence, Consistency& verdict);

/// Whether innovations are as large as S says, and not correlated; false without them.
bool innovations_are_right(const Evidence& evidence, const Limits& limits);

/// A sentence on NEES that grows beyond that of a diverged trial, which it does not where a factor on P or a unit is
/// wrong from the start; empty where it does not.
std::string divergence_of(const Evidence& evidence);

/// Sentences that are empty where there is nothing to say. On variances that stand for "unknown".
std::string placeholders_of(const Evidence& evidence);
/// On mean errors that are the same at all steps, as far as these can tell.
std::string offset_of(const Evidence& evidence);
/// On what was written wrongly: of a record by its steps, and else by one step of each mean size.
std::string mix_up_of(const Evidence& evidence);
/// On two components that are right by themselves, and whose errors are correlated where P never says so.
std::string dropped_of(const Evidence& evidence);
/// On two detailed trials that are the same.
std::string repeated_trials(const Evidence& evidence);

/// Adds hints: what findings such as these often come from.
void add_hints(const Evidence& evidence, Consistency& verdict);

}  // namespace credence
