#pragma once
// Steps that are missing within the runs of a record.

#include <credence/record.hpp>
#include <cstddef>
#include <functional>
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

}  // namespace credence
