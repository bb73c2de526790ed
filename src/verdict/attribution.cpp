// What carries errors that are too large: their mean over the trials at each step, or their spread about it.

#include <algorithm>
#include <cmath>

#include "base/formatted.hpp"
#include "base/nan.hpp"
#include "verdict/judgement.hpp"

namespace credence {

namespace {

bool is_too_large(const Finding& finding) { return finding.what == Fault::optimistic; }

/// Whether the mean of some component is beyond three margins at some step, whatever it is at the others.
bool has_mean_at_a_step(const Evidence& evidence, double margin) {
    double tests = 0;
    for (const BiasEvidence& bias : evidence.bias) tests += static_cast<double>(bias.step.size());
    return std::ranges::any_of(evidence.bias, [&](const BiasEvidence& bias) {
        return std::ranges::any_of(bias.step, [&](const Moments& step) {
            const double half = step.count > 1 ? t_quantile(levels::bias / tests, step.count - 1) : nan;
            return std::abs(step.mean) - half * step.standard_error > margins_of_part * margin;
        });
    });
}

}  // namespace

Attribution attribute(const Evidence& evidence, const Consistency& verdict, const Evidence& about_means, double share) {
    constexpr double hardly_any = 0.1;
    const Consistency apart = judge(about_means, verdict.limits);
    const GroupEvidence& state = about_means.groups.front();
    Attribution found{Carrier::unknown, share, state.run.mean, over_steps95(state)};
    const auto is_mean = [](const Finding& one) { return one.about == Subject::bias || one.about == Subject::window; };
    const bool has_mean = std::ranges::any_of(verdict.findings, is_mean) ||
                          has_mean_at_a_step(evidence, verdict.limits.bias),
               has_spread = std::ranges::any_of(apart.findings, is_too_large),
               is_right = apart.findings.empty() && found.interval.low > 1 - verdict.limits.direction &&
                          found.interval.high < 1 + verdict.limits.direction;
    if (has_mean && has_spread) found.carrier = Carrier::both;
    else if (has_mean && is_right) found.carrier = Carrier::mean;
    else if (has_mean && apart.verdict == Verdict::pessimistic) found.carrier = Carrier::mean_beside_too_large_P;
    else if (has_spread && share < hardly_any) found.carrier = Carrier::spread;
    return found;
}

const std::string& carrier_name(Carrier carrier) {
    static const std::string names[] = {"mean", "mean beside too large P", "both", "spread", "unknown"};
    return names[static_cast<std::size_t>(carrier)];
}

std::string sentence(const Attribution& found) {
    static const char* const said[] = {
        "a mean error alone is too large: apart from it P is right",
        "a mean error is too large, and apart from it P is too large",
        "both a mean error and the spread about it are too large: apart from the mean P is still too small",
        "the spread of the errors is too large, not a mean error: apart from the mean P is still too small",
        "a mean error and the spread about it cannot be told apart yet"};
    return said[static_cast<std::size_t>(found.carrier)] +
           formatted(", NEES/dim %.2f (%.2f to %.2f); the mean of each step carries %.0f %% of the squared error",
                     found.nees, found.interval.low, found.interval.high, 100 * std::max(0.0, found.share));
}

}  // namespace credence
