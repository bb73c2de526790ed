// Segments of a few long runs in place of trials: their evidence, and whether they are as independent as they should
// be.

#include "statistics/autocorrelation.hpp"
#include "statistics/mean_bounds.hpp"
#include "statistics/moments/trial_moments.hpp"
#include "verdict/judgement.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace credence {

namespace {

constexpr double doubted =
    0.01;  ///< the level at which segments count as dependent, or runs as different, of all series

/// One number of each segment, run by run: NEES/dim of a group, or the mean standardised error of a component.
struct SegmentSeries {
    std::string name;
    std::map<std::int64_t, std::map<std::int64_t, double>> values;  ///< by run, then by segment

    double mean(const std::map<std::int64_t, double>& of_run) const {
        double sum = 0;
        for (const auto& [segment, value] : of_run) sum += value;
        return sum / static_cast<double>(of_run.size());
    }
};

/// `run`: of each segment.
std::vector<SegmentSeries> series_of(const Evidence& evidence, const std::vector<std::int64_t>& run) {
    std::vector<SegmentSeries> all;
    const TrialMoments& moments = *evidence.moments;
    const auto add = [&](const std::string& name, auto value) {
        SegmentSeries series{name, {}};
        for (std::size_t i = 0; i < moments.trials(); ++i)
            if (const double x = value(i); !std::isnan(x))
                series.values[run[static_cast<std::size_t>(moments.trial[i])]][moments.trial[i]] = x;
        all.push_back(std::move(series));
    };
    for (int g = 0; g < moments.groups; ++g)
        add("NEES of " + evidence.groups[static_cast<std::size_t>(g)].name,
            [&](std::size_t i) { return moments.X(i, g); });
    for (int j = 0; j < moments.components; ++j)
        add("errors of " + evidence.bias[static_cast<std::size_t>(j)].component,
            [&](std::size_t i) { return moments.z(i, j); });
    return all;
}

/// Whether one segment is like the next: the correlation of neighbours in a run is shown, at `level`, to be more than
/// segments of ten autocorrelation times have, which is some 0.05. It makes intervals 10 % too narrow.
bool neighbours_are_alike(const SegmentSeries& series, double level) {
    double products = 0, squares = 0, pairs = 0, values = 0, runs = 0;
    for (const auto& [run, of_run] : series.values) {
        const double mean = series.mean(of_run);
        ++runs;
        for (auto at = of_run.begin(); at != of_run.end(); ++at, ++values) {
            squares += (at->second - mean) * (at->second - mean);
            const auto next = std::next(at);
            if (next == of_run.end() || next->first != at->first + 1) continue;
            products += (at->second - mean) * (next->second - mean);
            ++pairs;
        }
    }
    if (!(squares > 0) || pairs < 2) return false;
    constexpr double allowed = 0.1;
    // Of independent values about their own mean it is about -1/values of a run.
    const double correlation = products / pairs / (squares / values) + runs / values;
    return correlation > allowed + normal_quantile(2 * level) / std::sqrt(pairs);
}

/// The slopes of a series over its segments, one a run: squares that they explain, of as many runs, and squares that
/// are left; and the slope of largest size as the change from the first to the last segment, with its variance over
/// that of what is left.
struct Slopes {
    double runs = 0, explained = 0, left = 0, degrees = 0, largest = 0, variance = 0;
};

Slopes slopes_of(const SegmentSeries& series) {
    Slopes slopes;
    for (const auto& [run, of_run] : series.values) {
        const auto count = static_cast<double>(of_run.size());
        if (count < 3) continue;
        const double mean = series.mean(of_run), first = static_cast<double>(of_run.begin()->first),
                     middle = (first + static_cast<double>(of_run.rbegin()->first)) / 2;
        double xx = 0, xy = 0, yy = 0;
        for (const auto& [segment, value] : of_run) {
            const double x = static_cast<double>(segment) - middle;
            xx += x * x;
            xy += x * (value - mean);
            yy += (value - mean) * (value - mean);
        }
        ++slopes.runs;
        slopes.explained += xy * xy / xx;
        slopes.left += yy - xy * xy / xx;
        slopes.degrees += count - 2;
        const double change = xy / xx * 2 * (middle - first);
        if (std::abs(change) <= std::abs(slopes.largest)) continue;
        slopes.largest = change;
        slopes.variance = 4 * (middle - first) * (middle - first) / xx;
    }
    return slopes;
}

/// Whether runs differ by more than their segments say.
bool runs_differ(const SegmentSeries& series, double level) {
    double all = 0, count = 0;
    for (const auto& [run, of_run] : series.values)
        for (const auto& [segment, value] : of_run) all += value, ++count;
    const double mean = all / count, runs = static_cast<double>(series.values.size());
    double between = 0, within = 0;
    for (const auto& [run, of_run] : series.values) {
        const double of = series.mean(of_run);
        between += static_cast<double>(of_run.size()) * (of - mean) * (of - mean);
        for (const auto& [segment, value] : of_run) within += (value - of) * (value - of);
    }
    if (runs < 2 || count - runs < 1 || !(within > 0)) return false;
    return between / (runs - 1) > within / (count - runs) * f_upper_quantile(level, runs - 1, count - runs);
}

/// As which segments count that are too few to show their spread, and runs of which something was drawn once.
double independent_segments(const Evidence& evidence) {
    return static_cast<double>(std::max<std::size_t>(1, evidence.segments.run.size()));
}
double independent_runs(const Evidence& evidence) {
    return evidence.trials < runs_that_tell ? static_cast<double>(evidence.trials) : independent_segments(evidence);
}

void judge_size_of_run(const Evidence& evidence, std::size_t g, Judgement& judgement) {
    const GroupEvidence& group = evidence.groups[g];
    if (!(group.run.count > 0) || is_rounded(group, judgement.limits())) return;
    const double level = level_of_group(levels::run, static_cast<int>(g), static_cast<int>(evidence.groups.size())) / 2;
    const auto judge_mean = [&](double mean, double runs, Side side) {
        const Interval bounds = bounds_at_any_correlation(runs, group.dimension, level);
        const Interval interval{mean / bounds.high, mean / bounds.low};
        if (side_of(interval, judgement.limits().margin) != side) return false;
        judgement.add(side, {Subject::size, Fault{}, group.name, "over all steps", mean, interval, "NEES/dim"});
        return true;
    };
    const double runs = independent_runs(evidence);
    if (judge_mean(group.run.mean, runs, Side::above) || judge_mean(group.run.mean, runs, Side::below)) return;
    if (group.centred.count > 0) judge_mean(group.centred.mean, independent_segments(evidence), Side::above);
}

/// Of segments of that length.
std::string steps_needed(double length) { return std::to_string(std::llround(least_segments * length)); }

/// Why segments that do not count decide nothing.
std::string too_few(const Evidence& evidence) {
    const std::string logs = evidence.trials == 1 ? "this log is" : "these logs are";
    return logs + " worth about " + evidence.segments.worth() + ": " + std::to_string(least_segments) +
           " are needed, some " + steps_needed(evidence.segments.steps) + " steps";
}

/// Those series in which the runs differ by more than their segments say, the first of them. Few runs are compared
/// without the offsets, in which they always differ.
std::string differing_runs(const Evidence& segments, const std::vector<std::int64_t>& run, bool centred) {
    if (!segments.moments) return {};
    std::vector<SegmentSeries> all = series_of(segments, run);
    if (centred) all.resize(segments.groups.size());
    for (const SegmentSeries& series : all)
        if (runs_differ(series, doubted / static_cast<double>(all.size()))) return series.name;
    return {};
}

}  // namespace

