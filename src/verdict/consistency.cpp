#include "verdict/judgement.hpp"

#include "base/formatted.hpp"
#include "base/nan.hpp"
#include "statistics/mean_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace credence {

namespace {

/// NEES/dim of one group, over the steps and at each of them.
class GroupJudge {
public:
    GroupJudge(const Evidence& evidence, std::size_t group, Judgement& judgement)
        : evidence_(evidence), group_(evidence.groups[group]), place_(static_cast<int>(group)), judgement_(judgement) {}

    void judge() {
        if (!(group_.run.count > 0) && evidence_.trials > 0) return;  // a record that does not give this group's NEES
        if (is_rounded(group_, judgement_.limits())) return leave_out();
        over_steps();
        at_steps();
    }

private:
    double margin() const { return judgement_.limits().margin; }
    /// A single step of few trials: the bound by chi-square supposes that NEES near 0 is as it says.
    bool is_note() const { return evidence_.steps == 1 && static_cast<double>(evidence_.trials) < many_trials; }

    void leave_out() {
        const std::string text = std::isfinite(group_.rounding)
                                     ? formatted("rounding alone may change it by %.2g %%", 100 * group_.rounding)
                                     : "P cannot be distinguished from a singular one";
        judgement_.reach(&Reached::nees, std::numeric_limits<double>::infinity());
        judgement_.not_shown("conditioning: NEES of " + group_.name + " is left out, because " + text, false);
    }

    void over_steps() {
        const PositiveSample sample = positive_sample(group_.run, group_.largest);
        judge_size({group_.name, group_.dimension, group_.components, sample, positive_sample(group_.centred)}, place_,
                   evidence_, judgement_);
        const double shown = margin_shown(acceptance_interval(sample, sample));
        judgement_.reach(&Reached::nees, shown);
        judgement_.accept(shown <= margin(), "NEES/dim of " + group_.name);
    }

    void at_steps() {
        const double tests = static_cast<double>(groups_judged(evidence_)) * evidence_.steps;
        Found found[2];
        for (std::size_t k = 0; k < group_.step.size(); ++k) {
            if (!(group_.step[k].count > 1)) continue;
            const double level = levels::step / tests / 2;
            PositiveSample sample = positive_sample(group_.step[k]);
            sample.of_few_numbers = group_.dimension < many_numbers;
            const MeanClaim claim = claim_on_nees(sample, group_.anees.degrees[k], level, margin(), level);
            if (claim.above || claim.below) found[claim.above ? 0 : 1].add(k, group_.step[k].mean, claim.bounds);
        }
        for (const Side side : {Side::above, Side::below})
            if (const Found& steps = found[side == Side::above ? 0 : 1]; !steps.steps.empty()) {
                const Finding finding{Subject::step, fault_of(side), group_.name, steps_text(steps.steps),
                                      steps.value,   steps.interval, "NEES/dim"};
                is_note() ? judgement_.note(finding) : judgement_.add(side, finding);
            }
    }

    const Evidence& evidence_;
    const GroupEvidence& group_;
    int place_;
    Judgement& judgement_;
};

Consistency judge_trials(const Evidence& evidence, const Limits& limits) {
    Judgement judgement(limits);
    for (std::size_t group = 0; group < evidence.groups.size(); ++group) GroupJudge(evidence, group, judgement).judge();
    judge_components(evidence, judgement);
    judge_directions(evidence, judgement);
    judge_bias(evidence, judgement);
    judge_innovations(evidence, judgement);
    judge_windows(evidence, judgement);
    judge_quintiles(evidence, judgement);
    if (evidence.segments.count) judge_segments(evidence, judgement);
    else judge_few_runs(evidence, judgement);
    if (const std::string repeated = repeated_trials(evidence); !repeated.empty()) judgement.not_shown(repeated, false);
    if (!evidence.joint) judgement.not_shown("there is no joint covariance of the whole state", false);
    return judgement.consistency(evidence);
}

}  // namespace

Consistency judge_survivors(const Evidence& evidence, const Limits& limits) {
    if (evidence.trials == 1 && !evidence.segments.count) {
        Consistency verdict = judge_single_run(evidence, limits);
        const std::string written = verdict.looks_wrong() ? mix_up_of(evidence) : "",
                          diverges = divergence_of(evidence);
        verdict.mix_up = !written.empty();
        if (verdict.mix_up || !diverges.empty()) verdict.hints.push_back(verdict.mix_up ? written : diverges);
        return verdict;
    }
    Consistency verdict = judge_trials(evidence, limits);
    if (evidence.groups.empty() || evidence.trials == 0) return verdict;
    if (!evidence.of_innovations) caution_about_whiteness(evidence, verdict);
    caution_about_innovations(evidence, verdict);
    caution_about_distribution(evidence, verdict);
    add_hints(evidence, verdict);
    return verdict;
}

