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

/// The autocorrelation of NEES is about its own mean, since P may have the wrong size; that of a standardised error
/// about 0, the mean of a filter that is right: an offset that was drawn once does not decorrelate.
void SegmentPlanner::add(std::int64_t run, const std::vector<std::size_t>& present,
                         const std::vector<Series>& all_series,
                         const std::function<double(std::size_t f, std::size_t k)>& value) {
    found_.steps_of_runs += std::ssize(present);
    if (wanted_ && !measures()) cut(run, present);
    if (!measures()) return;
    uncut_.emplace_back(run, present);
    for (std::size_t f = 0; f < all_series.size(); ++f) {
        const SeriesRole role = all_series[f].role;
        if (role != SeriesRole::nees && role != SeriesRole::standardised_error) continue;
        std::vector<double> known;
        double sum = 0;
        for (const std::size_t k : present)
            if (const double one = value(f, k); !std::isnan(one)) known.push_back(one), sum += one;
        const bool of_nees = role == SeriesRole::nees;
        Autocorrelation one = autocorrelation(known, of_nees ? sum / static_cast<double>(known.size()) : 0);
        if (!(one.time > found_.autocorrelation_time)) continue;
        found_.autocorrelation_time = one.time;
        found_.slowest = (of_nees ? "NEES/dim of " : "error/sigma of ") + all_series[f].part;
        found_.window = one.window;
        if (one.window > 0) one.by_lag.resize(std::min(one.by_lag.size(), 2 * one.window + 1));
        found_.correlation = std::move(one.by_lag);
    }
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
    const double length = independent_steps(found_.autocorrelation_time);
    if (measures() && length > 0 && length <= reader.shape().steps) {
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
    shape.columns.clear();  // one number a run
    RecordTotals totals(shape, name, LostTrials::counted, Copies::count);
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
