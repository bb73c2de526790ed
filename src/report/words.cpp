// Texts that every format of a report uses.

#include "report/words.hpp"

#include "base/formatted.hpp"
#include <credence/text.hpp>

#include "report/format.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

namespace credence {

namespace {

/// Two decimals, or two digits of what is below 0.1.
std::string ratio_text(double value) { return formatted(std::abs(value) < 0.1 ? "%.2g" : "%.2f", value); }

/// The distance of a finding from the value of a consistent filter.
double distance_off(const Finding& finding) {
    const bool about_0 =
        finding.about == Subject::bias || finding.about == Subject::window || finding.about == Subject::whiteness;
    return about_0 ? std::abs(finding.value) : std::abs(std::log(finding.value));
}

/// The findings of one kind: each group or component at its worst, the farthest off first.
std::vector<std::string> findings_parts(const std::vector<Finding>& findings, Fault what, bool directions) {
    constexpr std::size_t most = 3;
    std::vector<Finding> worst;
    for (const Finding& finding : findings) {
        if (finding.what != what || (finding.about == Subject::direction) != directions) continue;
        const auto same = std::ranges::find(worst, finding.where, &Finding::where);
        if (same == worst.end()) worst.push_back(finding);
        else if (distance_off(finding) > distance_off(*same)) *same = finding;
    }
    std::ranges::sort(worst, std::greater(), distance_off);
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < std::min(most, worst.size()); ++i)
        parts.push_back(directions
                            ? worst[i].where + ", " + worst[i].when + ": " + ratio_text(worst[i].value) + " times P"
                            : worst[i].where + " " + ratio_text(worst[i].value) + " (" + worst[i].when + ")");
    if (worst.size() > most) parts.push_back(std::to_string(worst.size() - most) + " more");
    return parts;
}

/// `: 512 with status non_finite, 400 of these at pose 1`
std::string cause_text(const ArmReport& arm) {
    if (!arm.cause) return {};
    const FailureCause& cause = *arm.cause;
    const std::string text =
        ": " + std::to_string(cause.trials) + " with status " + status_names()[static_cast<std::size_t>(cause.status)];
    if (cause.at_pose == 0) return text;
    return text + ", " + (cause.at_pose == cause.trials ? "all" : std::to_string(cause.at_pose)) + " of these at " +
           cause.place + " " + std::to_string(cause.pose);
}

/// How many trials failed, and how, where that decides the verdict.
std::string failed_text(const ArmReport& arm) {
    if (arm.consistency.verdict != Verdict::failed) return {};
    return std::to_string(arm.failed_trials()) + " of " + std::to_string(arm.trials) +
           (arm.diverged == 0 ? " trials failed"
            : arm.failed == 0 ? " trials diverged"
                              : " trials failed or diverged") +
           ", more than " + short_number(100 * arm.consistency.limits.failed) + " %" + cause_text(arm);
}

/// `450 trials`, or of a log `450 segments, 24300 steps,`
std::string trials_text(const ArmReport& arm, double trials) {
    const SegmentEvidence& segments = arm.evidence.segments;
    const std::string text = number(trials, 0) + " " + arm.evidence.units();
    return segments.count ? text + ", " + number(trials * segments.steps, 0) + " steps," : text;
}

std::string needed_text(const ArmReport& arm) {
    const TrialsNeeded& needed = arm.consistency.trials_needed;
    if (!(needed.value > 0)) return {};
    return "a consistent filter with this spread needs about " + trials_text(arm, needed.value) +
           " to be shown consistent (" + number(needed.low, 0) + " to " + number(needed.high, 0) + ")";
}

/// `NEES/dim of all is 0.91 and not shown to be too small: 2500 trials would show it if it stays (1500 to 6200)`
std::string suspicion_text(const ArmReport& arm, const Suspicion& suspicion) {
    const std::string too = suspicion.about == Subject::bias ? "beyond the margin"
                            : suspicion.what == Fault::optimistic ? "too large"
                                                             : "too small";
    return suspicion.measure + " of " + suspicion.where + " is " + number(suspicion.value, 2) +
           " and not shown to be " + too + ": " + trials_text(arm, suspicion.trials.value) +
           " would show it if it stays (" + number(suspicion.trials.low, 0) + " to " +
           number(suspicion.trials.high, 0) + ")";
}

/// `shown at 95 %: NEES/dim within 12 % of 1, directions within 31 %, bias within 0.21 sigma`
std::string reached_text(const ArmReport& arm) {
    const Reached& reached = arm.consistency.reached;
    std::vector<std::string> parts;
    const auto add = [&](const std::string& of, double margin, const std::string& unit) {
        const double scale = margin < 1 ? 100 : margin < 10 ? 10 : 1, size = std::ceil(margin * scale) / scale;
        if (!std::isnan(margin)) parts.push_back(of + " within " + short_number(size) + unit);
    };
    add("NEES/dim", 100 * reached.nees, " % of 1");
    add("directions", 100 * reached.direction, " %");
    add("bias", reached.bias, " sigma");
    return parts.empty() ? "" : "shown at 95 %: " + joined(parts);
}

/// `nine of ten such studies would find NEES/dim of 0.61 or 1.34`
std::string findable_text(const ArmReport& arm) {
    const Interval& faults = arm.consistency.smallest_faults;
    std::vector<std::string> found;
    if (!std::isnan(faults.low)) found.push_back(number(faults.low, 2));
    if (!std::isnan(faults.high)) found.push_back(number(faults.high, 2));
    return found.empty() ? "" : "nine of ten such studies would find NEES/dim of " + joined(found, " or ");
}

/// The suspicions, those that need the fewest trials first.
std::vector<std::string> suspicion_texts(const ArmReport& arm) {
    constexpr std::size_t most = 3;
    std::vector<Suspicion> suspicions = arm.consistency.suspicions;
    std::ranges::sort(suspicions, {}, [](const Suspicion& one) { return one.trials.value; });
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < std::min(most, suspicions.size()); ++i)
        texts.push_back(suspicion_text(arm, suspicions[i]));
    if (suspicions.size() > most)
        texts.push_back(std::to_string(suspicions.size() - most) + " more look wrong and are not shown to be");
    return texts;
}

