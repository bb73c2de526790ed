#pragma once
// Components that a record knows exactly, such as the height, roll and pitch of a planar robot in a record of poses in
// space: where their error and their rows and columns of every covariance are 0 at every step, they are not in the
// state.

#include "record/layout/layout.hpp"

#include <vector>

namespace credence {

struct RecordValues;

/// Finds such components, in two passes: one over the errors, which are fewer numbers, and one over the covariances.
/// What is seen before start() can only end the search.
class KnownSearch {
public:
    explicit KnownSearch(const RecordShape& shape);

    /// Whether a component may still be one.
    bool goes_on() const;
    void start();
    /// Looks at a step's error, or at its variances [n]; NaN says nothing.
    void see(const double* values);
    /// After all errors: those that were never seen are none.
    void end_errors();
    /// Looks at what a step has of covariances.
    void see_covariances(const RecordStep& step);
    /// [n]; none where they are the whole state.
    std::vector<char> known() const;

private:
    void see_matrix(const double* values, const std::vector<int>& components);

    const RecordShape& shape_;
    std::vector<char> open_, seen_;  ///< [n]
};

/// What is left of a state without some of its components.
class RemainingState {
public:
    /// Takes the components out of the layout, and groups that have no others.
    RemainingState(const std::vector<char>& left_out, RecordLayout& layout);

    /// Takes their numbers out of a part.
    void keep(const RecordShape& shape, RecordValues& values) const;

private:
    std::vector<int> kept_;                   ///< of the file's components
    std::size_t size_ = 0;                    ///< of those
    std::vector<std::vector<int>> in_group_;  ///< [groups] of a covariance's own rows; empty where all are kept
    std::vector<std::size_t> group_size_;     ///< [groups]
};

}  // namespace credence
