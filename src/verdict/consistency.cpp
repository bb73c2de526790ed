#include "statistics/goodness.hpp"

#include "verdict/consistency_parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace credence {

namespace {

/// Student's intervals at one level, for any number of trials.
class Student {
public:
    explicit Student(double alpha) : alpha_(alpha) {}
    Estimate operator()(const Moments& moments) const {
        if (moments.count != count_) {
            count_ = moments.count;
            quantile_ = t_quantile(alpha_, count_ - 1);
        }
        return {moments.mean, quantile_ * moments.standard_error};
    }
    double alpha() const { return alpha_; }

private:
    double alpha_;
    mutable double count_ = -1, quantile_ = 0;
};

class Judge {
public:
    Judge(const Evidence& evidence, const Limits& limits)
        : evidence_(evidence),
          corrected_(0.05 / std::max(1.0, static_cast<double>(evidence.blocks.size()) * (evidence.steps + 1.0))),
          corrected_bias_(0.05 / std::max(1.0, static_cast<double>(evidence.bias.size()) * evidence.steps)) {
        verdict_.limits = limits;
    }

    Consistency run() {
        for (const GroupEvidence& block : evidence_.blocks) look_at_block(block);
        for (const BiasEvidence& bias : evidence_.bias) examine_bias(bias);
        decide();
        return verdict_;
    }

private:
    void look_at_block(const GroupEvidence& block) {
        const double margin = verdict_.limits.margin;
        const Interval time = over_steps95(block);
        all_inside_ = all_inside_ && within(time, margin);
        note_needed_trials(block.run);
        const Estimate corrected = corrected_(block.run);
        if (const Side side = side_of(corrected.interval(), margin);
            side != Side::inside && beyond_chi_square(corrected, side, degrees_over_steps(block)))
            add_finding(side, block.block, "over all steps", corrected);
        Found found[2];
        for (std::size_t k = 0; k < block.step.size(); ++k) {
            const Estimate step = corrected_(block.step[k]);
            const Side side = side_of(step.interval(), margin);
            if (side != Side::inside && beyond_chi_square(step, side, block.anees.degrees[k]))
                found[side == Side::above ? 0 : 1].add(k, step, std::abs(step.value - 1));
        }
        for (const Side side : {Side::above, Side::below})
            if (const Found& steps = found[side == Side::above ? 0 : 1]; !steps.steps.empty())
                add_finding(side, block.block, steps_text(steps.steps), steps.worst);
    }

    /// For few trials Student's interval alone is too narrow, because chi-square is skewed: a step must also be beyond
    /// the exact bound for NEES distributed as (1 -+ margin) chi-square(dimension), which needs no estimated deviation.
    /// So must all steps.
    bool beyond_chi_square(const Estimate& step, Side side, double degrees) const {
        const double margin = verdict_.limits.margin,
                     scaled = step.value / (1 + (side == Side::above ? margin : -margin));
        const Interval band = chi_square_band(degrees, corrected_.alpha());
        return side == Side::above ? scaled > band.high : scaled < band.low;
    }

    /// Degrees of freedom of the NEES over all steps, from its spread over the trials: chi-square has 2
    /// mean^2/variance. At least those of fully correlated steps, which count as one, and at most those of independent
    /// ones.
    double degrees_over_steps(const GroupEvidence& block) const {
        const double fewest = block.run.count * block.dimension,
                     told = 2 * block.run.count * std::pow(block.run.mean / block.run.standard_deviation, 2);
        return told > fewest ? std::min(told, fewest * evidence_.steps) : fewest;
    }

    void examine_bias(const BiasEvidence& bias) {
        Found found;
        for (std::size_t k = 0; k < bias.step.size(); ++k) {
            const Estimate step = corrected_bias_(bias.step[k]);
            if (std::abs(step.value) > step.half_width) found.add(k, step, std::abs(step.value));
        }
        if (found.steps.empty()) return;
        verdict_.findings.push_back(
            {"biased", bias.component, steps_text(found.steps), found.worst.value, found.worst.interval()});
    }

    void add_finding(Side side, const std::string& block, const std::string& when, const Estimate& estimate) {
        (side == Side::above ? optimistic_ : pessimistic_) = true;
        verdict_.findings.push_back({name_of(side), block, when, estimate.value, estimate.interval()});
    }

