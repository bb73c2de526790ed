#pragma once
// Parts of the check of a step.

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

}  // namespace credence
