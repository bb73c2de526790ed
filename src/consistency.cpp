#include <credence/consistency.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace credence {

namespace {

enum class Side { inside, above, below };

/// Mean of a figure at one step, or over all of them, with an interval of the given quantile.
struct Estimate {
    double value = 0, standard_deviation = 0, half_width = 0;
    Interval interval() const { return {value - half_width, value + half_width}; }
};

Estimate estimate(const Moments& moments, double scale, double quantile) {
    return {moments.mean * scale, moments.standard_deviation * scale, quantile * moments.standard_error * scale};
}

Moments at_step(const ArmResults& arm, const FigureTotals& totals, std::size_t k) {
    return moments_from_sums(arm.counted, totals.sum[k].rounded(), totals.square_sum[k].rounded());
}

/// Of each trial's sum over its steps.
Moments over_steps(const ArmResults& arm, const FigureTotals& totals) {
    ExactSum sum;
    for (const ExactSum& step : totals.sum) sum.add(step);
    return moments_from_sums(arm.counted, sum.rounded(), totals.run_square_sum.rounded());
}

Side side_of(const Estimate& estimate, double low, double high) {
    if (estimate.interval().low > high) return Side::above;
    if (estimate.interval().high < low) return Side::below;
    return Side::inside;
}

/// `steps 3 to 7, 9`, from 1-based steps in order.
std::string steps_text(const std::vector<int>& steps) {
    std::string text = steps.size() == 1 ? "step " : "steps ";
    for (std::size_t i = 0; i < steps.size();) {
        std::size_t last = i;
        while (last + 1 < steps.size() && steps[last + 1] == steps[last] + 1) ++last;
        if (i > 0) text += ", ";
        text += std::to_string(steps[i]);
        if (last > i) text += " to " + std::to_string(steps[last]);
        i = last + 1;
    }
    return text;
}

class Judge {
public:
    Judge(const ScenarioResults& results, const ArmResults& arm, double margin)
        : results_(results), arm_(arm), degrees_(static_cast<double>(arm.counted - 1)) {
        verdict_.margin = margin;
        int blocks = 0, components = 0;
        for (const Figure& figure : results.figures) {
            blocks += figure.role == FigureRole::nees;
            components += figure.role == FigureRole::standardised_error;
        }
        const double steps = results.steps();
        plain_ = t_quantile(0.05, degrees_);
        corrected_alpha_ = 0.05 / (blocks * (steps + 1));
        corrected_ = t_quantile(corrected_alpha_, degrees_);
        corrected_bias_ = t_quantile(0.05 / std::max(1.0, components * steps), degrees_);
    }

    Consistency run() {
        for (std::size_t f = 0; f < results_.figures.size(); ++f) {
            if (results_.figures[f].role == FigureRole::nees) look_at_block(results_.figures[f], arm_.totals[f]);
            if (results_.figures[f].role == FigureRole::standardised_error)
                look_at_bias(results_.figures[f], arm_.totals[f]);
        }
        decide();
        return verdict_;
    }

private:
    void look_at_block(const Figure& figure, const FigureTotals& totals) {
        const double margin = verdict_.margin, scale = 1.0 / figure.dimension;
        const std::string name = figure.name == "nees" ? "all" : figure.name.substr(5);
        const Moments run = over_steps(arm_, totals);
        const double run_scale = scale / results_.steps();
        const Estimate time = estimate(run, run_scale, plain_);
        verdict_.blocks.push_back(
            {name, figure.dimension, time.value, run.standard_error * run_scale, time.interval()});
        all_inside_ = all_inside_ && time.interval().low >= 1 - margin && time.interval().high <= 1 + margin;
        note_needed_trials(time);

        const Estimate corrected = estimate(run, run_scale, corrected_);
        const Side time_side = side_of(corrected, 1 - margin, 1 + margin);
        if (time_side != Side::inside) add_finding(time_side, name, "over all steps", corrected);
        std::vector<int> steps[2];
        Estimate worst[2];
        for (std::size_t k = 0; k < totals.sum.size(); ++k) {
            const Estimate step = estimate(at_step(arm_, totals, k), scale, corrected_);
            const Side side = side_of(step, 1 - margin, 1 + margin);
            if (side == Side::inside || !beyond_chi_square(step, side, figure.dimension)) continue;
            const std::size_t which = side == Side::above ? 0 : 1;
            if (steps[which].empty() || std::abs(step.value - 1) > std::abs(worst[which].value - 1))
                worst[which] = step;
            steps[which].push_back(static_cast<int>(k) + 1);
        }
        for (const std::size_t which : {0u, 1u})
            if (!steps[which].empty())
                add_finding(which == 0 ? Side::above : Side::below, name, steps_text(steps[which]), worst[which]);
    }