    /// Number of trials at which the time-averaged interval no longer contains the margin's edge, if the mean stays the
    /// same: every group must get inside, but one outside is enough.
    void note_needed_trials(const Moments& run) {
        const double off = std::abs(run.mean - 1), slack = std::abs(off - verdict_.limits.margin);
        const bool inside = off < verdict_.limits.margin;
        const double needed = trials_needed(inside ? 0.05 : corrected_.alpha(), run.standard_deviation / slack);
        if (!std::isfinite(needed)) return;
        if (inside) needed_inside_ = std::max(needed_inside_, needed);
        else needed_outside_ = std::min(needed_outside_, needed);
    }

    /// The least N > count with t_{N - 1} ratio / sqrt(N) <= 1.
    double trials_needed(double alpha, double ratio) const {
        const double count = static_cast<double>(evidence_.trials);
        double needed = std::ceil(std::pow(normal_quantile(alpha) * ratio, 2));
        for (int round = 0; round < 10 && needed < 1000; ++round)  // beyond this, t equals z
            needed = std::ceil(std::pow(t_quantile(alpha, std::max(count, needed - 1)) * ratio, 2));
        return std::max(count + 1, needed);
    }

    void decide() {
        if (optimistic_ && pessimistic_) verdict_.verdict = Verdict::mixed;
        else if (optimistic_) verdict_.verdict = Verdict::optimistic;
        else if (pessimistic_) verdict_.verdict = Verdict::pessimistic;
        else if (all_inside_ && evidence_.joint && !evidence_.blocks.empty() && verdict_.findings.empty())
            verdict_.verdict = Verdict::consistent;
        constexpr std::int64_t enough_to_tell = 30;
        if (verdict_.verdict == Verdict::undecided && !all_inside_ && evidence_.joint && evidence_.trials >= enough_to_tell)
            verdict_.trials_to_decide = std::isfinite(needed_outside_) ? needed_outside_ : needed_inside_;
    }

    const Evidence& evidence_;
    Student corrected_, corrected_bias_;
    double needed_inside_ = 0, needed_outside_ = std::numeric_limits<double>::infinity();
    bool all_inside_ = true, optimistic_ = false, pessimistic_ = false;
    Consistency verdict_;
};

/// The verdict on the trials that did not fail.
Consistency judge_survivors(const Evidence& evidence, const Limits& limits) {
    if (evidence.trials == 1) return judge_single_trial(evidence, limits);
    Consistency verdict = Judge(evidence, limits).run();
    if (evidence.blocks.empty()) return verdict;
    caution_about_whiteness(evidence, verdict);
    caution_about_innovations(evidence, verdict);
    caution_about_distribution(evidence, verdict);
    return verdict;
}

}  // namespace

std::string listed(const std::string& what, const std::vector<int>& numbers) {
    std::string text = what + (numbers.size() == 1 ? " " : "s ");
    for (std::size_t i = 0; i < numbers.size();) {
        std::size_t last = i;
        while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
        if (i > 0) text += ", ";
        text += std::to_string(numbers[i]);
        if (last > i) text += " to " + std::to_string(numbers[last]);
        i = last + 1;
    }
    return text;
}

const std::string& verdict_name(Verdict verdict) {
    static const std::string names[] = {"consistent", "optimistic", "pessimistic", "mixed", "undecided", "failed"};
    return names[static_cast<int>(verdict)];
}

Interval over_steps95(const GroupEvidence& block) { return t_interval(block.run); }

bool too_many_failed(std::int64_t failed, std::int64_t trials, double share) {
    constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();
    return static_cast<double>(failed) > share * static_cast<double>(trials) * (1 + rounding);
}

Consistency judge(const Evidence& evidence, const Limits& limits) {
    Consistency verdict = judge_survivors(evidence, limits);
    if (too_many_failed(evidence.failed_trials(), evidence.all_trials, limits.failed)) {
        verdict.verdict = Verdict::failed;
        verdict.trials_to_decide = 0;
    }
    return verdict;
}

std::string sentence(const Finding& finding) {
    const bool innovations = finding.where.starts_with("innovations (");
    const std::string measure = finding.what == "biased"       ? "mean error/sigma"
                                : finding.what == "correlated" ? "correlation"
                                : finding.what == "misshapen"  ? "distance from chi-square"
                                : innovations                  ? "NIS/m"
                                                               : "NEES/dim";
    char figures[160];
    std::snprintf(figures, sizeof figures, "%s %.3g (%.3g to %.3g)", measure.c_str(), finding.value,
                  finding.interval.low, finding.interval.high);
    const std::string where = finding.what == "biased" ? "component " + finding.where : finding.where;
    return finding.what + ": " + where + ", " + finding.when + ", " + figures;
}

}  // namespace credence
