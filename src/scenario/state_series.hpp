#pragma once
// The series of a state that is judged by its errors and covariances alone: of a world of somebody's own, and of
// a record.

#include <credence/columns.hpp>

#include <cstddef>
#include <vector>

namespace credence {

enum class Innovations { none, given };

/// Figures by kind: NEES of each block; NIS and its rows where there are innovations; squared error and variance of each
/// block; standardised error of each component.
struct StateSeries {
    StateSeries(const std::vector<Component>& components, const std::vector<ComponentGroup>& blocks,
                 Innovations innovations);

    std::vector<Series> list;
    std::size_t nis = 0, rows = 0, squared_error = 0, variance = 0, standardised_error = 0;  ///< where each kind begins
};

/// Unit of a squared error of some components, and of a trace of their covariance: the sum of their units' squares.
std::string squared_unit(const std::vector<Component>& components, const ComponentGroup& block);

}  // namespace credence
