#include "record/segments.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "record/presence.hpp"
#include "record/read.hpp"
#include "record/totals.hpp"
#include "statistics/autocorrelation.hpp"

namespace credence {

namespace {

/// Leaves what is not explained by a polynomial of this degree.
void remove_trend(std::vector<double>& values, int degree) {
    const auto count = static_cast<Eigen::Index>(values.size());
    if (count <= degree + 1) return;
    Eigen::MatrixXd powers(count, degree + 1);
    powers.col(0).setOnes();
    if (degree > 0) powers.col(1).setLinSpaced(-1, 1);
    for (int power = 2; power <= degree; ++power) powers.col(power) = powers.col(power - 1).cwiseProduct(powers.col(1));
    Eigen::Map<Eigen::VectorXd> all(values.data(), count);
    all -= powers * powers.householderQr().solve(all).eval();
}

/// Adds a step's errors to the sums of its run and of its segment.
void add_errors(const CheckedStep& step, std::vector<double>& of_run, std::vector<double>* of_segment) {
    const auto n = static_cast<std::size_t>(step.e.size());
    for (std::size_t j = 0; j < n; ++j) {
        if (!step.here.empty() && !step.here[j]) continue;
        const auto at = static_cast<Eigen::Index>(j);
        const double variance = step.P.size() > 0 ? step.P(at, at) : step.variances.size() > 0 ? step.variances(at) : 1;
        for (std::vector<double>* sums : {&of_run, of_segment})
            if (sums != nullptr && variance > 0) (*sums)[j] += step.e(at) / variance, (*sums)[n + j] += 1 / variance;
    }
}

/// The error of a step of a segment without the means.
std::vector<double> about_mean(const double* error, std::size_t segment, std::size_t run, const SegmentMeans& means) {
    const std::size_t n = means.drifts.size();
    std::vector<double> about(error, error + n);
    for (std::size_t j = 0; j < n; ++j) {
        const std::vector<double>& sums = means.drifts[j] ? means.of_segment[segment] : means.of_run[run];
        if (sums[n + j] > 0) about[j] -= sums[j] / sums[n + j];
    }
    return about;
}

}  // namespace

SegmentPlanner::SegmentPlanner(const RecordShape& shape, int asked)
    : asked_(asked),
      wanted_(asked > 0 || (asked == segments_auto && shape.trials <= most_runs_in_segments)),
      runs_(shape.trials),
      n_(shape.n) {
    if (asked > 0) found_.steps = asked;
}

/// The autocorrelation of NEES is about its own mean, since P may have the wrong size; that of a standardised error
/// about 0, the mean of a filter that is right: an offset that was drawn once does not decorrelate. Of too few runs to
/// tell such an offset from a bias, it is about the run's mean and its drift, a line, and that of NEES about a
/// parabola.
void SegmentPlanner::add(std::int64_t run, const std::vector<std::size_t>& present,
                         const std::vector<Series>& all_series,
                         const std::function<double(std::size_t f, std::size_t k)>& value) {
    const bool about_offset = runs_ < runs_that_tell;
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
        if (about_offset) remove_trend(known, of_nees ? 2 : 1);
        Autocorrelation one =
            autocorrelation(known, of_nees && !about_offset ? sum / static_cast<double>(known.size()) : 0);
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

void SegmentPlanner::cut_all(double steps) {
    found_.steps = static_cast<int>(steps);
    found_.run.clear();
    first_.clear();
    declared_.clear();
    for (const auto& [run, present] : uncut_) cut(run, present);
}

/// Ten autocorrelation times, and no more segments than moments are kept of. Where those are too few, as long as there
/// are enough of, down to five autocorrelation times. Then as many in the longest run, so long that they leave no step.
void SegmentPlanner::choose_length() {
    double longest = 0;
    for (const auto& [run, present] : uncut_)
        longest = std::max(longest, static_cast<double>(present.back() - present.front() + 1));
    const double time = found_.autocorrelation_time, most = detailed_trials(1, n_),
                 all = static_cast<double>(found_.steps_of_runs);
    const double length = std::max(independent_steps(time), std::ceil(all / most)),
                 shortest = std::ceil(independent_steps(time) / 2);
    if (!(time > 0) || !(shortest <= longest)) return;
    cut_all(std::min(length, longest));
    for (double parts = 1; std::ssize(found_.run) < least_segments && found_.steps > shortest; ++parts)
        if (const double steps = std::floor(longest / parts); steps < found_.steps) cut_all(std::max(steps, shortest));
    const double chosen = found_.steps, stretched = std::floor(longest / std::floor(longest / chosen));
    const auto count = std::ssize(found_.run);
    if (stretched == chosen) return;
    cut_all(stretched);
    if (std::ssize(found_.run) < count) cut_all(chosen);  // shorter runs have no room for as many
}

RecordSegments SegmentPlanner::finish(const RecordReader& reader, const std::string& name) {
    if (measures()) choose_length();
    RecordSegments segments{asked_, found_};
    segments.found.count =
        std::ssize(found_.run) >= least_segments && (!measures() || found_.outnumber(std::ssize(uncut_)));
    const bool centred = runs_ < runs_that_tell && reader.shape().has_errors && !found_.run.empty();
    if (!segments.found.count && !centred) return segments;
    SegmentMeans means;
    segments.results = std::make_shared<const ScenarioResults>(results(reader, name, centred ? &means : nullptr));
    if (!centred) return segments;
    Evidence evidence = evidence_of(*segments.results, segments.results->arms.front());
    evidence.segments = found_;
    for (const Drift& drift : drifts_of(evidence)) means.drifts.push_back(drift.size != 0);
    means.drifts.resize(static_cast<std::size_t>(n_));
    segments.centred = std::make_shared<const ScenarioResults>(results(reader, name, &means));
    if (!segments.found.count) segments.results.reset();
    return segments;
}

/// The same results as those of a record whose runs are the segments. Adds up `means` or, where these are there,
/// subtracts them.
ScenarioResults SegmentPlanner::results(const RecordReader& reader, const std::string& name,
                                        SegmentMeans* means) const {
    const bool subtracts = means != nullptr && !means->drifts.empty(), adds = means != nullptr && !subtracts;
    if (adds) {
        const std::vector<double> zero(2 * static_cast<std::size_t>(n_));
        means->of_run.assign(static_cast<std::size_t>(runs_), zero);
        means->of_segment.assign(found_.run.size(), zero);
    }
    PresenceChecker presence(reader.shape());
    CheckedStep checked;
    std::vector<double> about;
    RecordShape shape = reader.shape();
    shape.trials = std::ssize(found_.run);
    shape.steps = shape.longest = found_.steps;
    shape.declared = declared_;
    shape.columns.clear();  // one number a run
    RecordTotals totals(shape, name, DivergedTrials::counted, Copies::count);
    std::size_t next = 0;
    each_step(reader, [&](const RecordStep& one) {
        const bool inside = next < first_.size() && one.trial == found_.run[next] && one.step >= first_[next];
        if (adds && presence.check(one, checked) == Presence::there)
            add_errors(checked, means->of_run[static_cast<std::size_t>(one.trial)],
                       inside ? &means->of_segment[next] : nullptr);
        if (!inside) return;
        RecordStep step = one;
        if (subtracts) {
            about = about_mean(one.error, next, static_cast<std::size_t>(one.trial), *means);
            step.error = about.data();
        }
        step.trial = static_cast<std::int64_t>(next);
        step.step = one.step - first_[next];
        totals.add(step);
        if (step.step + 1 == found_.steps) ++next;
    });
    return totals.finish().results;
}

Evidence evidence_of(const Record& record) {
    Evidence evidence = evidence_of(record.results, record.results.arms.front());
    evidence.segments = record.segments.found;
    evidence.of_innovations = record.of_innovations;
    evidence.truth = record.truth;
    evidence.sample = record.sample;
    if (evidence.truth) evidence.diverged = evidence.truth->added.diverged;
    const auto of = [](const ScenarioResults& results) { return evidence_of(results, results.arms.front()); };
    std::optional<Evidence> centred;
    if (record.segments.centred) centred = of(*record.segments.centred);
    for (std::size_t g = 0; centred && g < evidence.groups.size(); ++g)
        evidence.groups[g].centred = centred->groups[g].run;
    if (!evidence.segments.count) return evidence;
    return by_segments(std::move(evidence), of(*record.segments.results), centred);
}

}  // namespace credence
