#pragma once
// Reading a record from any source.

#include "record/reader.hpp"
#include "verdict/applied.hpp"

#include <functional>
#include <string>
#include <vector>

namespace credence {

using ReportProgress = std::function<void(const Progress&)>;

/// Reads a whole record, part by part; `name` names the scenario. The result does not depend on the size of the parts.
Record read_record(const RecordReader& reader, const std::string& name, const ReportProgress& progress = {},
                   int segments = segments_auto);

/// Calls `use` with every step of every trial, in order.
void each_step(const RecordReader& reader, const std::function<void(const RecordStep&)>& use,
               const ReportProgress& progress = {});

/// Calls `use` with every step, in order: whether it is there, and what it has then.
void each_checked_step(const RecordReader& reader,
                       const std::function<void(const RecordStep&, Presence, const CheckedStep&)>& use);

/// Calls `use` with every step that is there and whole, in order.
void each_present_step(const RecordReader& reader,
                       const std::function<void(const RecordStep&, const CheckedStep&)>& use);

/// Of these components: their part of P, or a diagonal where the record has variances alone.
Eigen::MatrixXd covariance_of(const CheckedStep& step, const std::vector<int>& components);

/// Throws InputError where `read_record` would, and reads no more than this needs.
void check_record(const RecordArrays& arrays);

/// Opens a record once more, and uses its reader.
using OpenAgain = std::function<void(const std::function<void(RecordReader)>& use)>;

/// Reads the record, and what lets its verdict read it again. `name` names the scenario. Throws PlacedError.
Record read_record(RecordReader reader, const std::string& name, const ReportProgress& progress, int segments,
                   const OpenAgain& open_again);

/// Whether a record of this shape has what the means of read_about_means are weighted by, and whether they fit into
/// memory.
bool has_step_means(const RecordShape& shape);

/// The results of these trials with errors e - m, m = (sum P^-1)^-1 sum P^-1 e over the trials that have the step,
/// times sqrt(N/(N - 1)), so that NEES of a filter whose P is right stays n [generalised least squares]. Reads the
/// record twice. `counted` [trials]: whether the trial is one of them.
AboutMeans read_about_means(const RecordReader& reader, const std::string& name, const std::vector<char>& counted);

/// The evidence with the covariance of the truth's errors, beside a record that was read without it.
std::shared_ptr<const TruthEvidence> truth_evidence(RecordReader& reader, const std::string& name, int segments);

/// Record::sample: of the trials that are `counted`, by their segments.
SampledSteps sampled_steps(const RecordReader& reader, const std::vector<int>& components,
                           const std::vector<char>& counted, const SegmentEvidence& segments);

/// Record::truth_sigmas
std::vector<double> truth_sigmas(const RecordReader& reader, const std::vector<int>& components,
                                 const std::vector<double>& nees);

}  // namespace credence
