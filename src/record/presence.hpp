#pragma once
// Checks the steps of a record, in which components may enter and leave the state.

#include "record/step.hpp"

#include <string>
#include <vector>

namespace credence {

/// Receives the steps of a trial in order. A component is in the state at the steps at which its error is a number: at
/// successive ones, steps that do not exist apart. Where it is not, its rows and columns of every covariance are NaN.
class PresenceChecker {
public:
    explicit PresenceChecker(const RecordShape& shape);

    void start_trial();
    /// Whether the step exists; what is wrong with it goes to `checked.broken`.
    Presence check(const RecordStep& step, CheckedStep& checked);

private:
    enum class Stay : char { before, in, after };

    bool exists(const RecordStep& step) const;
    std::string read(const RecordStep& step, CheckedStep& checked);
    std::string read_errors(const RecordStep& step, CheckedStep& checked);
    std::string follow(std::vector<Stay>& stays, std::size_t at, bool here, const std::string& what) const;
    std::string read_covariance(const RecordStep& step, CheckedStep& checked);
    void use_truth(const RecordStep& step, CheckedStep& checked);
    std::string read_variances(const RecordStep& step, CheckedStep& checked);
    std::string read_own(const RecordStep& step, std::size_t b, CheckedStep& checked);
    std::string read_nees(const RecordStep& step, std::size_t b, CheckedStep& checked);
    std::string matrix_trouble(const double* values, const std::vector<int>& components, const CheckedStep& checked,
                               const std::string& of) const;

    const RecordShape& shape_;
    std::vector<Stay> components_, groups_;  ///< of the current trial; groups only where there are no errors
    std::vector<std::vector<int>> members_;  ///< by group
    std::vector<int> here_;
    Eigen::MatrixXd part_;
};

}  // namespace credence