/// The reasons why an arm is undecided, and whether there are any data.
std::vector<std::string> undecided_reasons(const ArmReport& arm) {
    const Consistency& verdict = arm.consistency;
    if (arm.evidence.trials == 0) return {"no trial is left that could be judged"};
    if (verdict.verdict != Verdict::undecided) return {};
    std::vector<std::string> reasons = verdict.reasons;
    std::ranges::copy(suspicion_texts(arm), std::back_inserter(reasons));
    for (const std::string& text : {needed_text(arm), reached_text(arm), findable_text(arm)})
        if (!text.empty()) reasons.push_back(text);
    return reasons;
}

/// What the errors over P may be, given those of the truth, and how accurate a truth would decide.
void add_truth(const Consistency& verdict, std::vector<Reason>& reasons) {
    if (verdict.truth.empty()) return;
    constexpr std::size_t most = 4;
    std::vector<std::string> parts;
    for (const TruthFactor& one : verdict.truth)
        if (parts.size() < most)
            parts.push_back(one.group + " " + ratio_text(one.factor.low) + " to " + ratio_text(one.factor.high));
    reasons.push_back({"mean squared error over P's, given the truth's own (95 %):", parts});
    const double deciding = std::ranges::min_element(verdict.truth, {}, &TruthFactor::deciding_sigma)->deciding_sigma;
    if (verdict.verdict == Verdict::undecided && deciding < 1)
        reasons.push_back({"a truth with " + ratio_text(deciding) + " times this sigma would decide", {}});
}

}  // namespace

std::string verdict_word(const ArmReport& arm) {
    return arm.not_run() ? "not run yet" : verdict_name(arm.consistency.verdict);
}

Cell verdict_cell(const ArmReport& arm) {
    return Cell::Piece{verdict_word(arm), std::nullopt, {}, arm.consistency.verdict};
}

Cell failed_cell(const ArmReport& arm) {
    return arm.not_run() ? Cell("-") : count_cell(static_cast<double>(arm.failed_trials()));
}

std::string unseen_text(const ArmReport& arm) {
    const double share = 100 * arm.evidence.may_be_unseen();
    if (arm.not_run() || !(share < 100)) return {};
    const double unit = std::pow(10, std::floor(std::log10(share)) - 1);
    return "at most " + short_number(std::ceil(share / unit) * unit) + " %";
}

std::string verdict_clause(const ArmReport& arm) {
    const bool plain = !arm.not_run() && arm.consistency.verdict == Verdict::failed;
    return (plain ? "" : "is ") + verdict_word(arm);
}

std::string reason_text(const Reason& reason) {
    return reason.parts.empty() ? reason.head : reason.head + " " + joined(reason.parts);
}

std::string no_claim_text(const ArmReport& arm) {
    if (arm.not_run()) return "not run yet: no trial of it is in the file";
    const std::string text = failed_text(arm);
    return text.empty() ? joined(undecided_reasons(arm), "; ") : text;
}

bool has_run(const Report& report, const std::string& scenario) {
    return std::ranges::any_of(report.arms,
                               [&](const ArmReport& arm) { return arm.scenario == scenario && !arm.not_run(); });
}

