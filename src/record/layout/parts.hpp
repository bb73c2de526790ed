#pragma once
// The parts of open_record. All functions throw RecordError.

#include "record/layout/layout.hpp"

#include <memory>
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

/// The numbers of a dataset [trial]. Throws where it has other extents; the remedies are how to write it.
std::vector<double> read_by_trial(const RecordDataset& dataset, std::int64_t trials, const std::string& remedy,
                                  const std::string& of_arrays = {});

/// The dataset; null where neither it nor `other` is there. Throws where only one of them is.
DatasetPointer open_optional(const RecordSource& source, const std::string& name, const std::string& other);

/// Sets trials and steps by extents [..., size], `rank` of them with trials; `written` is how to write it.
void set_extents(const PlacedExtents& leading, std::size_t rank, const std::string& written, RecordLayout& layout);
/// The same of an error [..., n], and sets n.
void set_state(const PlacedExtents& error, RecordLayout& layout);

/// The dataset `steps` [trial], if it is there: the number of steps of each run.
void add_steps(const RecordSource& source, RecordShape& shape);
/// Checks the dataset `time` [step] or [trial, step], if it is there: it increases from step to step, and only a step
/// that does not exist may be without one. The errors are read of trials with such steps. Keeps those of few runs.
void check_time(const RecordSource& source, RecordLayout& layout);

/// The columns of the record's own, datasets /column/NAME [trial], and the name of its arm, the attribute `arm`.
void add_columns(const RecordSource& source, RecordShape& shape);

/// The covariance of the truth's own errors: the attribute `truth_sigma`, or the dataset `truth_covariance`, and the
/// attribute `truth_dependent`.
void add_truth_covariance(const RecordSource& source, RecordLayout& layout);

/// Gives every group the same source; none has a dataset of its own yet.
void set_sources(GroupSource source, RecordLayout& layout);
/// Opens a NEES as that of a group, and returns the attribute `dimension`.
int open_nees(const RecordSource& source, const std::string& path, std::size_t b, RecordLayout& layout);

/// Opens `error`, or `truth` and `estimate`. Returns its extents [..., n], empty without errors.
PlacedExtents open_errors(const RecordSource& source, RecordDatasets& data);
/// A record with errors.
void open_states(const RecordSource& source, const PlacedExtents& error, RecordLayout& layout);
/// Whether a record has innovations and neither errors nor NEES.
bool has_innovations_alone(const RecordSource& source);
/// Its innovations as errors whose covariance is S; `source` must outlive it.
std::unique_ptr<RecordSource> innovations_of(const RecordSource& source);
/// One of NEES alone: /nees, and /group/NAME/nees of groups that need not be named elsewhere. Returns the extents that
/// an error of one component would have.
PlacedExtents open_nees_alone(const RecordSource& source, RecordLayout& layout);

/// The whole state as `all`, then the component groups, such as `position 0 2, velocity 1 3, heading 4`, with ranges
/// such as `0:3` between them, of a state of n components. Throws RecordError at `place`, as all functions here.
std::vector<ComponentGroup> parse_groups(const ListEntries& entries, int n, const std::string& place);

/// A group of one component or more: contiguous where they are so, and in order.
ComponentGroup group_of(const std::string& name, std::vector<int> members);

/// Groups of the m rows of an innovation, such as `gps 0:3, baro 3`.
std::vector<RowGroup> parse_row_groups(const ListEntries& entries, int m, const std::string& place);

/// The component groups of a record, of the attribute `groups`.
std::vector<ComponentGroup> read_groups(const RecordSource& source, int n);

/// Names and units of the n components by the attributes `component_names` and `component_units`; without both,
/// `defaults` (n, or empty). Without names they are those of `defaults`, or x0, x1 ...; of names without units, the
/// units are empty.
std::vector<Component> read_components(const RecordSource& source, int n, const std::vector<Component>& defaults);

/// Throw where a name cannot be that of a group of components, which is a word, or that of a component.
void require_group_name(const std::string& name, const std::string& place);
void require_component_name(const std::string& name, const std::string& place);

}  // namespace credence
