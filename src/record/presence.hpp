#pragma once
// Checks the steps of a record, in which components may enter and leave the state.

#include "record/step.hpp"

#include <string>
#include <vector>

namespace credence {

/// 0, 1 ... count - 1.
std::vector<int> counted_up(int count);

/// The components of a group, in its order.
std::vector<int> members_of(const ComponentGroup& group);

/// Whether some value is not NaN.
bool any_number(const double* values, std::ptrdiff_t count);

/// Copies the submatrix of a matrix [size, size] with these rows and columns, made symmetric; false where some value is
/// not finite. Throws RecordError at `dataset`, trial and step where it is not symmetric, to 1e-9 or 16 `epsilon`, the
/// larger, of sqrt(P_ii P_jj).
bool read_symmetric(const std::string& dataset, const RecordStep& step, const double* values, std::ptrdiff_t size,
                    const std::vector<int>& rows, double epsilon, Eigen::MatrixXd& symmetric);

/// Copies the observed rows of the innovation, and their covariance. Returns what is wrong with them; empty where
/// nothing is.
std::string read_innovation(const RecordStep& step, const RecordShape& shape, CheckedStep& checked);

/// Receives the steps of each trial in order, from its first one on. A component is in the state at the steps at which
/// its error is a number: at successive ones, steps that do not exist apart. Where it is not, its rows and columns of
/// every covariance are NaN.
class PresenceChecker {
public:
    explicit PresenceChecker(const RecordShape& shape);

    /// Whether the step exists and is one of its trial; what is wrong with it goes to `checked.broken`.
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
