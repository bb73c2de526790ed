#include "record/read.hpp"

#include <credence/error.hpp>

#include "record/presence.hpp"
#include "record/segments.hpp"
#include "record/totals.hpp"

#include <algorithm>
#include <chrono>
#include <type_traits>

namespace credence {

void each_step(const RecordReader& reader, const std::function<void(const RecordStep&)>& use,
               const ReportProgress& progress) {
    const auto start = std::chrono::steady_clock::now();
    const RecordShape& shape = reader.shape();
    RecordValues values;
    reader.each_part([&](const RecordPart& part) {
        reader.read(part, values);
        for_each_step(part, values, use);
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        if (progress && part.first_step + part.steps == shape.steps)
            progress({part.first_trial + part.trials, shape.trials, seconds.count()});
        return true;
    });
}

void each_checked_step(const RecordReader& reader,
                       const std::function<void(const RecordStep&, Presence, const CheckedStep&)>& use) {
    PresenceChecker presence(reader.shape());
    CheckedStep checked;
    each_step(reader, [&](const RecordStep& step) {
        const Presence found = presence.check(step, checked);
        use(step, found, checked);
    });
}

void each_present_step(const RecordReader& reader,
                       const std::function<void(const RecordStep&, const CheckedStep&)>& use) {
    each_checked_step(reader, [&](const RecordStep& step, Presence presence, const CheckedStep& checked) {
        if (presence == Presence::there) use(step, checked);
    });
}

Eigen::MatrixXd covariance_of(const CheckedStep& step, const std::vector<int>& components) {
    if (step.P.size() > 0) return step.P(components, components);
    return step.variances(components).asDiagonal();
}

namespace {

Record read_record(const RecordReader& reader, const std::string& name, const ReportProgress& progress, int segments,
                   DivergedTrials diverged, Copies copies) {
    SegmentPlanner planner(reader.shape(), segments);
    RecordTotals totals(reader.shape(), name, diverged, copies, &planner);
    each_step(reader, [&](const RecordStep& one) { totals.add(one); }, progress);
    if (totals.agree_by_chance()) return read_record(reader, name, progress, segments, diverged, Copies::count);
    Record record = totals.finish();
    const TrialTotals& trials = record.results.arms.front().totals.trials;
    if (trials.diverged() > trials.counted())
        return read_record(reader, name, progress, segments, DivergedTrials::counted, copies);
    record.segments = planner.finish(reader, name);
    return record;
}

/// What `use` makes of the record, opened once more.
template <class Use>
auto of_reader(const OpenAgain& open_again, const Use& use) {
    std::invoke_result_t<Use, RecordReader> made;
    open_again([&](RecordReader again) { made = use(std::move(again)); });
    return made;
}

/// What `use` makes of a reader of arrays, a part of which fits a cache; errors have the places and remedies of arrays.
template <class Use>
auto with_reader(const RecordArrays& arrays, const Use& use) {
    constexpr std::int64_t part_numbers = (std::int64_t{1} << 20) / 8;
    const PlacesAreArrays named;
    try {
        return use(RecordReader(ArraySource(arrays), part_numbers));
    } catch (const RecordError& error) {
        Complaint complaint = error.complaint();
        complaint.remedy = error.remedy_of_arrays();
        throw InputError(complaint);
    }
}

}  // namespace

Record read_record(const RecordReader& reader, const std::string& name, const ReportProgress& progress, int segments) {
    return read_record(reader, name, progress, segments, DivergedTrials::set_aside, Copies::fail);
}

Record read_record(RecordReader reader, const std::string& name, const ReportProgress& progress, int segments,
                   const OpenAgain& open_again) {
    Record record = read_record(reader, name, progress, segments);
    const std::optional<Manifold>& manifold = reader.manifold();
    const int charts = manifold ? manifold->charts() : 1;
    if (charts > 1) record.chart = manifold->chart();
    for (int other = 1; other < charts; ++other)
        record.in_other_charts.push_back([=] {
            return of_reader(open_again, [&](RecordReader again) {
                again.manifold()->take_chart(other);
                Record read = read_record(again, name, {}, segments);
                read.chart = again.manifold()->chart();
                return read;
            });
        });
    std::vector<char> counted;
    const ArmResults& arm = record.results.arms.front();
    const std::vector<double>& statuses = arm.columns.in_memory()[status_column(record.results.columns)];
    for (const double status : statuses) counted.push_back(counts(static_cast<Status>(static_cast<int>(status))));
    if (std::ranges::count(counted, 1) >= least_segments && has_step_means(reader.shape()))
        record.about_means = [=] {
            return of_reader(open_again,
                             [&](const RecordReader& again) { return read_about_means(again, name, counted); });
        };
    std::vector<char> judged = counted;
    const TrialTotals& totals = arm.totals.trials;
    const bool with_diverged = totals.diverged_count || 10 * totals.diverged() > totals.counted();
    for (std::size_t i = 0; with_diverged && i < judged.size(); ++i)
        judged[i] = !failed(static_cast<Status>(static_cast<int>(statuses[i])));
    if (reader.shape().has_joint() || reader.shape().has_variances)
        record.sample = [=, segments_found = record.segments.found](const std::vector<int>& components) {
            return of_reader(open_again, [&](const RecordReader& again) {
                return sampled_steps(again, components, judged, segments_found);
            });
        };
    if (reader.shape().has_truth_covariance)
        record.truth = truth_evidence(reader, name, segments);
    else if (reader.shape().has_joint() || reader.shape().has_variances)
        record.truth_sigmas = [=](const std::vector<int>& components, const std::vector<double>& nees) {
            return of_reader(open_again,
                             [&](const RecordReader& again) { return truth_sigmas(again, components, nees); });
        };
    return record;
}

Record read_record(const RecordArrays& arrays, const std::string& name, const ReportProgress& progress, int segments) {
    return with_reader(arrays, [&](RecordReader reader) {
        return read_record(std::move(reader), name, progress, segments, [&arrays](const auto& use) {
            with_reader(arrays, [&](RecordReader again) { use(std::move(again)); });
        });
    });
}

void check_record(const RecordArrays& arrays) {
    with_reader(arrays, [](const RecordReader& reader) { each_checked_step(reader, [](const auto&...) {}); });
}

}  // namespace credence
