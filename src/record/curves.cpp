// What a page draws of the runs of a record, where these are few.

#include "base/thinned.hpp"
#include "record/totals.hpp"

#include <cmath>
#include <set>

namespace credence {

/// Of a run that failed, up to its failure.
void RecordTotals::keep_curves(std::size_t trial) {
    constexpr std::int64_t most_curves = 24;
    constexpr std::size_t most_stretches = 80;
    if (planner_ == nullptr || shape_.trials >= least_segments) return;
    RunCurves& curves = record_.curves.emplace_back();
    if (!shape_.times.empty()) curves.times = shape_.times[shape_.times.size() == 1 ? 0 : trial];
    const auto between = [&](std::size_t from, std::size_t to) {
        return curves.times.empty() ? static_cast<double>(to - from) : curves.times[to] - curves.times[from];
    };
    for (std::size_t i = 1; i < present_.size(); ++i) {
        const double all = between(present_.front(), present_.back()), gap = between(present_[i - 1], present_[i]);
        if (gap > all / 50 && gap > 2.5 * all / static_cast<double>(present_.size()))
            curves.gaps.emplace_back(kept_.place(present_[i - 1]), kept_.place(present_[i] - 1) + 1);
    }
    if (kept_.every > 1 && !curves.times.empty()) {
        for (std::size_t k = 0; k < kept_.count; ++k) curves.times[k] = curves.times[k * kept_.every];
        curves.times.resize(kept_.count);
    }
    const int shown = static_cast<int>(std::clamp<std::int64_t>(most_curves / shape_.trials, 1, shape_.n));
    for (int j = 0; j < shown && shape_.has_errors; ++j) {
        const auto at = static_cast<std::size_t>(j), n = static_cast<std::size_t>(shape_.n);
        ErrorCurve curve{component_name(shape_, j), shape_.components.empty() ? "" : shape_.components[at].unit};
        std::vector<std::size_t> steps;
        std::vector<double> errors, in_sigmas;
        for (const std::size_t k : present_) {
            if (!kept_.has(k)) continue;
            const double sigmas = series(all_series_.standardised_error + at, k);
            if (std::isnan(sigmas) || sigmas == 0) continue;  // an error of 0 does not tell its sigma
            steps.push_back(kept_.place(k));
            errors.push_back(arm().errors[(trial * kept_.count + steps.back()) * n + at]);
            in_sigmas.push_back(sigmas);
            curve.outside += std::abs(sigmas) > 2;
        }
        curve.steps = std::ssize(steps);
        std::set<std::size_t> kept;
        for (const std::vector<double>* values : {&errors, &in_sigmas})
            for (const std::size_t i : thinned_line(*values, most_stretches)) kept.insert(i);
        for (const std::size_t i : kept) curve.points.push_back({steps[i], errors[i], errors[i] / in_sigmas[i]});
        curves.errors.push_back(std::move(curve));
    }
}

}  // namespace credence
