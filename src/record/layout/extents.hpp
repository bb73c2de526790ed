#pragma once
// Checks of the extents of a record's datasets against each other. All functions throw RecordError.

#include "record/source.hpp"

#include <string>

namespace credence {

inline constexpr std::uint64_t largest_record_state = 1000, largest_record_rows = 2000,
                                     largest_record_steps = 10'000'000;

/// A dataset's extents with its place in the file; or those that follow from another.
struct PlacedExtents {
    RecordExtents extents;
    std::string place;
};
inline PlacedExtents placed(const RecordDataset& dataset) { return {dataset.extents(), dataset.place()}; }

/// Throws where the matrices are not [..., n, n] to the vectors' [..., n]. The names are for the remedy.
void require_squares(const PlacedExtents& vectors, const RecordDataset& matrices, const std::string& vector_name,
                     const std::string& matrix_name);

/// Throws unless the extent along an axis is from 1 to `most`.
void require_between(const PlacedExtents& dataset, std::size_t axis, std::uint64_t most, const std::string& of_what);

/// Throws unless the dataset has the trials and steps of `vectors` [..., n]; `written` is how to write it.
void require_same_steps(const PlacedExtents& vectors, const RecordDataset& dataset, std::size_t rank,
                        const std::string& written);

/// The dataset; null where neither it nor `other` is there. Throws where only one of them is.
DatasetPointer open_optional(const RecordSource& source, const std::string& name, const std::string& other);

}  // namespace credence
