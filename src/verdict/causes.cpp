// What findings often come from: mistakes that leave their mark in the size of the errors beside that of P.

#include "base/formatted.hpp"
#include "statistics/moments/trial_moments.hpp"
#include "verdict/applied.hpp"
#include "verdict/judgement.hpp"

#include <credence/statistics.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace credence {

namespace {

/// Logarithms of the mean-square error and of the variance that P says, [component][step]; NaN: unknown.
struct Sizes {
    std::vector<Component> component;
    std::vector<std::vector<double>> error, variance;
    double tolerance = 0;  ///< a mean distance of logarithms within which two of them are the same

    std::size_t components() const { return component.size(); }
    std::size_t steps() const { return error.empty() ? 0 : error.front().size(); }
};

/// Of the components that are not known exactly, in runs that are trials.
Sizes sizes_of(const Evidence& evidence) {
    Sizes sizes;
    if (evidence.of_few_runs()) return sizes;
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
        sizes.component.push_back({bias.component, bias.unit});
        sizes.error.push_back(std::move(error));
        sizes.variance.push_back(std::move(variance));
    }
    return sizes;
}

}  // namespace

std::string placeholders_of(const Evidence& evidence) {
    const Sizes sizes = sizes_of(evidence);
    std::vector<std::string> names;
    constexpr double far_too_large = 20;  // e^20: sigma is more than 20,000 times the error
    for (std::size_t j = 0; j < sizes.components(); ++j)
        if (double sum = 0, count = 0; sizes.error[j].front() < sizes.variance[j].front()) {
            for (std::size_t k = 0; k < sizes.steps(); ++k)
                if (const double size = std::abs(sizes.error[j][k] - sizes.variance[j][k]); std::isfinite(size))
                    sum += size, ++count;
            if (sum > far_too_large * count) names.push_back(sizes.component[j].name);
        }
    if (names.empty()) return {};
    return "P says next to nothing of " + first_of(names) +
           ": do large variances stand for what is not estimated? Leave these components out";
}

std::string offset_of(const Evidence& evidence) {
    const Sizes sizes = sizes_of(evidence);
    for (const BiasEvidence& bias : evidence.bias) {
        const auto at = std::ranges::find(sizes.component, bias.component, &Component::name);
        if (at == sizes.component.end() || !(std::abs(bias.run.mean) > 5 * bias.run.standard_error)) continue;
        const std::vector<double>& variance = sizes.variance[static_cast<std::size_t>(at - sizes.component.begin())];
        double count = 0, sum = 0, square_sum = 0, errors = 0;
        for (std::size_t k = 0; k < variance.size(); ++k) {
            const double sigma = std::exp(variance[k] / 2), mean = bias.step[k].mean * sigma;
            if (!std::isfinite(mean)) continue;
            ++count, sum += mean, square_sum += mean * mean, errors += std::pow(bias.step[k].standard_error * sigma, 2);
        }
        constexpr double least_steps = 5;
        const Moments means = moments_from_sums(static_cast<std::int64_t>(count), sum, square_sum);
        if (count < least_steps ||
            !(std::pow(means.standard_deviation, 2) < 2 * errors / count + std::pow(means.mean / 4, 2)))
            continue;
        return "errors of " + bias.component + formatted(" are %.2g", means.mean) +
               (bias.unit.empty() ? "" : " " + bias.unit) +
               " on average at all steps: an offset of the truth, the map or the frame?";
    }
    return {};
}

std::string mix_up_of(const Evidence& evidence) {
    if (evidence.sample) {
        const std::vector<int> components = uncertain_components(evidence, evidence.groups.front().components);
        std::vector<Component> named;
        for (const int j : components) {
            const BiasEvidence& bias = evidence.bias[static_cast<std::size_t>(j)];
            named.push_back({bias.component, bias.unit});
        }
        return applied_cause(evidence.sample(components), named);
    }
    const Sizes sizes = sizes_of(evidence);
    SampledSteps sample{{}, sizes.tolerance};
    for (std::size_t k = 0; k < sizes.steps(); ++k) {
        Eigen::VectorXd e(std::ssize(sizes.component)), variance(e.size());
        for (std::size_t j = 0; j < sizes.components(); ++j) {
            e(static_cast<Eigen::Index>(j)) = std::exp(sizes.error[j][k] / 2);
            variance(static_cast<Eigen::Index>(j)) = std::exp(sizes.variance[j][k]);
        }
        if (!e.allFinite() || !variance.allFinite()) continue;
        const Eigen::MatrixXd P = variance.asDiagonal();
        if (!sample.steps.empty()) sample.steps.back().after = P;
        sample.steps.push_back({static_cast<std::int64_t>(k), static_cast<int>(k), e, P,
                                sample.steps.empty() ? Eigen::MatrixXd() : sample.steps.back().P, {}});
    }
    return applied_cause(sample, sizes.component);
}

std::string dropped_of(const Evidence& evidence) {
    const TrialMoments* moments = (evidence.has_offsets() ? evidence.centred : evidence.moments).get();
    if (moments == nullptr || !evidence.joint) return {};
    const auto is_right = [&](int j) {
        const BiasEvidence& bias = evidence.bias[static_cast<std::size_t>(j)];
        Moments square = bias.square;
        for (const GroupEvidence& group : evidence.groups)
            if (group.components == std::vector{j}) square = group.run;
        const Interval interval = t_interval(square, 0.01);
        return interval.low < 1 && interval.high > 1;
    };
    constexpr double hardly_any = 0.1, level = 0.001;
    double largest = hardly_any;
    std::string said;
    const int n = moments->components;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < i; ++j) {
            double count = 0, sum = 0, square_sum = 0, by_P = 0;
            for (std::size_t trial = 0; trial < moments->trials(); ++trial) {
                const double steps = moments->C(trial)[triangle_place(i, i)],
                             product = moments->S(trial)[triangle_place(i, j)] / steps;
                if (!std::isfinite(product)) continue;
                by_P = std::max(by_P, std::abs(moments->C(trial)[triangle_place(i, j)]));
                ++count, sum += product, square_sum += product * product;
            }
            const Moments correlation = moments_from_sums(static_cast<std::int64_t>(count), sum, square_sum);
            if (by_P > 0 || count < 2 || !(std::abs(correlation.mean) > largest)) continue;
            if (!(std::abs(correlation.mean) > t_quantile(level / n / n, count - 1) * correlation.standard_error) ||
                !is_right(i) || !is_right(j))
                continue;
            largest = std::abs(correlation.mean);
            said = "each component is right by itself, and P says of " +
                   evidence.bias[static_cast<std::size_t>(j)].component + " and " +
                   evidence.bias[static_cast<std::size_t>(i)].component +
                   formatted(" that they are not correlated, where errors are by %.2f: was a covariance dropped?",
                             correlation.mean);
        }
    return said;
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
