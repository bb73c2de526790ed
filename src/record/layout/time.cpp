// The datasets of a record that say how long each run is, and when its steps are.

#include <algorithm>
#include <cmath>
#include <credence/evidence.hpp>
#include <credence/text.hpp>
#include <limits>

#include "record/layout/parts.hpp"

namespace credence {

void add_steps(const RecordSource& source, RecordShape& shape) {
    if (!source.has("steps")) return;
    const DatasetPointer dataset = source.open("steps", Numbers::any);
    for (const double value :
         read_by_trial(*dataset, shape.trials, "Write it as [trial], the number of steps of each")) {
        if (!(value >= 1 && value <= shape.steps && value == std::nearbyint(value)))
            throw RecordError(
                dataset->place(),
                "trial " + std::to_string(shape.declared.size()) + " (counted from 0) has " + to_text(value) + " steps",
                "Write whole numbers from 1 to " + std::to_string(shape.steps) + ", the steps of the file");
        shape.declared.push_back(static_cast<int>(value));
    }
}

namespace {

const std::string how_times_are = "Write times that increase from step to step, in seconds";

/// Whether a trial has each of the steps.
std::vector<char> steps_there(const RecordLayout& layout, std::int64_t trial) {
    std::vector<char> there(static_cast<std::size_t>(layout.shape.steps), 0);
    for (const RecordDataset* dataset : layout.data.leading()) {
        RecordExtents first(dataset->extents().size(), 0), count = dataset->extents();
        if (!layout.single) first[0] = static_cast<std::uint64_t>(trial), count[0] = 1;
        std::size_t size = 1;
        for (const std::uint64_t extent : count) size *= extent;
        std::vector<double> values(size);
        dataset->read(first, count, values);
        for (std::size_t i = 0; i < size; ++i)
            if (!std::isnan(values[i])) there[i / (size / there.size())] = 1;
    }
    return there;
}

/// Refuses a step of the trial that is there and has no time.
void require_times(const std::vector<double>& times, std::int64_t trial, const RecordLayout& layout,
                   const std::string& place) {
    if (std::ranges::none_of(times, [](double time) { return std::isnan(time); })) return;
    const std::vector<char> there = steps_there(layout, trial);
    for (std::size_t k = 0; k < times.size() && layout.shape.covers(trial, static_cast<int>(k)); ++k)
        if (std::isnan(times[k]) && there[k])
            throw RecordError(place,
                              "trial " + std::to_string(trial) + ", step " + std::to_string(k) +
                                  " (both counted from 0) is there and has no time: it is NaN",
                              how_times_are);
}

/// The times of a trial's steps; `which` begins the message where they do not increase.
void require_increasing(const std::vector<double>& times, std::int64_t trial, const RecordShape& shape,
                        const std::string& place, const std::string& which) {
    double before = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < times.size() && shape.covers(trial, static_cast<int>(k)); ++k) {
        if (std::isnan(times[k])) continue;
        if (!(times[k] > before) || std::isinf(times[k]))
            throw RecordError(place,
                              which + "step " + std::to_string(k) + " (counted from 0) has " + to_text(times[k]) +
                                  ", and the time before is " + to_text(before),
                              how_times_are);
        before = times[k];
    }
}

}  // namespace

void check_time(const RecordSource& source, RecordLayout& layout) {
    RecordShape& shape = layout.shape;
    if (!source.has("time")) return;
    const DatasetPointer dataset = source.open("time", Numbers::any);
    const RecordExtents& extents = dataset->extents();
    const std::uint64_t trials = static_cast<std::uint64_t>(shape.trials),
                        steps = static_cast<std::uint64_t>(shape.steps);
    const bool common = extents == RecordExtents{steps};
    if (!common && extents != RecordExtents{trials, steps})
        throw RecordError(dataset->place(),
                          "does not fit: it is " + extents_text(extents) + ", and there are " + std::to_string(trials) +
                              " trials and " + std::to_string(steps) + " steps",
                          "Write it as [step], or as [trial, step]");
    std::vector<double> times(steps);
    for (std::uint64_t trial = 0; trial < (common ? 1 : trials); ++trial) {
        dataset->read(common ? RecordExtents{0} : RecordExtents{trial, 0},
                      common ? RecordExtents{steps} : RecordExtents{1, steps}, times);
        require_increasing(times, static_cast<std::int64_t>(trial), shape, dataset->place(),
                           common ? "" : "trial " + std::to_string(trial) + ", ");
        for (std::uint64_t of = trial; of < (common ? trials : trial + 1); ++of)
            require_times(times, static_cast<std::int64_t>(of), layout, dataset->place());
        if (shape.trials < least_segments) shape.times.push_back(times);
    }
}

}  // namespace credence
