// Some steps of a record, spread evenly over it, to which causes are applied [verdict/applied.hpp].

#include <algorithm>

#include "record/read.hpp"

namespace credence {

/// At most 5,000, and 2^24 numbers.
SampledSteps sampled_steps(const RecordReader& reader, const std::vector<int>& components,
                           const std::vector<char>& counted, const SegmentEvidence& segments) {
    const auto n = std::ssize(components);
    const std::int64_t most = std::min<std::int64_t>(5000, (std::int64_t{1} << 24) / (3 * n * n + 1)),
                       every = segments.steps_of_runs / std::max<std::int64_t>(most, 1) + 1,
                       length = segments.steps > 0 ? segments.steps : reader.shape().steps,
                       parts = reader.shape().steps / length + 1;
    SampledSteps sample;
    Eigen::MatrixXd before;
    std::int64_t run = -1, behind = -2;
    each_present_step(reader, [&](const RecordStep& step, const CheckedStep& checked) {
        if (!counted[static_cast<std::size_t>(step.trial)]) return;
        if (!std::ranges::all_of(components, [&](int j) { return checked.has(j); })) return;
        const Eigen::MatrixXd P = covariance_of(checked, components);
        const bool follows = step.trial == run && step.step == behind;
        if (follows && !sample.steps.empty() && sample.steps.back().step + 1 == step.step)
            sample.steps.back().after = P;
        if ((step.step + step.trial) % every == 0)
            sample.steps.push_back({step.trial * parts + step.step / length, step.step, checked.e(components), P,
                                    follows ? before : Eigen::MatrixXd(), {}});
        before = P;
        run = step.trial;
        behind = step.step + 1;
    });
    return sample;
}

}  // namespace credence
