#pragma once
// Exact sums in a file: a row of parts each [docs/results-format.md, Exact totals].

#include <credence/detail/exact_sum.hpp>

#include "files/hdf5/read.hpp"

#include <string>
#include <vector>

namespace credence {

/// The exact parts of sums, one sum a row, padded with zeros.
std::vector<double> parts_of(const std::vector<ExactSum>& sums, std::size_t width);

/// Converts rows of exact parts to sums. A sum has exactly one valid form; any other was not written by this program.
std::vector<ExactSum> read_sums(const hdf5::Handle& group, const std::string& name, const hdf5::Extents& extents);

/// Converts a sum of whole numbers to an integer; throws Error naming the series where it is not whole.
std::int64_t whole_number(const ExactSum& sum, const std::string& name);
std::vector<ExactSum> read_whole_sums(const hdf5::Handle& group, const std::string& name, hsize_t steps);

template <class T>
std::vector<T> read_as(const hdf5::Handle& group, const std::string& name, const hdf5::Extents& extents) {
    const hdf5::Dataset dataset(group, name);
    dataset.require_extents(extents);
    return dataset.read<T>();
}

/// Throws unless a coordinate counts up from `first`.
template <class T>
void check_numbered(const hdf5::Handle& group, const std::string& name, T first, hsize_t count) {
    for (const T value : read_as<T>(group, name, {count}))
        if (value != first++) throw hdf5::Error(hdf5::place_of(group, name), "does not count on by one");
}

}  // namespace credence
