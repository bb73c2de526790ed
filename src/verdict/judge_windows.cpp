// Time windows of a run: what cancels over all steps, such as a bias that changes its sign.

#include "statistics/mean_bounds.hpp"
#include "verdict/judgement.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

constexpr int windows = 10, least_steps = 5;  ///< of a window

/// The mean over a window's steps, and a standard error that holds whatever the correlation of the steps is: the mean
/// of theirs.
Moments over_window(const std::vector<Moments>& steps, std::size_t first, std::size_t last) {
    Moments mean{0, 0, 0, 0};
    double known = 0;
    for (std::size_t k = first; k < last; ++k) {
        if (!(steps[k].count > 1)) continue;
        mean.mean += steps[k].mean;
        mean.standard_error += steps[k].standard_error;
        mean.count = known == 0 ? steps[k].count : std::min(mean.count, steps[k].count);
        ++known;
    }
    mean.mean /= known;  // NaN where no step is known
    mean.standard_error /= known;
    return mean;
}

/// Calls visit(window, the numbers of its steps).
template <class Visit>
void each_window(const std::vector<Moments>& steps, const Visit& visit) {
    for (std::size_t window = 0; window < windows; ++window) {
        const std::size_t first = window * steps.size() / windows, last = (window + 1) * steps.size() / windows;
        std::vector<int> numbers;
        for (std::size_t k = first; k < last; ++k) numbers.push_back(static_cast<int>(k) + 1);
        visit(over_window(steps, first, last), numbers);
    }
}

/// The names of what is beyond its wider margin somewhere, as one reason.
void withhold(const std::string& what, const std::vector<std::string>& names, Judgement& judgement) {
    if (!names.empty())
        judgement.not_shown(what + first_of(names) + ": over a window of the steps beyond three times the margin",
                            true);
}

}  // namespace

void judge_windows(const Evidence& evidence, Judgement& judgement) {
    if (evidence.steps < windows * least_steps || evidence.of_few_runs()) return;
    std::vector<std::string> groups, components;
    for (const GroupEvidence& group : evidence.groups) {
        if (!(group.run.count > 1) || is_rounded(group, judgement.limits())) continue;
        bool beyond = false;
        each_window(group.step, [&](const Moments& mean, const std::vector<int>&) {
            beyond = beyond || std::abs(mean.mean - 1) > margins_of_part * judgement.limits().margin;
        });
        if (beyond) groups.push_back(group.name);
    }
    withhold("NEES/dim of ", groups, judgement);
    const double level = levels::bias / (windows * static_cast<double>(std::max<std::size_t>(1, evidence.bias.size())));
    for (const BiasEvidence& bias : evidence.bias) {
        if (!(bias.run.count > 1)) continue;
        const double margin = margins_of_part * judgement.limits().bias + truth_allowance(bias.largest_truth, evidence);
        std::vector<int> found;
        bool beyond = false;
        Moments worst;
        Interval interval;
        each_window(bias.step, [&](const Moments& mean, const std::vector<int>& steps) {
            if (!(std::abs(mean.mean) > margin)) return;
            const double half = t_quantile(level, mean.count - 1) * mean.standard_error;
            beyond = true;
            if (!(std::abs(mean.mean) - half > margin)) return;
            found.insert(found.end(), steps.begin(), steps.end());
            if (std::abs(mean.mean) < std::abs(worst.mean)) return;
            worst = mean;
            interval = {mean.mean - half, mean.mean + half};
        });
        if (!found.empty())
            judgement.add_bias({Subject::window, Fault::biased, bias.component, steps_text(found), worst.mean, interval,
                                "mean error/sigma"});
        else if (beyond)
            components.push_back(bias.component);
    }
    withhold("bias of ", components, judgement);
}

}  // namespace credence
