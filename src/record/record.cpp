#include "record/read.hpp"

#include <credence/error.hpp>

#include "record/presence.hpp"
#include "record/segments.hpp"
#include "record/totals.hpp"

#include <chrono>

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

}  // namespace

Record read_record(const RecordReader& reader, const std::string& name, const ReportProgress& progress, int segments) {
    return read_record(reader, name, progress, segments, DivergedTrials::set_aside, Copies::fail);
}

Record read_in_chart(RecordReader reader, const std::string& name, const ReportProgress& progress, int segments,
                     int chart, const std::function<Record(int)>& read_again) {
    std::optional<Manifold>& manifold = reader.manifold();
    if (manifold) manifold->take_chart(chart);
    Record record = read_record(reader, name, progress, segments);
    const int charts = manifold ? manifold->charts() : 1;
    if (charts > 1) record.chart = manifold->chart();
    for (int other = 1; chart == 0 && other < charts; ++other)
        record.in_other_charts.push_back([read_again, other] { return read_again(other); });
    return record;
}

namespace {

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

Record read_in_chart(const RecordArrays& arrays, const std::string& name, const ReportProgress& progress, int segments,
                     int chart) {
    return with_reader(arrays, [&](RecordReader reader) {
        return read_in_chart(
            std::move(reader), name, progress, segments, chart,
            [&arrays, name, segments](int again) { return read_in_chart(arrays, name, {}, segments, again); });
    });
}

}  // namespace

Record read_record(const RecordArrays& arrays, const std::string& name, const ReportProgress& progress, int segments) {
    return read_in_chart(arrays, name, progress, segments, 0);
}

void check_record(const RecordArrays& arrays) {
    with_reader(arrays, [](const RecordReader& reader) {
        PresenceChecker presence(reader.shape());
        CheckedStep checked;
        each_step(reader, [&](const RecordStep& step) {
            if (step.step == 0) presence.start_trial();
            if (reader.shape().covers(step.trial, step.step)) presence.check(step, checked);
        });
    });
}

}  // namespace credence
