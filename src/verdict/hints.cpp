// Hints beside a verdict: mistakes in writing a record or a filter that look like the findings at hand.

#include "base/formatted.hpp"
#include "numeric/chi_square.hpp"
#include "statistics/goodness.hpp"
#include "verdict/judgement.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>
#include <numeric>

namespace credence {

namespace {

using Steps = std::vector<Moments>::const_iterator;

/// The mean over some steps.
double mean_of(Steps from, Steps to) {
    return std::accumulate(from, to, 0.0, [](double sum, const Moments& step) { return sum + step.mean; }) /
           static_cast<double>(to - from);
}

/// Errors of an angle beyond half a turn.
std::string turns_of(const Evidence& evidence) {
    for (const BiasEvidence& component : evidence.bias)
        if (component.unit == "rad" && component.largest_error > 1.01 * std::numbers::pi)
            return formatted("errors of %s reach %.3g rad: were angles wrapped to half a turn?",
                             component.component.c_str(), component.largest_error);
    return {};
}

/// NEES/dim is right at one end of a run, and not at the other, which is that `at_start` or the last.
std::string trend_of(const Evidence& evidence, const Limits& limits, bool at_start) {
    const std::vector<Moments>& steps = evidence.groups.front().step;
    constexpr std::size_t least_steps = 4;
    if (steps.size() < least_steps) return {};
    const double trials = evidence.groups.front().dimension * static_cast<double>(evidence.trials),
                 right = std::log1p(3 * limits.margin), noise = 3 * std::sqrt(2 / trials),
                 wrong = std::log(1.3) + noise;
    const auto some = std::max<std::ptrdiff_t>(2, std::ssize(steps) / 5);
    const double last = std::accumulate(steps.end() - some, steps.end(), 0.0,
                                        [](double sum, const Moments& step) { return sum + std::log(step.mean); }) /
                        static_cast<double>(some);
    const double first = std::log(steps.front().mean);
    const auto smaller = [&](const Moments& step) { return std::abs(std::log(step.mean)) < std::abs(first) + noise; };
    const auto said = [&](const char* what) {
        return formatted("NEES/dim is %.2g at the first step and %.2g at the last: ", std::exp(first), std::exp(last)) +
               what;
    };
    if (at_start && std::abs(first) > wrong && std::abs(last) < right && std::ranges::all_of(steps, smaller))
        return said("is P at the start that of the first errors, and are these small enough to linearise?");
    if (!at_start && !innovations_are_right(evidence, limits) && last > wrong &&
        std::abs(first) < std::max(right, last / 3))
        return said("do errors build up that P does not know of (bias, drift, delay, process noise)?");
    return {};
}

/// How far the median of NEES is from that of chi-square, as a share of where a factor on P would take it.
double share_of_factor(const GroupEvidence& state) {
    const double median = coverage_levels[0],
                 by_factor = 1 - chi_square_p(stable_chi_square_quantile(median, state.dimension) / state.run.mean,
                                              state.dimension);
    return (median - state.coverage.front().over_steps) / (median - by_factor);
}

/// Few steps are wrong, in either half of the runs, and the others are not: their NEES has nearly the right median.
std::string few_of(const Evidence& evidence, const Limits& limits) {
    const GroupEvidence& state = evidence.groups.front();
    const double excess = state.run.mean - 1;
    if (!(excess > 3 * limits.margin) || state.coverage.empty()) return {};
    const auto middle = state.step.begin() + std::ssize(state.step) / 2;
    if (state.step.size() > 1 &&
        !(std::min(mean_of(state.step.begin(), middle), mean_of(middle, state.step.end())) > 1 + excess / 3))
        return {};
    if (!(share_of_factor(state) < 0.3)) return {};
    return formatted("NEES is below its median in %.0f %% of the steps, as it should be, and few steps carry what is "
                     "too large: outliers%s? The worst are named",
                     100 * state.coverage.front().over_steps,
                     evidence.trials == 1 ? "" : ", or a few trials that are wrong");
}

/// All directions are off by nearly one factor: it is beyond three margins, and they differ little, and less than it.
std::string scale_of(const Evidence& evidence, const Consistency& verdict) {
    const std::vector<double>& spectrum = verdict.directions.spectrum;
    if (spectrum.size() < 2 || !(spectrum.front() > 0)) return {};
    const double middle = std::log(spectrum.front() * spectrum.back()) / 2,
                 half_spread = std::log(spectrum.back() / spectrum.front()) / 2;
    if (!(std::abs(middle) > std::log1p(3 * verdict.limits.direction)) ||
        !(half_spread < std::min(std::abs(middle) / 3, std::log(2))))
        return {};
    const double factor = evidence.groups.front().run.mean;
    return formatted("P is too %s by a factor of about %.2g in every direction", factor > 1 ? "small" : "large",
                     std::max(factor, 1 / factor));
}

/// Innovations whose size and whose correlation are both off: a gain that is too small leaves the next innovation
/// alike, one that is too large turns it back [Mehra 1970].
std::string noise_of(const Evidence& evidence, const Limits& limits) {
    if (evidence.nis.empty() || evidence.whiteness.empty() || evidence.groups.empty()) return {};
    const NisEvidence& nis = evidence.nis.front();
    const Whiteness& lag = evidence.whiteness.front();
    const Side side = side_of(nis.ratio95, limits.margin);
    const GroupEvidence& state = evidence.groups.front();
    const bool errors_agree = (state.run.mean > 1) == (side == Side::above);
    if (side == Side::inside || !errors_agree || !(std::abs(lag.scaled) > lag.simultaneous_bound)) return {};
    const bool alike = lag.scaled > 0;
    // An outlier turns the innovations back, too.
    if (!alike && side == Side::above && !state.coverage.empty() && share_of_factor(state) < 0.6) return {};
    return formatted("the innovations are %s than S says (NIS/m %.2f) and ", side == Side::above ? "larger" : "smaller",
                     nis.ratio) +
           (alike ? "alike from one to the next: " : "turn back from one to the next: ") +
           (side == Side::above
                ? alike ? "does the filter follow too slowly (process noise too small, or a motion or a drift that it "
                          "does not know of)?"
                        : "does the filter follow too closely (measurement noise too small, or a measurement used "
                          "twice)?"
                : alike ? "is the measurement noise too large?"
                        : "is the process noise too large?");
}

/// The errors have the size that P says, and yet some directions are far too large.
std::string doubt_chart(const Evidence& evidence, Consistency& verdict) {
    const std::vector<double>& spectrum = verdict.directions.spectrum;
    const double size = evidence.groups.front().accuracy.ratio;
    if (spectrum.size() < 2 || !(std::abs(size - 1) < 0.03)) return {};
    if (!(spectrum.back() > 1.5 && spectrum.front() < 1 / 1.2)) return {};
    verdict.chart_doubted = true;
    return formatted("the size of the errors is right (RMSE/sigma %.3f) and their directions are wrong: is the error "
                     "in the chart and frame and of the step of P, and is a correlation missing?",
                     size);
}

}  // namespace

bool innovations_are_right(const Evidence& evidence, const Limits& limits) {
    const auto is_correlated = [](const Whiteness& lag) { return std::abs(lag.scaled) > lag.simultaneous_bound; };
    if (evidence.nis.empty()) return false;
    const NisEvidence& nis = evidence.nis.front();
    return (std::abs(nis.ratio - 1) < limits.margin || (nis.ratio95.low < 1 && nis.ratio95.high > 1)) &&
           std::ranges::none_of(evidence.whiteness, is_correlated);
}

std::string divergence_of(const Evidence& evidence) {
    if (evidence.groups.empty()) return {};
    const GroupEvidence& state = evidence.groups.front();
    if (!(state.run.mean > diverged_nees_ratio) || state.step.size() < 2) return {};
    constexpr double many = 20;  // runs: one of them may have small errors at first by chance
    const bool are_many = state.step.front().count >= many;
    const auto some = std::max<std::ptrdiff_t>(1, std::ssize(state.step) / 5);
    const double first = mean_of(state.step.begin(), state.step.begin() + (are_many ? 1 : some)),
                 last = mean_of(state.step.end() - some, state.step.end());
    if (!(last > (are_many ? 3 : 10) * first)) return {};
    return formatted("the filter diverges, NEES/dim is %.2g at first and %.2g at last: is a Jacobian wrong, or does P "
                     "not know of a drift or of process noise? Finite differences show a wrong one (in C++ "
                     "jacobian_mismatch of credence/filters.hpp)", first, last);
}

std::vector<std::string> causes_of(const Evidence& evidence, Consistency& verdict) {
    const Limits& limits = verdict.limits;
    if (!verdict.looks_wrong()) {
        const std::string turns = turns_of(evidence);
        return turns.empty() ? std::vector<std::string>{} : std::vector{turns};
    }
    std::vector<std::string> causes{placeholders_of(evidence), mix_up_of(evidence)};
    if (causes.back().empty()) causes.push_back(dropped_of(evidence));
    verdict.mix_up = !causes.back().empty();
    const std::function<std::string()> others[] = {[&] { return turns_of(evidence); },
                                                   [&] { return doubt_chart(evidence, verdict); },
                                                   [&] { return divergence_of(evidence); },
                                                   [&] { return offset_of(evidence); },
                                                   [&] { return trend_of(evidence, limits, true); },
                                                   [&] { return few_of(evidence, limits); },
                                                   [&] { return noise_of(evidence, limits); },
                                                   [&] { return trend_of(evidence, limits, false); },
                                                   [&] { return scale_of(evidence, verdict); }};
    for (const auto& other : others)
        if (std::ranges::all_of(causes, &std::string::empty)) causes.push_back(other());
    std::erase(causes, "");
    return causes;
}

void add_hints(const Evidence& evidence, Consistency& verdict) {
    if (!evidence.nis.empty() && evidence.whiteness.empty() && evidence.steps > 1)
        verdict.hints.push_back("the correlation of innovations was not tested: no row was measured often enough");
    if (verdict.looks_wrong())
        if (const std::string repeated = repeated_trials(evidence); !repeated.empty())
            verdict.hints.push_back(repeated);
    std::ranges::copy(causes_of(evidence, verdict), std::back_inserter(verdict.hints));
}

}  // namespace credence
