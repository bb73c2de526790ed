#include <credence/error.hpp>
#include <credence/record.hpp>

#include "files/record/reader.hpp"
#include "files/record/totals.hpp"

#include <chrono>

namespace credence {

Record read_record(const RecordReader& reader, const std::string& path,
                   const std::function<void(const Progress&)>& progress) {
    const auto start = std::chrono::steady_clock::now();
    const RecordShape& shape = reader.shape();
    RecordTotals totals(shape, path);
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

namespace {

using ReportProgress = std::function<void(const Progress&)>;

/// Reads the record in its own chart or, of states on a manifold with charts, in the other one. `read_again(other)`
/// does the same once more.
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

Record read_file_in_chart(const std::string& path, const ReportProgress& progress, bool other) {
    return hdf5::read_file(path,
                           "A record holds `error` [trial, step, n] and `covariance` [trial, step, n, n], may hold "
                           "`innovation` [trial, step, m] and `innovation_covariance` [trial, step, m, m], and may "
                           "name component groups in the attribute `groups`, such as `pose 0:3, feature_1 3:5`",
                           [&](const hdf5::Handle& root) {
                               return read_in_chart(RecordReader(FileSource(root)), path, progress, other,
                                                    [path](bool again) { return read_file_in_chart(path, {}, again); });
                           });
}

Record read_arrays_in_chart(const RecordArrays& arrays, const std::string& name, const ReportProgress& progress,
                            bool other) {
    constexpr std::int64_t part_numbers = (std::int64_t{1} << 20) / 8;  // the arrays are in memory: a part fits a cache
    try {
        return read_in_chart(RecordReader(ArraySource(arrays), part_numbers), name, progress, other,
                             [&arrays, name](bool again) { return read_arrays_in_chart(arrays, name, {}, again); });
    } catch (const hdf5::Error& error) {
        throw InputError(error.what() + (". " + error.remedy_of_arrays()) + ".");
    }
}

}  // namespace

Record read_record(const std::string& path, const ReportProgress& progress) {
    return read_file_in_chart(path, progress, false);
}

Record read_record(const RecordArrays& arrays, const std::string& name, const ReportProgress& progress) {
    return read_arrays_in_chart(arrays, name, progress, false);
}

}  // namespace credence
