#include "record/read.hpp"

#include <credence/error.hpp>

#include "record/totals.hpp"

#include <chrono>

namespace credence {

Record read_record(const RecordReader& reader, const std::string& name, const ReportProgress& progress) {
    const auto start = std::chrono::steady_clock::now();
    const RecordShape& shape = reader.shape();
    RecordTotals totals(shape, name);
    RecordValues values;
    for (std::int64_t trial = 0; trial < shape.trials;) {
        std::int64_t trials = 1;
        for (int step = 0; step < shape.steps;) {
            const RecordPart part = reader.part_at(trial, step);
            reader.read(part, values);
            for_each_step(part, values, [&](const RecordStep& one) { totals.add(one); });
            step += part.steps;
            trials = part.trials;
        }
        trial += trials;
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        if (progress) progress({trial, shape.trials, seconds.count()});
    }
    return totals.finish();
}

Record read_in_chart(RecordReader reader, const std::string& name, const ReportProgress& progress, bool other,
                     const std::function<Record(bool)>& read_again) {
    std::optional<Manifold>& manifold = reader.manifold();
    const bool has_charts = manifold && manifold->has_charts();
    if (has_charts && other) manifold->take_other_chart();
    Record record = read_record(reader, name, progress);
    if (!has_charts) return record;
    record.chart = manifold->chart() == ErrorChart::local ? "local" : "global";
    record.in_other_chart = [read_again, other] { return read_again(!other); };
    return record;
}

namespace {

Record read_in_chart(const RecordArrays& arrays, const std::string& name, const ReportProgress& progress, bool other) {
    constexpr std::int64_t part_numbers = (std::int64_t{1} << 20) / 8;  // the arrays are in memory: a part fits a cache
    try {
        return read_in_chart(RecordReader(ArraySource(arrays), part_numbers), name, progress, other,
                             [&arrays, name](bool again) { return read_in_chart(arrays, name, {}, again); });
    } catch (const RecordError& error) {
        throw InputError(error.what() + (". " + error.remedy_of_arrays()) + ".");
    }
}

}  // namespace

Record read_record(const RecordArrays& arrays, const std::string& name, const ReportProgress& progress) {
    return read_in_chart(arrays, name, progress, false);
}

}  // namespace credence
