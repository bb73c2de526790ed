#include "record/reader.hpp"

#include "base/nan.hpp"

#include <algorithm>
#include <cmath>
#include <credence/text.hpp>
#include <numbers>

namespace credence {

void for_each_step(const RecordPart& part, const RecordValues& values,
                   const std::function<void(const RecordStep&)>& use) {
    const std::size_t steps = static_cast<std::size_t>(part.trials) * static_cast<std::size_t>(part.steps);
    std::size_t i = 0;
    const auto at = [&](const std::vector<double>& all) -> const double* {
        return all.empty() ? nullptr : &all[i * (all.size() / steps)];
    };
    RecordStep step;
    step.own.resize(values.own.size());
    for (step.trial = part.first_trial; step.trial < part.first_trial + part.trials; ++step.trial)
        for (step.step = part.first_step; step.step < part.first_step + part.steps; ++step.step, ++i) {
            step.error = at(values.error);
            step.covariance = at(values.covariance);
            step.truth_covariance = at(values.truth_covariance);
            step.innovation = at(values.innovation);
            step.innovation_covariance = at(values.innovation_covariance);
            for (std::size_t b = 0; b < step.own.size(); ++b) step.own[b] = at(values.own[b]);
            use(step);
        }
}

RecordReader::RecordReader(const RecordSource& source, std::int64_t part_numbers)
    : layout_(open_record(source)), part_numbers_(part_numbers) {
    const RecordDatasets& data = layout_.data;
    for (const DatasetPointer* dataset : {&data.error, &data.truth, &data.estimate, &data.covariance,
                                          &data.truth_covariance, &data.innovation, &data.innovation_covariance})
        add_size(*dataset);
    for (const DatasetPointer& dataset : data.own) add_size(dataset);
    if (layout_.shape.declared.empty()) layout_.shape.longest = longest_trial();
    if (const std::vector<char> known = known_components(); !known.empty()) remaining_.emplace(known, layout_);
}

void RecordReader::add_size(const DatasetPointer& dataset) {
    if (!dataset) return;
    std::int64_t size = 1;
    for (std::size_t axis = layout_.single ? 1 : 2; axis < dataset->extents().size(); ++axis)
        size *= static_cast<std::int64_t>(dataset->extents()[axis]);
    step_numbers_ += size;
}

void RecordReader::each_part(const std::function<bool(const RecordPart&)>& visit) const {
    const RecordShape& shape = layout_.shape;
    for (std::int64_t trial = 0; trial < shape.trials;) {
        std::int64_t trials = 1;
        for (int step = 0; step < shape.steps;) {
            const RecordPart part = part_at(trial, step);
            if (!visit(part)) return;
            step += part.steps;
            trials = part.trials;
        }
        trial += trials;
    }
}

/// Only the errors are read, and usually only the first trial: the search ends at a trial that has all steps.
int RecordReader::longest_trial() const {
    int longest = 0;
    std::vector<double> values;
    each_part([&](const RecordPart& part) {
        for (const RecordDataset* dataset : layout_.data.leading())
            longest = std::max(longest, last_step(*dataset, part, values));
        return longest < layout_.shape.steps;
    });
    return longest;
}

std::vector<char> RecordReader::known_components() const {
    KnownSearch search(layout_.shape);
    RecordValues values;
    const auto look = [&](auto read_part, auto see, bool on) {
        each_part([&](const RecordPart& part) {
            if (!search.goes_on()) return false;
            (this->*read_part)(part, values);
            for_each_step(part, values, [&](const RecordStep& step) {
                if (layout_.shape.covers(step.trial, step.step)) see(step);
            });
            return on;
        });
        values = {};
    };
    const auto see_error = [&](const RecordStep& step) { search.see(step.error); };
    const auto see_covariances = [&](const RecordStep& step) { search.see_covariances(step); };
    look(&RecordReader::read_covariances, see_covariances, false);  // of the first part, which end most searches
    search.start();
    look(&RecordReader::read_errors, see_error, true);
    search.end_errors();
    look(&RecordReader::read_covariances, see_covariances, true);
    return search.known();
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
    const RecordDataset& largest = layout_.data.covariance ? *layout_.data.covariance : *layout_.data.leading().front();
    const auto together = layout_.single ? 1 : static_cast<std::int64_t>(largest.chunk());
    if (trials > together) trials -= trials % together;
    return {trial, std::min(trials, shape.trials - trial), 0, steps};
}

void RecordReader::read(const RecordDataset& dataset, const RecordPart& part, std::vector<double>& values) const {
    RecordExtents first(dataset.extents().size(), 0), count = dataset.extents();
    const std::size_t axis = layout_.single ? 0 : 1;
    first[axis] = static_cast<std::uint64_t>(part.first_step);
    count[axis] = static_cast<std::uint64_t>(part.steps);
    if (!layout_.single) {
        first[0] = static_cast<std::uint64_t>(part.first_trial);
        count[0] = static_cast<std::uint64_t>(part.trials);
    }
    std::size_t size = 1;
    for (const std::uint64_t extent : count) size *= extent;
    values.resize(size);
    dataset.read(first, count, values);
}

void RecordReader::read(const RecordPart& part, RecordValues& values) const {
    const RecordDatasets& data = layout_.data;
    read_errors(part, values);
    read_covariances(part, values);
    if (data.innovation) read(*data.innovation, part, values.innovation);
    if (data.innovation) read(*data.innovation_covariance, part, values.innovation_covariance);
    if (data.truth_covariance) read(*data.truth_covariance, part, values.truth_covariance);
    if (remaining_) remaining_->keep(layout_.shape, values);
    const std::size_t row = means_.size() / static_cast<std::size_t>(layout_.shape.steps),
                      length = row * static_cast<std::size_t>(part.steps),
                      first = row * static_cast<std::size_t>(part.first_step);
    for (std::size_t i = 0; length > 0 && i < values.error.size(); ++i)
        values.error[i] = factors_[first + i % length] * (values.error[i] - means_[first + i % length]);
}

void RecordReader::centre(std::vector<double> means, std::vector<double> factors) {
    means_ = std::move(means);
    factors_ = std::move(factors);
}

void RecordReader::read_errors(const RecordPart& part, RecordValues& values) const {
    if (layout_.data.error) read(*layout_.data.error, part, values.error);
    if (layout_.data.manifold) read_manifold(part, values);
}

void RecordReader::read_covariances(const RecordPart& part, RecordValues& values) const {
    const RecordDatasets& data = layout_.data;
    if (data.covariance) read(*data.covariance, part, values.covariance);
    values.own.resize(data.own.size());
    for (std::size_t b = 0; b < data.own.size(); ++b)
        if (data.own[b]) read(*data.own[b], part, values.own[b]);
}

/// Forms the errors of a part from truth and estimate.
void RecordReader::read_manifold(const RecordPart& part, RecordValues& values) const {
    const Manifold& manifold = *layout_.data.manifold;
    read(*layout_.data.truth, part, values.truth);
    read(*layout_.data.estimate, part, values.estimate);
    const auto n = static_cast<std::size_t>(manifold.dimension()), q = static_cast<std::size_t>(manifold.coordinates());
    values.error.assign(values.truth.size() / q * n, nan);
    const std::vector<int> angles = manifold.doubtful_angles();
    double largest = 0, folded = 0, cosines = 0;  // of angles, of differences beyond half a turn
    std::size_t i = 0;
    for (std::int64_t trial = part.first_trial; trial < part.first_trial + part.trials; ++trial)
        for (int k = part.first_step; k < part.first_step + part.steps; ++k, ++i) {
            if (!layout_.shape.covers(trial, k)) continue;
            require_quaternions(*layout_.data.truth, trial, k, &values.truth[i * q]);
            require_quaternions(*layout_.data.estimate, trial, k, &values.estimate[i * q]);
            manifold.error(&values.truth[i * q], &values.estimate[i * q], &values.error[i * n]);
            for (const int at : angles) {
                const double truth = values.truth[i * q + static_cast<std::size_t>(at)],
                             estimate = values.estimate[i * q + static_cast<std::size_t>(at)];
                largest = std::max({largest, std::abs(truth), std::abs(estimate)});
                if (!(std::abs(estimate - truth) > std::numbers::pi)) continue;
                ++folded;
                cosines += std::cos(estimate - truth);
            }
        }
    // Of angles in rad, differences beyond half a turn are about whole turns.
    if (largest > 4 * std::numbers::pi && cosines < folded / 2)
        throw RecordError(layout_.data.estimate->place(),
                          "has angles up to " + to_text(largest) +
                              " from 0, and differences from the truth that are no whole turns, as if in degrees",
                          "Write angles of a manifold in rad; if they are, say it in the attribute `component_units`",
                          "Give angles of a manifold in rad; if they are, say it in component_units");
}

void RecordReader::require_quaternions(const RecordDataset& dataset, std::int64_t trial, int step,
                                     const double* coordinates) const {
    const int wrong = layout_.data.manifold->wrong_quaternion(coordinates);
    if (wrong < 0) return;
    throw RecordError(dataset.place(),
                      "trial " + std::to_string(trial) + ", step " + std::to_string(step) +
                          " (both counted from 0) has no unit quaternion at " + std::to_string(wrong) + ":" +
                          std::to_string(wrong + 4),
                      "Write quaternions of length 1, in the order of the attribute `quaternion`");
}

}  // namespace credence
