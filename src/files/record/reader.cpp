#include "files/record/reader.hpp"

#include "base/nan.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

using hdf5::Error;
using hdf5::Extents;

RecordReader::RecordReader(const RecordSource& source, std::int64_t part_numbers)
    : layout_(open_record(source)), part_numbers_(part_numbers) {
    const RecordDatasets& data = layout_.data;
    for (const DatasetPointer* dataset :
         {&data.error, &data.truth, &data.estimate, &data.covariance, &data.innovation, &data.innovation_covariance})
        add_size(*dataset);
    for (const DatasetPointer& dataset : data.own) add_size(dataset);
    if (layout_.shape.declared.empty()) layout_.shape.longest = longest_trial();
}

void RecordReader::add_size(const DatasetPointer& dataset) {
    if (!dataset) return;
    std::int64_t size = 1;
    for (std::size_t axis = layout_.single ? 1 : 2; axis < dataset->extents().size(); ++axis)
        size *= static_cast<std::int64_t>(dataset->extents()[axis]);
    step_numbers_ += size;
}

/// The datasets whose numbers say that a step exists: errors, or NEES where there are none.
std::vector<const RecordDataset*> RecordReader::leading() const {
    const RecordDatasets& data = layout_.data;
    if (data.error) return {&*data.error};
    if (data.estimate) return {&*data.estimate};
    std::vector<const RecordDataset*> all;
    for (const DatasetPointer& nees : data.own)
        if (nees) all.push_back(&*nees);
    return all;
}

/// Only the errors are read, and usually only the first trial: the search ends at a trial that has all steps.
int RecordReader::longest_trial() const {
    const RecordShape& shape = layout_.shape;
    int longest = 0;
    std::vector<double> values;
    for (std::int64_t trial = 0; trial < shape.trials && longest < shape.steps;) {
        std::int64_t trials = 1;
        for (int step = 0; step < shape.steps;) {
            const RecordPart part = part_at(trial, step);
            for (const RecordDataset* dataset : leading()) longest = std::max(longest, last_step(*dataset, part, values));
            step += part.steps;
            trials = part.trials;
        }
        trial += trials;
    }
    return longest;
}

/// The number of steps, counted from the first of all, up to the last one that some trial of the part has.
int RecordReader::last_step(const RecordDataset& dataset, const RecordPart& part, std::vector<double>& values) const {
    read(dataset, part, values);
    const auto steps = static_cast<std::size_t>(part.steps),
               n = values.size() / (static_cast<std::size_t>(part.trials) * steps);
    int last = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!std::isnan(values[i])) last = std::max(last, part.first_step + static_cast<int>(i / n % steps) + 1);
    return last;
}

RecordPart RecordReader::part_at(std::int64_t trial, int step) const {
    const std::int64_t of_step = step_numbers_;
    const RecordShape& shape = layout_.shape;
    const auto steps = static_cast<int>(std::clamp<std::int64_t>(part_numbers_ / of_step, 1, shape.steps - step));
    if (step > 0 || steps < shape.steps) return {trial, 1, step, steps};
    std::int64_t trials = std::max<std::int64_t>(part_numbers_ / (of_step * steps), 1);
    // Whole chunks are read, so that each is decompressed once.
    const RecordDataset& largest = layout_.data.covariance ? *layout_.data.covariance : *leading().front();
    const auto together = layout_.single ? 1 : static_cast<std::int64_t>(largest.chunk());
    if (trials > together) trials -= trials % together;
    return {trial, std::min(trials, shape.trials - trial), 0, steps};
}

void RecordReader::read(const RecordDataset& dataset, const RecordPart& part, std::vector<double>& values) const {
    Extents first(dataset.extents().size(), 0), count = dataset.extents();
    const std::size_t axis = layout_.single ? 0 : 1;
    first[axis] = static_cast<hsize_t>(part.first_step);
    count[axis] = static_cast<hsize_t>(part.steps);
    if (!layout_.single) {
        first[0] = static_cast<hsize_t>(part.first_trial);
        count[0] = static_cast<hsize_t>(part.trials);
    }
    std::size_t size = 1;
    for (const hsize_t extent : count) size *= extent;
    values.resize(size);
    dataset.read(first, count, values);
}

void RecordReader::read(const RecordPart& part, RecordValues& values) const {
    const RecordDatasets& data = layout_.data;
    const auto read_if = [&](const DatasetPointer& dataset, std::vector<double>& to) {
        if (dataset) read(*dataset, part, to);
    };
    read_if(data.error, values.error);
    if (data.manifold) read_manifold(part, values);
    read_if(data.covariance, values.covariance);
    read_if(data.innovation, values.innovation);
    read_if(data.innovation_covariance, values.innovation_covariance);
    values.own.resize(data.own.size());
    for (std::size_t b = 0; b < data.own.size(); ++b) read_if(data.own[b], values.own[b]);
}

/// Forms the errors of a part from truth and estimate.
void RecordReader::read_manifold(const RecordPart& part, RecordValues& values) const {
    const Manifold& manifold = *layout_.data.manifold;
    read(*layout_.data.truth, part, values.truth);
    read(*layout_.data.estimate, part, values.estimate);
    const auto n = static_cast<std::size_t>(manifold.dimension()), q = static_cast<std::size_t>(manifold.coordinates());
    values.error.assign(values.truth.size() / q * n, nan);
    std::size_t i = 0;
    for (std::int64_t trial = part.first_trial; trial < part.first_trial + part.trials; ++trial)
        for (int k = part.first_step; k < part.first_step + part.steps; ++k, ++i) {
            if (!layout_.shape.covers(trial, k)) continue;
            require_quaternions(*layout_.data.truth, trial, k, &values.truth[i * q]);
            require_quaternions(*layout_.data.estimate, trial, k, &values.estimate[i * q]);
            manifold.error(&values.truth[i * q], &values.estimate[i * q], &values.error[i * n]);
        }
}

void RecordReader::require_quaternions(const RecordDataset& dataset, std::int64_t trial, int step,
                                     const double* coordinates) const {
    const int wrong = layout_.data.manifold->wrong_quaternion(coordinates);
    if (wrong < 0) return;
    throw Error(dataset.place(),
                "trial " + std::to_string(trial) + ", step " + std::to_string(step) +
                    " (both counted from 0) has no unit quaternion at " + std::to_string(wrong) + ":" + std::to_string(wrong + 4),
                "Write quaternions of length 1, in the order of the attribute `quaternion`");
}

}  // namespace credence
