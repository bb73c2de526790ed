#include "record/segments.hpp"

#include <credence/evidence.hpp>

#include "record/read.hpp"
#include "record/totals.hpp"
#include "statistics/autocorrelation.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

SegmentPlanner::SegmentPlanner(const RecordShape& shape, int asked)
    : asked_(asked), few_runs_(shape.trials < least_segments) {
    found_.asked = asked;
}

void SegmentPlanner::add(std::int64_t run, const std::vector<std::size_t>& present) {
    ++found_.runs;
    found_.steps_of_runs += std::ssize(present);
    if (asked_ == segments_off || (asked_ == segments_auto && !few_runs_)) return;
    runs_.push_back(run);
    present_.push_back(present);
}

void SegmentPlanner::add_series(const std::vector<double>& values, double mean) {
    time_ = std::max(time_, autocorrelation_time(values, mean));
}

/// A segment begins with a step that exists, so that a long gap ends one, and is left out where it lacks half of its
/// steps or more, or where its run ends in it.
void SegmentPlanner::cut_runs() {
    const auto length = static_cast<std::size_t>(found_.steps);
    for (std::size_t r = 0; r < runs_.size(); ++r) {
        const std::vector<std::size_t>& present = present_[r];
        for (auto at = present.begin(); at != present.end() && *at + length <= present.back() + 1;) {
            const auto next = std::lower_bound(at, present.end(), *at + length);
            if (2 * static_cast<std::size_t>(next - at) > length) {
                found_.run.push_back(runs_[r]);
                first_.push_back(static_cast<int>(*at));
                declared_.push_back(static_cast<int>(*(next - 1) - *at) + 1);
            }
            at = next;
        }
    }
}

RecordSegments SegmentPlanner::finish(const RecordReader& reader, const std::string& name) {
    constexpr double times = 10;  // with fewer, intervals of few segments are too narrow
    const RecordShape& shape = reader.shape();
    if (runs_.empty()) return std::move(found_);
    if (asked_ == segments_auto) found_.autocorrelation_time = time_;
    const double length = asked_ == segments_auto ? std::ceil(times * time_) : asked_;
    if (!(length <= shape.steps)) return std::move(found_);
    found_.steps = std::max(1, static_cast<int>(length));
    cut_runs();
    if (std::ssize(found_.run) >= least_segments)
        found_.results = std::make_shared<const ScenarioResults>(results(reader, name));
    return std::move(found_);
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
