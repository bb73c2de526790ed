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

/// Reads the record in its own chart or, of states on a manifold with charts, in the other one. `name` names the
/// scenario; `read_again(other)` does the same once more. Throws PlacedError.
Record read_in_chart(RecordReader reader, const std::string& name, const ReportProgress& progress, int segments,
                     bool other, const std::function<Record(bool)>& read_again);

}  // namespace credence
