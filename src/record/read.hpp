#pragma once
// Reading a record from any source.

#include "record/reader.hpp"

#include <functional>
#include <string>

namespace credence {

using ReportProgress = std::function<void(const Progress&)>;

/// Reads a whole record, part by part; `name` names the scenario. The result does not depend on the size of the parts.
Record read_record(const RecordReader& reader, const std::string& name, const ReportProgress& progress = {},
                   int segments = segments_auto);

/// Calls `use` with every step of every trial, in order.
void each_step(const RecordReader& reader, const std::function<void(const RecordStep&)>& use,
               const ReportProgress& progress = {});

/// Throws InputError where `read_record` would, and reads no more than this needs.
void check_record(const RecordArrays& arrays);

/// Reads the record in its own chart, or in another one of its manifold [manifold.hpp, take_chart]. `name` names the
/// scenario; `read_again(chart)` does the same once more. Throws PlacedError.
Record read_in_chart(RecordReader reader, const std::string& name, const ReportProgress& progress, int segments,
                     int chart, const std::function<Record(int)>& read_again);

}  // namespace credence