void Judgement::add(Side side, Finding finding) {
    (side == Side::above ? above_ : below_) = true;
    finding.what = fault_of(side);
    findings_.push_back(std::move(finding));
}

void Judgement::add_correlation(Finding finding) {
    (finding.value > 0 ? above_ : below_) = true;
    below_ |= withheld_;
    findings_.push_back(std::move(finding));
}

void Judgement::note(Finding finding) { notes_.push_back(std::move(finding)); }

void Judgement::add_bias(Finding finding) {
    above_ = true;
    finding.what = Fault::biased;
    findings_.push_back(std::move(finding));
}

void Judgement::accept(bool shown, const std::string& what) {
    if (shown) return;
    all_shown_ = false;
    unknown_.push_back(what);
}

void Judgement::reach(double Reached::* margin, double value) {
    reached_.*margin = std::max(reached_.*margin, std::isnan(value) ? std::numeric_limits<double>::infinity() : value);
}

void Judgement::not_shown(const std::string& why, bool more_trials_help) {
    all_shown_ = false;
    more_trials_help_ = more_trials_help_ && more_trials_help;
    reasons_.push_back(why);
}

void Judgement::suspect(Suspicion suspicion) { suspicions_.push_back(std::move(suspicion)); }

Consistency Judgement::consistency(const Evidence& evidence) {
    Consistency verdict;
    verdict.limits = limits_;
    verdict.findings = std::move(findings_);
    verdict.cautions = std::move(notes_);
    verdict.directions = std::move(directions);
    verdict.withheld = withheld_;
    for (double Reached::* margin : {&Reached::nees, &Reached::direction, &Reached::bias}) {
        const double reached = reached_.*margin;
        verdict.reached.*margin = reached > 0 && std::isfinite(reached) ? reached : nan;
    }
    if (above_ && below_) verdict.verdict = Verdict::mixed;
    else if (above_) verdict.verdict = Verdict::optimistic;
    else if (below_) verdict.verdict = Verdict::pessimistic;
    else if (all_shown_ && !evidence.groups.empty()) verdict.verdict = Verdict::consistent;
    if (verdict.verdict != Verdict::undecided || evidence.trials == 0) return verdict;
    verdict.reasons = std::move(reasons_);
    if (!unknown_.empty())
        verdict.reasons.push_back(first_of(unknown_) + ": too few " + evidence.units() +
                                  " to show that it is within its margin");
    verdict.suspicions = std::move(suspicions_);
    verdict.smallest_faults = smallest_faults(evidence, limits_);
    if (more_trials_help_) verdict.trials_needed = trials_needed(evidence, limits_);
    return verdict;
}

std::string first_of(const std::vector<std::string>& names) {
    constexpr std::size_t most = 3;
    std::string text = names.front();
    for (std::size_t i = 1; i < std::min(most, names.size()); ++i) text += ", " + names[i];
    return names.size() > most ? text + " and " + std::to_string(names.size() - most) + " more" : text;
}

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

const std::string& fault_name(Fault fault) {
    static const std::string names[] = {"optimistic", "pessimistic", "biased", "correlated", "non-chi-square"};
    return names[static_cast<std::size_t>(fault)];
}

const std::string& subject_name(Subject subject) {
    static const std::string names[] = {"size",      "step",         "direction", "bias",        "innovations",
                                        "whiteness", "distribution", "window",    "calibration", "offset"};
    return names[static_cast<int>(subject)];
}

Interval over_steps95(const GroupEvidence& group) { return t_interval(group.run); }

bool too_many_failed(std::int64_t failed, std::int64_t trials, double share) {
    constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();
    return static_cast<double>(failed) > share * static_cast<double>(trials) * (1 + rounding);
}

Consistency judge(const Evidence& evidence, const Limits& limits) {
    Consistency verdict = evidence.truth ? judge_with_truth(evidence, limits) : judge_survivors(evidence, limits);
    if (too_many_failed(evidence.failed_trials(), evidence.all_trials, limits.failed)) {
        verdict.verdict = Verdict::failed;
        verdict.reasons.clear();
        verdict.trials_needed = {};
        verdict.suspicions.clear();
    }
    return verdict;
}

std::string when_text(const Finding& finding) {
    return (finding.about == Subject::direction ? "direction " : "") + finding.when;
}

std::string sentence(const Finding& finding) {
    const bool of_component =
        finding.about == Subject::bias || finding.about == Subject::window || finding.about == Subject::offset;
    const std::string where = (of_component ? "component " : "") + finding.where;
    return fault_name(finding.what) + ": " + where + ", " + when_text(finding) + ", " + finding.measure +
           formatted(" %.3g (%.3g to %.3g)", finding.value, finding.interval.low, finding.interval.high);
}

}  // namespace credence
