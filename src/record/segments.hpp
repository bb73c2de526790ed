#pragma once
// Segments of a record's runs: which steps they are of, and their results [docs/statistics.md, One log].

#include "record/reader.hpp"

#include <credence/record.hpp>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace credence {

/// Chooses the segments of a record, from its runs one after the other.
class SegmentPlanner {
public:
    /// `asked` steps in a segment, segments_auto or segments_off.
    SegmentPlanner(const RecordShape& shape, int asked);

    /// Whether a run's series are wanted.
    bool wants_series() const { return wanted_ && asked_ == segments_auto; }
    /// A run that did not fail, with the steps that exist, in order.
    void add(std::int64_t run, const std::vector<std::size_t>& present);
    /// A series of that run, whose autocorrelation is taken about `mean`.
    void add_series(const std::vector<double>& values, double mean);

    /// The segments, and their results if they count. Reads the record again.
    RecordSegments finish(const RecordReader& reader, const std::string& name);

private:
    void cut(std::int64_t run, const std::vector<std::size_t>& present);
    ScenarioResults results(const RecordReader& reader, const std::string& name) const;

    int asked_;
    bool wanted_;
    SegmentEvidence found_;
    std::vector<std::pair<std::int64_t, std::vector<std::size_t>>> uncut_;  ///< runs, while the length is not known
    std::vector<int> first_, declared_;  ///< [segments] the first step, and how many up to its last one
};

}  // namespace credence