Evidence by_segments(Evidence runs, Evidence segments, const std::optional<Evidence>& centred) {
    segments.segments = runs.segments;
    if (std::string differ = differing_runs(centred ? *centred : segments, runs.segments.run, centred.has_value());
        !differ.empty()) {
        runs.segments.differ = differ;
        runs.segments.count = false;
        runs.segments.run.clear();
        return runs;
    }
    for (std::size_t g = 0; g < runs.groups.size(); ++g) {
        runs.groups[g].run = segments.groups[g].run;
        runs.groups[g].largest = segments.groups[g].largest;
        runs.groups[g].accuracy.ratio = segments.groups[g].accuracy.ratio;
        runs.groups[g].accuracy.ratio_ci95 = segments.groups[g].accuracy.ratio_ci95;
    }
    for (std::size_t i = 0; i < runs.charts.size(); ++i) runs.charts[i].run = segments.charts[i].run;
    const std::vector<Drift> drifts = drifts_of(segments);
    for (std::size_t j = 0; j < runs.bias.size(); ++j) {
        BiasEvidence& bias = runs.bias[j];
        bias.square = segments.bias[j].square;
        bias.largest_square = segments.bias[j].largest_square;
        if (runs.trials >= runs_that_tell) continue;
        bias.run = segments.bias[j].run;
        if (j >= drifts.size()) continue;
        bias.drift = drifts[j].size;
        bias.drift_half_width = drifts[j].half_width;
        if (centred) bias.centred = centred->bias[j].square;
    }
    if (centred) runs.centred = centred->moments;
    for (NisEvidence& nis : runs.nis)
        for (const NisEvidence& of_segments : segments.nis)
            if (of_segments.part == nis.part) {
                nis.ratio = of_segments.ratio;
                nis.ratio95 = of_segments.ratio95;
                nis.run = of_segments.run;
            }
    runs.whiteness = std::move(segments.whiteness);
    runs.moments = std::move(segments.moments);
    return runs;
}

