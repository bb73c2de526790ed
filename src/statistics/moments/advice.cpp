#include "statistics/moments/advice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "statistics/moments/directions.hpp"
#include "statistics/moments/requirements.hpp"

namespace credence {

namespace {

/// More than the 80 % of studies that are promised, for the noise of the advice itself.
constexpr double advised_share = 0.85;

bool is_complete(const TrialMoments& trials, std::size_t i, const std::vector<int>& state) {
    const double* row = trials.row(i);
    bool complete = std::none_of(row, row + trials.groups, [](double value) { return std::isnan(value); });
    for (const int j : state) complete = complete && !std::isnan(trials.z(i, j));
    for (const int a : state)
        for (const int b : state) {
            const int place = triangle_place(std::max(a, b), std::min(a, b));
            complete = complete && !std::isnan(trials.S(i)[place] + trials.C(i)[place]);
        }
    return complete;
}

TrialMoments complete_trials(const TrialMoments& trials, const std::vector<int>& state) {
    TrialMoments complete{trials.components, trials.groups, {}, {}};
    for (std::size_t i = 0; i < trials.trials(); ++i)
        if (is_complete(trials, i, state))
            std::copy(trials.row(i), trials.row(i) + trials.size(), complete.append(trials.trial[i]));
    return complete;
}

/// The number at which all requirements hold in the share of draws.
double number_for_all(const std::vector<Requirement>& requirements) {
    Eigen::VectorXd most = Eigen::VectorXd::Zero(advice_draws);
    for (const Requirement& one : requirements) most = most.cwiseMax(one.trials());
    return quantile_of(most, advised_share);
}

/// What needs most trials.
const Requirement& binding_one(const std::vector<Requirement>& requirements) {
    return *std::ranges::max_element(
        requirements, {}, [](const Requirement& one) { return quantile_of(one.trials(), advised_share); });
}

}  // namespace

std::optional<Advice> trials_for_consistent(const TrialMoments& trials, const std::vector<int>& state,
                                            std::uint64_t root_seed, const AdviceLimits& limits) {
    const TrialMoments complete = complete_trials(trials, state);
    if (static_cast<double>(complete.trials()) < advice_trials) return std::nullopt;
    const auto requirements = requirements_of(complete, state, root_seed, limits);
    if (!requirements) return std::nullopt;
    const double least = state.size() >= 2 ? direction_trials : 2;
    const double number = std::max(least, number_for_all(*requirements));
    const double factor = binding_one(*requirements).uncertainty();
    return Advice{number, {number / factor, number * factor}};
}

double trials_to_show(const PositiveSample& sample, double level, double margin) {
    const double a = t_quantile(2 * level, sample.trials - 1) * sample.standard_deviation;
    const double room = std::abs(sample.mean - 1) - margin;
    if (!(room > 0)) return std::numeric_limits<double>::infinity();
    // To first order in 1/N, what is allowed for trials that were not seen; only where the mean is too small.
    const double c = sample.mean < 1 ? -std::log(levels::unseen) * (unseen_size - 1) * sample.mean : 0;
    return std::pow((a + std::sqrt(a * a + 4 * room * c)) / (2 * room), 2);
}

double trials_to_show_bias(const Moments& z, double level, double margin) {
    const double room = std::abs(z.mean) - margin;
    if (!(room > 0)) return std::numeric_limits<double>::infinity();
    return std::pow(t_quantile(2 * level, z.count - 1) * z.standard_deviation / room, 2);
}

}  // namespace credence
