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

/// Opens a record once more and calls this with its reader.
using ReopenRecord = std::function<void(const std::function<void(RecordReader)>&)>;

/// Reads the record in its own chart. `name` names the scenario. Throws PlacedError.
Record read_reopenable(RecordReader reader, const std::string& name, const ReportProgress& progress, int segments,
                            const ReopenRecord& reopen);

}  // namespace credence