    /// Student's interval alone is too narrow for few trials, because chi-square is skewed: a step must also lie beyond
    /// the exact bound that NEES (1 -+ margin) chi-square(dimension) has, which needs no estimated deviation.
    bool beyond_chi_square(const Estimate& step, Side side, int dimension) const {
        const double degrees = static_cast<double>(arm_.counted) * dimension;
        const double scaled = step.value * degrees / (1 + (side == Side::above ? verdict_.margin : -verdict_.margin));
        return side == Side::above ? scaled > chi_square_upper_quantile(corrected_alpha_ / 2, degrees)
                                   : scaled < chi_square_quantile(corrected_alpha_ / 2, degrees);
    }

    void look_at_bias(const Figure& figure, const FigureTotals& totals) {
        std::vector<int> steps;
        Estimate worst;
        for (std::size_t k = 0; k < totals.sum.size(); ++k) {
            const Estimate step = estimate(at_step(arm_, totals, k), 1, corrected_bias_);
            if (std::abs(step.value) <= step.half_width || std::isnan(step.half_width)) continue;
            if (steps.empty() || std::abs(step.value) > std::abs(worst.value)) worst = step;
            steps.push_back(static_cast<int>(k) + 1);
        }
        if (steps.empty()) return;
        const std::string component = figure.name.substr(std::string("standardised_error_").size());
        verdict_.findings.push_back({"biased", component, steps_text(steps), worst.value, worst.interval()});
    }

    void add_finding(Side side, const std::string& block, const std::string& when, const Estimate& estimate) {
        (side == Side::above ? optimistic_ : pessimistic_) = true;
        verdict_.findings.push_back({verdict_name(side == Side::above ? Verdict::optimistic : Verdict::pessimistic),
                                     block, when, estimate.value, estimate.interval()});
    }

    /// Trials that bring the time-averaged interval off the margin's edge, if the mean stays: every block must get
    /// inside, but one outside is enough.
    void note_needed_trials(const Estimate& time) {
        const double off = std::abs(time.value - 1), slack = std::abs(off - verdict_.margin);
        const bool inside = off < verdict_.margin;
        const double quantile = normal_quantile(inside ? 0.05 : corrected_alpha_);
        const double needed = std::ceil(std::pow(quantile * time.standard_deviation / slack, 2));
        if (!std::isfinite(needed)) return;
        if (inside) needed_inside_ = std::max(needed_inside_, needed);
        else needed_outside_ = std::min(needed_outside_, needed);
    }

    void decide() {
        if (optimistic_ && pessimistic_) verdict_.verdict = Verdict::mixed;
        else if (optimistic_) verdict_.verdict = Verdict::optimistic;
        else if (pessimistic_) verdict_.verdict = Verdict::pessimistic;
        else if (all_inside_ && verdict_.findings.empty()) verdict_.verdict = Verdict::consistent;
        if (verdict_.verdict == Verdict::undecided && !all_inside_)
            verdict_.trials_to_decide = std::isfinite(needed_outside_) ? needed_outside_ : needed_inside_;
    }

    const ScenarioResults& results_;
    const ArmResults& arm_;
    double degrees_, plain_ = 0, corrected_alpha_ = 0, corrected_ = 0, corrected_bias_ = 0;
    double needed_inside_ = 0, needed_outside_ = std::numeric_limits<double>::infinity();
    bool all_inside_ = true, optimistic_ = false, pessimistic_ = false;
    Consistency verdict_;
};

}  // namespace

const std::string& verdict_name(Verdict verdict) {
    static const std::string names[] = {"consistent", "optimistic", "pessimistic", "mixed", "undecided"};
    return names[static_cast<int>(verdict)];
}

Consistency judge(const ScenarioResults& results, const ArmResults& arm, double margin) {
    return Judge(results, arm, margin).run();
}

std::string sentence(const Finding& finding) {
    char figures[120];
    std::snprintf(figures, sizeof figures, "%s %.3g (%.3g to %.3g)",
                  finding.what == "biased" ? "mean error / sigma" : "NEES/dim", finding.value, finding.interval.low,
                  finding.interval.high);
    const std::string where = finding.what == "biased" ? "component " + finding.where : finding.where;
    return finding.what + ": " + where + ", " + finding.when + ", " + figures;
}

}  // namespace credence
