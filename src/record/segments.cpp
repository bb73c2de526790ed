#include "record/segments.hpp"

#include "record/read.hpp"
#include "record/totals.hpp"
#include "statistics/autocorrelation.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

SegmentPlanner::SegmentPlanner(const RecordShape& shape, int asked)
    : asked_(asked), wanted_(asked > 0 || (asked == segments_auto && shape.trials < least_segments)) {
    if (asked > 0) found_.steps = asked;
}

void SegmentPlanner::add(std::int64_t run, const std::vector<std::size_t>& present) {
    found_.steps_of_runs += std::ssize(present);
    if (wants_series()) uncut_.emplace_back(run, present);
    else if (wanted_) cut(run, present);
}

void SegmentPlanner::add_series(const std::vector<double>& values, double mean) {
    found_.autocorrelation_time = std::max(found_.autocorrelation_time, autocorrelation_time(values, mean));
}

/// A segment begins with a step that exists, so that a long gap ends one, and is left out where it lacks half of its
/// steps or more, or where its run ends in it.
void SegmentPlanner::cut(std::int64_t run, const std::vector<std::size_t>& present) {
    const auto length = static_cast<std::size_t>(found_.steps);
    for (auto at = present.begin(); at != present.end() && *at + length <= present.back() + 1;) {
        const auto next = std::lower_bound(at, present.end(), *at + length);
        if (2 * static_cast<std::size_t>(next - at) > length) {
            found_.run.push_back(run);
            first_.push_back(static_cast<int>(*at));
            declared_.push_back(static_cast<int>(*(next - 1) - *at) + 1);
        }
        at = next;
    }
}

RecordSegments SegmentPlanner::finish(const RecordReader& reader, const std::string& name) {
    constexpr double times = 10;  // with fewer, intervals of few segments are too narrow
    const double length = std::ceil(times * found_.autocorrelation_time);
    if (wants_series() && length > 0 && length <= reader.shape().steps) {
        found_.steps = static_cast<int>(length);
        for (const auto& [run, present] : uncut_) cut(run, present);
    }
    RecordSegments segments{asked_, found_};
    segments.found.count = std::ssize(found_.run) >= least_segments;
    if (segments.found.count) segments.results = std::make_shared<const ScenarioResults>(results(reader, name));
    return segments;
}

/// The same results as those of a record whose runs are the segments.
ScenarioResults SegmentPlanner::results(const RecordReader& reader, const std::string& name) const {
    RecordShape shape = reader.shape();
    shape.trials = std::ssize(found_.run);
    shape.steps = shape.longest = found_.steps;
    shape.declared = declared_;
    RecordTotals totals(shape, name);
    std::size_t next = 0;
    each_step(reader, [&](const RecordStep& one) {
        if (next == first_.size() || one.trial != found_.run[next] || one.step < first_[next]) return;
        RecordStep step = one;
        step.trial = static_cast<std::int64_t>(next);
        step.step = one.step - first_[next];
        totals.add(step);
        if (step.step + 1 == found_.steps) ++next;
    });
    return totals.finish().results;
}

}  // namespace credence
