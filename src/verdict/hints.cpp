// Hints beside a verdict: mistakes in writing a record or a filter that look like the findings at hand.

#include "base/formatted.hpp"
#include "verdict/consistency_parts.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace credence {

namespace {

/// All directions are off by nearly one factor: it is beyond three margins, and they differ little, and less than it.
void hint_at_scale(const Consistency& verdict, std::vector<std::string>& hints) {
    const std::vector<double>& spectrum = verdict.directions.spectrum;
    if (spectrum.size() < 2 || !(spectrum.front() > 0)) return;
    const double middle = std::log(spectrum.front() * spectrum.back()) / 2;
    const double half_spread = std::log(spectrum.back() / spectrum.front()) / 2;
    if (std::abs(middle) > std::log1p(3 * verdict.limits.direction) &&
        half_spread < std::min(std::abs(middle) / 3, std::log(2)))
        hints.push_back(formatted("every direction is off by a factor of about %.2g: a scale?", std::exp(middle)));
}

/// The errors have the size that P says, and yet some directions are far too large.
void hint_at_chart(const Evidence& evidence, Consistency& verdict) {
    const std::vector<double>& spectrum = verdict.directions.spectrum;
    const double size = evidence.groups.front().accuracy.ratio;
    if (spectrum.size() < 2 || !(std::abs(size - 1) < 0.03)) return;
    if (!(spectrum.back() > 1.5 && spectrum.front() < 1 / 1.2)) return;
    verdict.chart_doubted = true;
    verdict.hints.push_back(
        formatted("the size of the errors is right (RMSE/sigma %.3f) and their directions are wrong: is the error "
                  "in the chart and frame of P, and is a correlation missing?",
                  size));
}

/// Errors of an angle beyond half a turn.
void hint_at_angles(const Evidence& evidence, std::vector<std::string>& hints) {
    for (const BiasEvidence& component : evidence.bias)
        if (component.unit == "rad" && component.largest_error > 1.01 * std::numbers::pi)
            hints.push_back(formatted("errors of %s reach %.3g rad: were angles wrapped to half a turn?",
                                      component.component.c_str(), component.largest_error));
}

}  // namespace

void add_hints(const Evidence& evidence, Consistency& verdict) {
    if (!evidence.nis.empty() && evidence.whiteness.empty() && evidence.steps > 1)
        verdict.hints.push_back(
            "the correlation of innovations was not tested: no row was measured often enough");
    std::vector<std::string> causes;
    if (!verdict.findings.empty()) {
        if (const std::string repeated = repeated_trials(evidence); !repeated.empty())
            verdict.hints.push_back(repeated);
        causes = causes_of(evidence, verdict.limits);
    }
    std::ranges::copy(causes, std::back_inserter(verdict.hints));
    if (causes.empty()) hint_at_angles(evidence, verdict.hints);
    if (verdict.findings.empty()) return;
    if (causes.empty()) hint_at_scale(verdict, verdict.hints);
    hint_at_chart(evidence, verdict);
}

}  // namespace credence
