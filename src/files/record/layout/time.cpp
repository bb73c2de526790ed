// The datasets of a record that say how long each run is, and when its steps are.

#include <cmath>
#include <credence/text.hpp>
#include <limits>

#include "files/record/layout/parts.hpp"

namespace credence {

using hdf5::Error;
using hdf5::Extents;
using hdf5::extents_text;

void add_steps(const RecordSource& source, RecordShape& shape) {
    if (!source.has("steps")) return;
    const DatasetPointer dataset = source.open("steps", Numbers::any);
    const Extents& extents = dataset->extents();
    const Extents all{static_cast<hsize_t>(shape.trials)};
    if (extents != all)
        throw Error(dataset->place(),
                    "does not fit: it is " + extents_text(extents) + ", and there are " + std::to_string(shape.trials) +
                        " trials",
                    "Write it as [trial], the number of steps of each");
    std::vector<double> values(static_cast<std::size_t>(shape.trials));
    dataset->read({0}, all, values);
    for (const double value : values) {
        if (!(value >= 1 && value <= shape.steps && value == std::nearbyint(value)))
            throw Error(
                dataset->place(),
                "trial " + std::to_string(shape.declared.size()) + " (counted from 0) has " + to_text(value) + " steps",
                "Write whole numbers from 1 to " + std::to_string(shape.steps) + ", the steps of the file");
        shape.declared.push_back(static_cast<int>(value));
    }
}

namespace {

/// The times of a trial's steps; `which` begins the message where they do not increase.
void require_increasing(const std::vector<double>& times, std::int64_t trial, const RecordShape& shape,
                        const std::string& place, const std::string& which) {
    double before = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < times.size() && shape.covers(trial, static_cast<int>(k)); ++k) {
        if (std::isnan(times[k])) continue;
        if (!(times[k] > before) || std::isinf(times[k]))
            throw Error(place,
                        which + "step " + std::to_string(k) + " (counted from 0) has " + to_text(times[k]) +
                            ", and the time before is " + to_text(before),
                        "Write times that increase from step to step, in seconds");
        before = times[k];
    }
}

}  // namespace

void check_time(const RecordSource& source, const RecordShape& shape) {
    if (!source.has("time")) return;
    const DatasetPointer dataset = source.open("time", Numbers::any);
    const Extents& extents = dataset->extents();
    const hsize_t trials = static_cast<hsize_t>(shape.trials), steps = static_cast<hsize_t>(shape.steps);
    const bool common = extents == Extents{steps};
    if (!common && extents != Extents{trials, steps})
        throw Error(dataset->place(),
                    "does not fit: it is " + extents_text(extents) + ", and there are " + std::to_string(trials) +
                        " trials and " + std::to_string(steps) + " steps",
                    "Write it as [step], or as [trial, step]");
    std::vector<double> times(steps);
    for (hsize_t trial = 0; trial < (common ? 1 : trials); ++trial) {
        dataset->read(common ? Extents{0} : Extents{trial, 0}, common ? Extents{steps} : Extents{1, steps}, times);
        require_increasing(times, static_cast<std::int64_t>(trial), shape, dataset->place(),
                           common ? "" : "trial " + std::to_string(trial) + ", ");
    }
}

}  // namespace credence