std::vector<Drift> drifts_of(const Evidence& segments) {
    if (!segments.moments) return {};
    const std::vector<SegmentSeries> all = series_of(segments, segments.segments.run);
    const double level = doubted / static_cast<double>(all.size() - segments.groups.size());
    std::vector<Drift> drifts;
    for (std::size_t s = segments.groups.size(); s < all.size(); ++s) {
        const Slopes slopes = slopes_of(all[s]);
        const double left = slopes.left / slopes.degrees;
        drifts.emplace_back();
        if (!(slopes.degrees > 0) || !(left > 0) ||
            !(slopes.explained / slopes.runs > left * f_upper_quantile(level, slopes.runs, slopes.degrees)))
            continue;
        drifts.back() = {slopes.largest, t_quantile(level, slopes.degrees) * std::sqrt(left * slopes.variance)};
    }
    return drifts;
}

Interval bounds_at_any_correlation(double runs, int dimension, double level) {
    const double exponent = -2 * std::log(level) / (runs * dimension);
    const auto solve = [&](double inside, double outside) {
        for (int i = 0; i < 200; ++i) {
            const double c = (inside + outside) / 2;
            (c - 1 - std::log(c) < exponent ? inside : outside) = c;
        }
        return outside;
    };
    return {solve(1, 0), solve(1, 2 * (2 + exponent))};
}

void judge_segments(const Evidence& evidence, Judgement& judgement) {
    if (evidence.has_offsets())
        judgement.not_shown("what is drawn once in a run, such as an offset, is seen once in each: " +
                                std::to_string(runs_that_tell) + " runs can tell",
                            false);
    if (!evidence.moments) return;
    const std::vector<SegmentSeries> all = series_of(evidence, evidence.segments.run);
    const double level = doubted / static_cast<double>(all.size());
    for (const SegmentSeries& series : all)
        if (neighbours_are_alike(series, level))
            judgement.not_shown("segments of " + std::to_string(evidence.segments.steps) +
                                    " steps are not independent: " + series.name + " are alike in one and the next",
                                false);
}

void judge_few_runs(const Evidence& evidence, Judgement& judgement) {
    if (!evidence.segments.differ.empty() && evidence.trials < least_segments)
        judgement.not_shown("the runs differ among each other, so that each counts as one: " + evidence.segments.differ,
                            false);
    if (!evidence.segments.outnumber(evidence.trials)) return;
    if (!judgement.has_findings())
        for (std::size_t g = 0; g < evidence.groups.size(); ++g) judge_size_of_run(evidence, g, judgement);
    judgement.not_shown(too_few(evidence), false);
}

Consistency judge_single_run(const Evidence& evidence, const Limits& limits) {
    Judgement judgement(limits);
    // Whatever the correlation of the steps, the mean of numbers with variance 1 has a variance of at most 1.
    const double level = levels::bias / static_cast<double>(std::max<std::size_t>(1, evidence.bias.size())),
                 most = normal_quantile(level) / std::sqrt(independent_runs(evidence));
    for (const BiasEvidence& bias : evidence.bias)
        if (const double z = bias.run.mean; bias.largest_error > rounding_error && std::abs(z) - most > limits.bias)
            judgement.add_bias({Subject::bias, Fault::biased, bias.component, "over all steps", z,
                                {z - most, z + most}, "mean error/sigma"});
    for (std::size_t g = 0; g < evidence.groups.size(); ++g) judge_size_of_run(evidence, g, judgement);
    const SegmentEvidence& segments = evidence.segments;
    std::string why = "one trial decides nothing: give more trials";
    if (segments.steps > 0)
        why = too_few(evidence);
    else if (std::isinf(segments.autocorrelation_time))
        why = "the errors of this log do not decorrelate, so it is worth one run: what was drawn once, such as the "
              "start or a map's offset, is seen once";
    else if (segments.autocorrelation_time > 0)
        why = "this log is worth about one run: its errors decorrelate over so many steps that " +
              std::to_string(least_segments) + " independent runs would take some " +
              steps_needed(independent_steps(segments.autocorrelation_time)) + " steps";
    judgement.not_shown(why, false);
    return judgement.consistency(evidence);
}

}  // namespace credence
