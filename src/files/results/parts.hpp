#pragma once
// The parts of a results file, which are written and read by the same names [docs/results-format.md].

#include <credence/study.hpp>

#include "files/hdf5/read.hpp"
#include "files/hdf5/write.hpp"
#include "numeric/chi_square.hpp"

#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// The remedy in messages about a damaged file.
inline const char* const another_copy = "Run the study again, or give an undamaged copy";

/// The group within an arm's that has the series of the trials that the verdict counts, where others diverged.
inline const std::string without_diverged = "without_diverged";

inline const std::vector<double> levels_of_coverage(std::begin(coverage_levels), std::end(coverage_levels));
inline std::string coverage_name(const Series& series) { return series.name + "_covered"; }

/// Names of the datasets of the series.
std::vector<std::string> series_links(const ScenarioResults& results);

/// Names of the datasets in the group of the next arm.
std::vector<std::string> arm_links(const ScenarioResults& results);

/// Throws InputError where two datasets of an arm would have one name: those of columns, groups and components of a
/// user's own world.
void refuse_clashing_links(const Study& study);

/// Scenario, columns and series of a scenario's group, without arms: declared by its world or, if this program does not
/// have that world, by the file's own content. `file` names it in messages. Throws hdf5::Error, and InputError for a
/// broken scenario.
ScenarioResults read_declared(const hdf5::Handle& group, const std::string& file, Keep keep);

/// A column that was read once: checksums of its values, `block_size` rows at a time, and the number of trials that did
/// not fail, from the status column.
struct CheckedColumn {
    std::vector<std::uint32_t> sums;
    std::optional<std::int64_t> counted;
};

/// Reads a column of an arm's group. Throws where it has wrong dimensions or the wrong type, holds an invalid status,
/// or does not have its checksum.
CheckedColumn check_column(const hdf5::Handle& group, const Column& column, std::int64_t trials);

/// The columns of an arm, in a file that stays open for them; `sums` of each are those of check_column. Reading throws
/// where the values have others now.
std::shared_ptr<const KeptColumns> columns_of_file(std::shared_ptr<const hdf5::Handle> file, const std::string& path,
                                                   const std::string& group, const std::vector<Column>& columns,
                                                   const std::vector<std::vector<std::uint32_t>>& sums);

/// The blocks of the trials in an arm's group, of a study that was asked for `asked`. Throws where a block is not
/// complete, except for the study's last.
BlockRanges read_blocks(const hdf5::Handle& group, std::int64_t asked);

/// The same if no trial is kept, as ranges. Throws Error unless they are increasing and separate.
void write_block_ranges(const hdf5::Handle& group, const BlockRanges& blocks);
BlockRanges read_block_ranges(const hdf5::Handle& group, std::int64_t asked);

// The totals of an arm's columns [Totals of the columns].

/// Names of the datasets of the arm at `place` in the scenario, coordinates included.
std::vector<std::string> trial_totals_links(std::size_t place);
/// The largest number of parts of any of its exact totals.
std::size_t largest_part_count(const TrialTotals& totals);
void write_trial_totals(const hdf5::Handle& group, const hdf5::Dimension& part, const ScenarioResults& results,
                        const ArmResults& arm);
/// Reads those of the next arm of `results`, whose trials are known. Throws Error if they do not agree with these, or
/// with each other.
TrialTotals read_trial_totals(const hdf5::Handle& group, const ScenarioResults& results, hsize_t parts);

// The distribution of NEES, whiteness, and the errors of the detailed trials [Coverage, Distribution, Whiteness,
// Errors].

struct EvidenceDimensions {
    const hdf5::Dimension& step;
    const hdf5::Dimension& part;
    const hdf5::Dimension& level;
};

/// Names of these datasets, coordinates included.
std::vector<std::string> evidence_links(const ScenarioResults& results);
void write_evidence(const hdf5::Handle& group, const EvidenceDimensions& dimensions, const ScenarioResults& results,
                    const ArmResults& arm);
/// Reads what `write_evidence` wrote; results.trials and arm.totals.trials.counted() are known. Throws Error where it
/// is damaged.
void read_evidence(const hdf5::Handle& group, const ScenarioResults& results, hsize_t parts, ArmResults& arm);

// Exact sums, a row of parts each [Exact totals].

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

/// A list of numbers, of any length.
inline hdf5::Dataset open_list(const hdf5::Handle& group, const std::string& name) {
    hdf5::Dataset dataset(group, name);
    if (dataset.extents().size() != 1) throw hdf5::Error(dataset.place(), "is not a list of numbers");
    return dataset;
}

/// Reads a coordinate, which must count from `first` on, and returns its length.
template <class T>
hsize_t read_numbered(const hdf5::Handle& group, const std::string& name, T first) {
    const hdf5::Dataset dataset = open_list(group, name);
    for (const T value : dataset.read<T>())
        if (value != first++) throw hdf5::Error(dataset.place(), "does not count on by one");
    return dataset.extents()[0];
}

/// The same of one that has `count` numbers.
template <class T>
void check_numbered(const hdf5::Handle& group, const std::string& name, T first, hsize_t count) {
    hdf5::Dataset(group, name).require_extents({count});
    read_numbered(group, name, first);
}

}  // namespace credence