std::vector<Reason> reasons_of(const ArmReport& arm) {
    if (arm.not_run()) return {};
    const Consistency& verdict = arm.consistency;
    std::vector<Reason> reasons;
    if (const std::string text = failed_text(arm); !text.empty()) reasons.push_back({text, {}, true});
    const auto list = [&](Fault what, const std::string& measure, bool directions = false) {
        if (auto parts = findings_parts(verdict.findings, what, directions); !parts.empty())
            reasons.push_back({fault_name(what) + " (" + measure + "):", std::move(parts), true});
    };
    list(Fault::optimistic, "NEES/dim");
    list(Fault::pessimistic, "NEES/dim");
    list(Fault::optimistic, "directions", true);
    list(Fault::pessimistic, "directions", true);
    list(Fault::biased, "mean error/sigma");
    list(Fault::correlated, "whitened innovations");
    if (!std::ranges::all_of(arm.evidence.whiteness, &Whiteness::known))
        reasons.push_back({"note, innovations: their correlation could not be computed", {}});
    if (verdict.attribution) reasons.push_back({sentence(*verdict.attribution), {}});
    for (const std::string& hint : verdict.hints) reasons.push_back({"hint: " + hint, {}});
    add_truth(verdict, reasons);
    for (const TurningPoint& one : verdict.turning_points)
        reasons.push_back({"what is too large in " + one.where + " vanishes if the truth is off by " +
                               formatted("%.2g ", one.vanishes) + one.unit + (one.unit.empty() ? "" : " ") +
                               "(sigma of each axis); P would be right at " + formatted("%.2g ", one.right) + one.unit,
                           {}});
    const double share_of_ten = 10 / static_cast<double>(arm.evidence.trials);
    if (const WorstTrials& worst = arm.evidence.worst; worst.share > std::max(0.2, 2 * share_of_ten)) {
        std::vector<std::string> parts;
        for (const WorstTrial& one : worst.trials)
            parts.push_back(std::to_string(one.trial) + " (step " + std::to_string(one.step) + ")");
        reasons.push_back({"note, ten trials carry " + number(100 * worst.share, 0) + " % of NEES:", parts});
    }
    for (const Finding& caution : verdict.cautions) reasons.push_back({"note, " + sentence(caution), {}});
    for (const std::string& text : undecided_reasons(arm)) reasons.push_back({text, {}});
    if (verdict.verdict == Verdict::consistent) reasons.push_back({reached_text(arm), {}});
    return reasons;
}

const ColumnReport& column_named(const std::vector<ColumnReport>& columns, const std::string& name) {
    const auto found = std::ranges::find(columns, name, &ColumnReport::name);
    return found == columns.end() ? columns.front() : *found;
}

std::string column_title(const std::string& column, const std::string& unit) {
    const std::string name = column == "trace_P"        ? "trace(P), last step"
                             : column == "mean_trace_P" ? "trace(P), mean over the steps"
                             : column == "log_score"    ? "log score, mean over the steps"
                             : column == "pose_error"   ? "pose error, sum over the poses"
                             : column == "path_length"  ? "length of the true path"
                                                        : column;
    return unit == "1" ? name : name + " [" + unit + "]";
}

std::vector<const GroupEvidence*> shown_groups(const Evidence& evidence) {
    constexpr std::size_t most = 10;
    std::vector<const GroupEvidence*> groups;
    for (const GroupEvidence& group : evidence.groups) groups.push_back(&group);
    if (groups.size() <= most) return groups;
    const auto distance = [](const GroupEvidence* group) { return std::abs(std::log(group->run.mean)); };
    std::ranges::stable_sort(groups.begin() + 1, groups.end(), std::greater(), distance);
    groups.resize(most);
    return groups;
}

double mean_of(const std::vector<double>& values) {
    double sum = 0, known = 0;
    for (const double value : values)
        if (!std::isnan(value)) {
            sum += value;
            ++known;
        }
    return sum / known;
}

WorstDistribution worst_distribution(const DistributionEvidence& distribution) {
    std::size_t worst = 0;
    WorstDistribution found;
    for (std::size_t k = 0; k < distribution.distance.size(); ++k) {
        found.known += !std::isnan(distribution.distance[k]);
        if (!(distribution.distance[k] <= distribution.distance[worst]))
            worst = std::isnan(distribution.distance[k]) ? worst : k;
    }
    if (found.known == 0) return found;
    found.step = static_cast<int>(worst) + 1;
    found.distance = distribution.distance[worst];
    found.p = std::min(1.0, distribution.p[worst] * found.known);
    return found;
}

int lags_outside(const std::vector<Whiteness>& whiteness) {
    const auto is_outside = [](const Whiteness& lag) { return std::abs(lag.scaled) > lag.simultaneous_bound; };
    return static_cast<int>(std::ranges::count_if(whiteness, is_outside));
}

std::string of_steps(int outside, int steps) { return std::to_string(outside) + " of " + std::to_string(steps); }

}  // namespace credence
