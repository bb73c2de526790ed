#pragma once
// Segments of a record's runs: which steps they are of, and their results [docs/statistics.md, One log].

#include "record/reader.hpp"

#include <credence/record.hpp>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace credence {

/// Weighted sums of the errors of runs and segments, the weights 1/sigma^2, [segments][2 n]: the weighted errors, and
/// the weights. What is subtracted is the mean of the run or, of components that drift, that of the segment.
struct SegmentMeans {
    std::vector<std::vector<double>> of_run, of_segment;
    std::vector<char> drifts;  ///< [n]; empty while the sums are made
};

/// Chooses the segments of a record, from its runs one after the other.
class SegmentPlanner {
public:
    /// `asked` steps in a segment, segments_auto or segments_off.
    SegmentPlanner(const RecordShape& shape, int asked);

    /// A run that did not fail, with the steps that exist, in order, and value(f, k) of its series at these.
    void add(std::int64_t run, const std::vector<std::size_t>& present, const std::vector<Series>& all_series,
             const std::function<double(std::size_t f, std::size_t k)>& value);

    /// The segments, and their results if they count. Reads the record again.
    RecordSegments finish(const RecordReader& reader, const std::string& name);

private:
    /// Whether the length of segments follows from the runs.
    bool measures() const { return wanted_ && asked_ == segments_auto; }
    void cut(std::int64_t run, const std::vector<std::size_t>& present);
    void cut_all(double steps);
    void choose_length();
    ScenarioResults results(const RecordReader& reader, const std::string& name, SegmentMeans* means) const;

    int asked_;
    bool wanted_;
    std::int64_t runs_;  ///< of the record
    int n_;
    SegmentEvidence found_;
    std::vector<std::pair<std::int64_t, std::vector<std::size_t>>> uncut_;  ///< runs, while the length is not known
    std::vector<int> first_, declared_;  ///< [segments] the first step, and how many up to its last one
};

}  // namespace credence
