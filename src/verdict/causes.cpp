// What findings often come from: mistakes that leave their mark in the size of the errors beside that of P.

#include "base/formatted.hpp"
#include "base/nan.hpp"
#include "statistics/moments/trial_moments.hpp"
#include "verdict/consistency_parts.hpp"

#include <credence/statistics.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

namespace credence {

namespace {

/// Logarithms of the mean-square error and of the variance that P says, [component][step]; NaN: unknown.
struct Sizes {
    std::vector<std::string> component;
    std::vector<std::vector<double>> error, variance;
    double tolerance = 0;  ///< a mean distance of logarithms within which two of them are the same

    std::size_t components() const { return component.size(); }
    std::size_t steps() const { return error.empty() ? 0 : error.front().size(); }
};

/// Of the components that are not known exactly.
Sizes sizes_of(const Evidence& evidence) {
    Sizes sizes;
    sizes.tolerance = 0.1 + std::sqrt(2 / static_cast<double>(evidence.trials));
    for (const BiasEvidence& bias : evidence.bias) {
        if (bias.mean_square.size() != bias.step.size() || !(bias.largest_error > 0)) continue;
        std::vector<double> error, variance;
        for (std::size_t k = 0; k < bias.step.size(); ++k) {
            const Moments& z = bias.step[k];
            const double square = z.mean * z.mean + z.standard_deviation * z.standard_deviation * (1 - 1 / z.count);
            error.push_back(std::log(bias.mean_square[k]));
            variance.push_back(error.back() - std::log(square));
        }
        sizes.component.push_back(bias.component);
        sizes.error.push_back(std::move(error));
        sizes.variance.push_back(std::move(variance));
    }
    return sizes;
}

/// The mean size of a number of each step of some components, unknown ones left out; NaN where there is none.
double mean_size(const Sizes& sizes, const std::vector<std::size_t>& components,
                 const std::function<double(std::size_t j, std::size_t k)>& number) {
    double sum = 0, count = 0;
    for (const std::size_t j : components)
        for (std::size_t k = 0; k < sizes.steps(); ++k)
            if (const double value = std::abs(number(j, k)); std::isfinite(value)) sum += value, ++count;
    return sum / count;
}

std::vector<std::size_t> all_of(const Sizes& sizes) {
    std::vector<std::size_t> all(sizes.components());
    std::iota(all.begin(), all.end(), 0);
    return all;
}

/// P is a power of what it should be.
std::string power_of(const Sizes& sizes) {
    const std::vector<std::size_t> all = all_of(sizes);
    const auto about_mean = [&](const auto& number) {
        double sum = 0, count = 0;
        for (const std::size_t j : all)
            for (std::size_t k = 0; k < sizes.steps(); ++k)
                if (const double x = number(j, k); std::isfinite(x)) sum += x, ++count;
        return mean_size(sizes, all, [&](auto j, auto k) { return number(j, k) - sum / count; });
    };
    constexpr double least_spread = 0.3;  // below it a power is a factor
    if (!(about_mean([&](auto j, auto k) { return sizes.variance[j][k]; }) > least_spread)) return {};
    const auto distance = [&](double power) {
        const auto off = [&](auto j, auto k) { return sizes.error[j][k] - power * sizes.variance[j][k]; };
        return power < 0 ? about_mean(off) : mean_size(sizes, all, off);  // correlations make an inverse larger
    };
    for (const auto& [power, what] : {std::pair(2.0, "standard deviations, where variances belong"),
                                      std::pair(0.5, "squared variances"),
                                      std::pair(-1.0, "the inverse of the covariance, an information matrix")})
        if (distance(power) < sizes.tolerance && distance(power) < distance(1) / 3)
            return "the mean-square errors are P's variances to the power " + std::string(power == 2   ? "2"
                                                                                          : power > 0 ? "1/2"
                                                                                                      : "-1") +
                   ": does P hold " + what + "?";
    return {};
}

/// Errors and P in degrees and radians.
std::string degrees_of(const Sizes& sizes) {
    std::vector<std::string> large, small;
    const auto distance = [&](std::size_t component, double logarithm) {
        return mean_size(sizes, {component},
                         [&](auto j, auto k) { return sizes.error[j][k] - sizes.variance[j][k] - logarithm; });
    };
    for (std::size_t j = 0; j < sizes.components(); ++j) {
        const double degrees = 2 * std::log(180 / std::numbers::pi);
        if (distance(j, degrees) < sizes.tolerance) large.push_back(sizes.component[j]);
        if (distance(j, -degrees) < sizes.tolerance) small.push_back(sizes.component[j]);
    }
    if (!large.empty())
        return "errors of " + first_of(large) + " are 57 times P's sigma: is the error in degrees, and P in rad²?";
    if (!small.empty())
        return "errors of " + first_of(small) + " are 1/57 of P's sigma: is P in squared degrees, the error in rad?";
    return {};
}

/// P of another step.
std::string shift_of(const Sizes& sizes) {
    const std::vector<std::size_t> all = all_of(sizes);
    const auto distance = [&](std::size_t error, std::size_t variance) {
        return mean_size(sizes, all, [&](auto j, auto k) {
            return k + 1 < sizes.steps() ? sizes.error[j][k + error] - sizes.variance[j][k + variance] : nan;
        });
    };
    constexpr std::size_t least_steps = 5;
    if (sizes.steps() < least_steps) return {};
    const double own = distance(0, 0), earlier = distance(1, 0), later = distance(0, 1);
    if (!(std::min(earlier, later) < std::min(sizes.tolerance, own / 3))) return {};
    return earlier < later ? "the errors are as large as P of the step before says: is P a step early?"
                           : "the errors are as large as P of the step after says: is P a step late?";
}

/// Two components whose variances are exchanged.
std::string exchange_of(const Sizes& sizes) {
    const auto distance = [&](std::size_t error, std::size_t variance) {
        return mean_size(sizes, {error}, [&](auto, auto k) {
            return sizes.error[error][k] - sizes.variance[variance][k];
        });
    };
    constexpr std::size_t most = 32;  // components: every pair is tried
    for (std::size_t i = 0; i < std::min(most, sizes.components()); ++i)
        for (std::size_t j = i + 1; j < std::min(most, sizes.components()); ++j)
            if (std::max(distance(i, j), distance(j, i)) <
                std::min(sizes.tolerance, std::min(distance(i, i), distance(j, j)) / 3))
                return "errors of " + sizes.component[i] + " are as large as P says of " + sizes.component[j] +
                       ", and the other way round: are they exchanged?";
    return {};
}

/// Variances that stand for "unknown".
std::string placeholders_of(const Sizes& sizes) {
    std::vector<std::string> names;
    constexpr double far_too_large = 20;  // e^20: sigma is more than 20,000 times the error
    for (std::size_t j = 0; j < sizes.components(); ++j)
        if (mean_size(sizes, {j}, [&](auto, auto k) { return sizes.error[j][k] - sizes.variance[j][k]; }) >
                far_too_large &&
            sizes.error[j].front() < sizes.variance[j].front())
            names.push_back(sizes.component[j]);
    if (names.empty()) return {};
    return "P says next to nothing of " + first_of(names) +
           ": do large variances stand for what is not estimated? Leave these components out";
}

/// NEES/dim is right at one end of a run, and not at the other.
std::string trend_of(const Evidence& evidence, const Limits& limits) {
    const std::vector<Moments>& steps = evidence.groups.front().step;
    constexpr std::size_t least_steps = 4;
    if (steps.size() < least_steps) return {};
    const double trials = evidence.groups.front().dimension * static_cast<double>(evidence.trials),
                 right = std::log1p(3 * limits.margin), noise = 3 * std::sqrt(2 / trials),
                 wrong = std::log(1.5) + noise;
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
    if (std::abs(first) > wrong && std::abs(last) < right && std::ranges::all_of(steps, smaller))
        return said("is P at the start that of the first errors, and are these small enough to linearise?");
    if (last > wrong && std::abs(first) < std::max(right, last / 3))
        return said("do errors build up that P does not know of (bias, drift, process noise)?");
    return {};
}

/// Mean errors that are the same at all steps.
std::string offset_of(const Evidence& evidence, const Sizes& sizes) {
    for (const BiasEvidence& bias : evidence.bias) {
        const auto at = std::ranges::find(sizes.component, bias.component);
        if (at == sizes.component.end() || !(std::abs(bias.run.mean) > 5 * bias.run.standard_error)) continue;
        const std::vector<double>& variance = sizes.variance[static_cast<std::size_t>(at - sizes.component.begin())];
        std::vector<double> means;
        for (std::size_t k = 0; k < variance.size(); ++k)
            if (const double mean = bias.step[k].mean * std::exp(variance[k] / 2); std::isfinite(mean))
                means.push_back(mean);
        constexpr std::size_t least_steps = 5;
        if (means.size() < least_steps) continue;
        const auto [low, high] = std::ranges::minmax(means);
        if (high - low < std::min(std::abs(low), std::abs(high)))
            return "errors of " + bias.component + formatted(" are %.2g", quantile(means, 0.5)) +
                   (bias.unit.empty() ? "" : " " + bias.unit) +
                   " on average at all steps: an offset of the truth, the map or the frame?";
    }
    return {};
}

/// Few trials are wrong, and the others are not.
std::string few_of(const Evidence& evidence, const Limits& limits) {
    const double mean = evidence.groups.front().run.mean;
    if (!evidence.moments || !(mean > 1 + 3 * limits.margin)) return {};
    std::vector<double> ratios;
    for (std::size_t i = 0; i < evidence.moments->trials(); ++i)
        if (const double ratio = evidence.moments->X(i, 0); !std::isnan(ratio)) ratios.push_back(ratio);
    if (ratios.empty()) return {};
    // Of chi-square with the degrees of freedom that the quartiles have [Wilson and Hilferty 1931], the median is below
    // the mean.
    const double spread = std::log(quantile(ratios, 0.75) / quantile(ratios, 0.25)),
                 degrees = 2 * std::pow(1.349 / spread, 2), median = quantile(ratios, 0.5),
                 right = std::pow(1 - 2 / (9 * degrees), 3);
    constexpr double clearly = 1.5;
    if (!(median < (1 + limits.margin) * right && mean * right > clearly * median)) return {};
    return formatted("half of the %s have NEES/dim below %.2g: few are wrong, and the worst are named",
                     evidence.units().c_str(), median);
}

}  // namespace

std::string divergence_of(const Evidence& evidence) {
    if (evidence.groups.empty()) return {};
    const GroupEvidence& state = evidence.groups.front();
    if (!(state.run.mean > diverged_nees_ratio) || state.step.size() < 2) return {};
    constexpr double many = 20;  // runs: one of them may have small errors at first by chance
    const bool are_many = state.step.front().count >= many;
    const auto some = std::max<std::ptrdiff_t>(1, std::ssize(state.step) / 5);
    const auto mean = [](auto from, auto to) {
        return std::accumulate(from, to, 0.0, [](double sum, const Moments& step) { return sum + step.mean; }) /
               static_cast<double>(to - from);
    };
    const double first = mean(state.step.begin(), state.step.begin() + (are_many ? 1 : some)),
                 last = mean(state.step.end() - some, state.step.end());
    if (!(last > (are_many ? 3 : 10) * first)) return {};
    return formatted("the filter diverges, NEES/dim is %.2g at first and %.2g at last: is a Jacobian wrong, or does P "
                     "not know of a drift or of process noise? Finite differences show a wrong one (in C++ "
                     "jacobian_mismatch of credence/filters.hpp)", first, last);
}

std::vector<std::string> causes_of(const Evidence& evidence, const Limits& limits) {
    const Sizes sizes = evidence.of_few_runs() ? Sizes{} : sizes_of(evidence);
    std::vector<std::string> causes{few_of(evidence, limits), placeholders_of(sizes)};
    for (const auto& cause : {exchange_of, power_of, degrees_of, shift_of}) {  // one explains the size of the errors
        causes.push_back(cause(sizes));
        if (!causes.back().empty()) break;
    }
    const bool is_explained = !causes.back().empty();
    if (!is_explained) causes.push_back(divergence_of(evidence));
    if (is_explained || causes.back().empty()) causes.push_back(offset_of(evidence, sizes));
    if (std::ranges::all_of(causes, &std::string::empty)) causes.push_back(trend_of(evidence, limits));
    std::erase(causes, "");
    return causes;
}

std::string repeated_trials(const Evidence& evidence) {
    if (!evidence.moments || evidence.segments.count) return {};
    const TrialMoments& trials = *evidence.moments;
    std::vector<std::size_t> order(trials.trials());
    std::iota(order.begin(), order.end(), 0);
    const auto key = [&](std::size_t i) { return trials.X(i, 0); };
    std::erase_if(order, [&](std::size_t i) { return !(key(i) > 0); });
    std::ranges::sort(order, {}, key);
    const auto at = std::ranges::adjacent_find(order, [&](std::size_t i, std::size_t j) {
        return std::equal(trials.row(i), trials.row(i) + trials.groups + trials.components, trials.row(j),
                          [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); });
    });
    if (at == order.end()) return {};
    return "trials " + std::to_string(trials.trial[std::min(*at, *std::next(at))]) + " and " +
           std::to_string(trials.trial[std::max(*at, *std::next(at))]) + " are the same run: was a seed used twice?";
}

}  // namespace credence
