#include <credence/record.hpp>

#include "files/record/file.hpp"
#include "files/record/totals.hpp"

#include <chrono>

namespace credence {

namespace {

void add_part(const RecordPart& part, const RecordShape& shape, const RecordValues& values, RecordTotals& totals) {
    const auto n = static_cast<std::size_t>(shape.n), m = static_cast<std::size_t>(shape.m);
    std::size_t i = 0;
    for (std::int64_t trial = part.first_trial; trial < part.first_trial + part.trials; ++trial)
        for (int k = part.first_step; k < part.first_step + part.steps; ++k, ++i) {
            RecordStep step{trial, k, &values.error[i * n], &values.covariance[i * n * n]};
            if (shape.has_innovations()) {
                step.innovation = &values.innovation[i * m];
                step.innovation_covariance = &values.innovation_covariance[i * m * m];
            }
            totals.add(step);
        }
}

}  // namespace

Record read_record(const RecordFile& file, const std::string& path,
                         const std::function<void(const Progress&)>& progress) {
    const auto start = std::chrono::steady_clock::now();
    const RecordShape& shape = file.shape();
    RecordTotals totals(shape, path);
    RecordValues values;
    for (std::int64_t trial = 0; trial < shape.trials;) {
        std::int64_t trials = 1;
        for (int step = 0; step < shape.steps;) {
            const RecordPart part = file.part_at(trial, step);
            file.read(part, values);
            add_part(part, shape, values, totals);
            step += part.steps;
            trials = part.trials;
        }
        trial += trials;
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        if (progress) progress({trial, shape.trials, seconds.count()});
    }
    return totals.finish();
}

Record read_record(const std::string& path, const std::function<void(const Progress&)>& progress) {
    return hdf5::read_file(path,
                           "A record holds `error` [trial, step, n] and `covariance` [trial, step, n, n], may hold "
                           "`innovation` [trial, step, m] and `innovation_covariance` [trial, step, m, m], and may "
                           "name parts of the state in the attribute `blocks`, such as `pose 0:3, feature_1 3:5`",
                           [&](const hdf5::Handle& root) { return read_record(RecordFile(root), path, progress); });
}

}  // namespace credence
