#pragma once
// The series of a state that is judged by its errors and covariances alone: of a user's own world, and of a
// record.

#include <credence/columns.hpp>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace credence {

enum class Innovations { none, given };

/// Series by kind: NEES of each group; NIS and its rows where there are innovations, of all rows and of each group of
/// rows; squared error and variance of each group; standardised error of each component.
struct StateSeries {
    StateSeries(const std::vector<Component>& components, const std::vector<ComponentGroup>& groups,
                Innovations innovations, const std::vector<std::string>& row_groups = {});
    /// NEES and NIS alone, where the errors are not known.
    StateSeries(const std::vector<ComponentGroup>& groups, Innovations innovations,
                const std::vector<std::string>& row_groups);

    std::vector<Series> list;
    std::size_t nis = 0, rows = 0, squared_error = 0, variance = 0, standardised_error = 0;  ///< where each kind begins
};

/// Unit of a squared error of some components, and of a trace of their covariance: the sum of their units' squares;
/// `unit of error squared` where one has no unit.
std::string squared_unit(const std::vector<Component>& components, const ComponentGroup& group);

/// [groups, coverage_level_count] quantiles of chi-square with as many degrees of freedom as each group has components.
std::vector<double> coverage_bounds(const std::vector<ComponentGroup>& groups);

// The series of every world, by kind. `unit_of` is the unit of a group's squared error.
using UnitOf = std::function<std::string(const ComponentGroup&)>;

/// `the whole state`, or the group's name.
std::string described(const ComponentGroup& group);
/// `name`, or `name_GROUP` for a part of the state.
std::string of_group(const std::string& name, const ComponentGroup& group);

void add_nees(std::vector<Series>& list, const std::vector<ComponentGroup>& groups);
/// `nis` of all rows, and `nis_rows`, which counts them.
void add_nis(std::vector<Series>& list);
/// `nis_NAME` of a group of rows, and `nis_rows_NAME`.
void add_nis_of_rows(std::vector<Series>& list, const std::string& name);
void add_squared_errors(std::vector<Series>& list, const std::vector<ComponentGroup>& groups, const UnitOf& unit_of);
/// `when` ends the long names, such as ` after the update`.
void add_variances(std::vector<Series>& list, const std::vector<ComponentGroup>& groups, const UnitOf& unit_of,
                   const std::string& when);
void add_standardised_errors(std::vector<Series>& list, const std::vector<Component>& components);

}  // namespace credence
