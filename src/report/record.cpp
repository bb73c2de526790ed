// The report of a record: that of a study, and what only a record can be asked.

#include <algorithm>
#include <cmath>
#include <credence/error.hpp>
#include <credence/report.hpp>
#include <credence/text.hpp>
#include <map>

#include "record/results.hpp"
#include "report/format.hpp"
#include "statistics/goodness.hpp"
#include "verdict/judgement.hpp"

namespace credence {

namespace {

/// A covariance that is singular at the start makes every trial fail there.
void hint_at_known_start(const Record& record, Consistency& verdict) {
    const auto at_start = [](const RecordTrouble& trouble) {
        return trouble.step == 0 && trouble.status == Status::covariance_not_positive_definite;
    };
    if (verdict.verdict == Verdict::failed && std::ranges::all_of(record.troubles, at_start))
        verdict.hints.push_back(
            "the covariance cannot be inverted at the first step: if the start is known exactly (P0 = 0), begin the "
            "record one step later, or make the known components NaN at that step; components that are known at every "
            "step are left out where their errors are 0 too");
}

/// Steps that were left out because their errors were large leave large ones beside them.
void hint_at_gaps(const RecordGaps& gaps, Consistency& verdict) {
    constexpr double surely = 4, clearly = 1.2;
    if (gaps.difference > surely && gaps.beside > clearly * gaps.elsewhere)
        verdict.hints.push_back("steps are missing beside large errors: NEES/dim is " + number(gaps.beside, 2) +
                                " at the steps beside a gap and " + number(gaps.elsewhere, 2) +
                                " at the others; write the steps with large errors, too");
}

/// Innovations that a gate removed are missing beyond a quantile of chi-square, at which the others end abruptly. Noise
/// that is bounded ends so too where S is right, but for another mean; correlated innovations may end anywhere.
void hint_at_gate(const Record& record, const Evidence& evidence, Consistency& verdict) {
    constexpr double surely = 30, abrupt = 25, near = 2.5, white = 0.2;
    const auto correlated = [](const Whiteness& lag) { return std::abs(lag.scaled) > white; };
    if (std::ranges::any_of(evidence.whiteness, correlated)) return;
    for (const LargestNis& nis : record.largest_nis) {
        if (nis.rows < 1 || nis.largest.size() < 10) continue;
        const double end = nis.largest.back(), below = 1 - chi_square_p(end, nis.rows),
                     missing = nis.count * (1 - below);
        const auto moment = [&](int power) { return (1 - chi_square_p(end, nis.rows + 2 * power)) / below; };
        const double mean = nis.rows * moment(1), square = nis.rows * (nis.rows + 2) * moment(2),
                     error = std::sqrt((square - mean * mean) / nis.count),
                     at_end = nis.count * (1 - (1 - chi_square_p(nis.largest.front(), nis.rows)) / below);
        if (missing < surely || at_end > abrupt || std::abs(nis.sum / nis.count - mean) > near * error) continue;
        verdict.hints.push_back("no innovation (" + nis.part + ") has a NIS beyond " + number(end, 2) + ", where " +
                                number(missing, 0) + " of " + number(nis.count, 0) +
                                " should be; the others are spread as they should: did a gate remove them?");
        return;
    }
}

bool is_too_large(const Finding& finding) {
    return finding.what == Fault::optimistic && (finding.about == Subject::size || finding.about == Subject::direction);
}

/// The innovations are right, the errors are not what P says, and no cause is named.
void hint_at_innovations(const Evidence& evidence, Consistency& verdict) {
    if (!verdict.looks_wrong() || !verdict.hints.empty() || evidence.groups.empty() ||
        !innovations_are_right(evidence, verdict.limits))
        return;
    const NisEvidence& nis = evidence.nis.front();
    const bool large = std::ranges::any_of(verdict.findings, is_too_large);
    // An update leaves P as it is in all directions but as many as it has rows.
    constexpr double near = 0.8;
    const double steps = nis.nis.observed, rows = nis.degrees / static_cast<double>(evidence.trials) / steps;
    const std::vector<double>& spectrum = verdict.directions.spectrum;
    const auto left = std::ranges::count_if(spectrum, [](double ratio) { return ratio > near && ratio < 1 / near; });
    if (!large && (!(evidence.groups.front().run.mean < 1 - 3 * verdict.limits.margin) ||
                   static_cast<double>(left) < static_cast<double>(spectrum.size()) - rows - 0.5))
        return;
    verdict.hints.push_back(
        "the innovations are as large as S says (NIS/m " + number(nis.ratio, 2) +
        (large
             ? "): what do they not see: a truth or a measurement of another step or frame, a bias that is drawn once "
               "in a run?"
             : "): is P that before the update, or is what is too large not measured?"));
}

/// Groups of a joint covariance that are whole at no step of any trial: the verdict is of the others.
void name_absent_groups(const Evidence& evidence, const Limits& limits, std::vector<std::string>& sentences) {
    if (!evidence.joint || evidence.trials == 0) return;
    std::vector<std::string> absent;
    for (const GroupEvidence& group : evidence.groups)
        if (!(group.run.count > 0) && !is_rounded(group, limits)) absent.push_back(group.name);
    if (!absent.empty())
        sentences.push_back("No trial has all components of " + joined(absent) +
                            " at a step: the verdict is of the others.");
}

std::string nees_text(const GroupEvidence& state) { return with_interval(state.run.mean, over_steps95(state)); }

/// Whether a mean error or the spread about it is what is too large.
void attribute_errors(const Record& record, ArmReport& arm) {
    const auto speaks = [](const Finding& one) { return one.what == Fault::optimistic || one.what == Fault::biased; };
    if (!record.about_means || arm.evidence.truth || !std::ranges::any_of(arm.consistency.findings, speaks)) return;
    const AboutMeans about = record.about_means();
    arm.consistency.attribution = attribute(arm.evidence, arm.consistency,
                                            evidence_of(about.results, about.results.arms.front()), about.share);
}

/// Of a log, by unit, the largest group or else a component whose NEES is too large; one without a unit is by itself.
void find_turning_points(const Record& record, const Evidence& evidence, Consistency& verdict) {
    std::map<std::string, std::pair<std::vector<int>, const Finding*>> largest;
    const auto unit_of = [&](int j) { return evidence.bias[static_cast<std::size_t>(j)].unit; };
    for (const Finding& finding : verdict.findings) {
        if (finding.about != Subject::size || finding.what != Fault::optimistic) continue;
        std::vector<int> members;
        for (const GroupEvidence& group : evidence.groups)
            if (group.name == finding.where) members = group.components;
        for (int j = 0; members.empty() && j < std::ssize(evidence.bias); ++j)
            if (evidence.bias[static_cast<std::size_t>(j)].component == finding.where) members = {j};
        const std::string unit = unit_of(members.front());
        const auto of_another = [&](int j) { return unit.empty() ? j != members.front() : unit_of(j) != unit; };
        if (std::ranges::any_of(members, of_another)) continue;
        auto& most = largest[unit.empty() ? finding.where : unit];
        if (members.size() > most.first.size()) most = {members, &finding};
    }
    const SegmentEvidence& segments = evidence.segments;
    for (const auto& [key, one] : largest) {
        const auto& [members, finding] = one;
        // Of segments that do not count the bound is that on errors about their mean [verdict/segments.cpp].
        const double above = segments.count || segments.run.empty()
                                 ? finding->value / finding->interval.low
                                 : bounds_at_any_correlation(static_cast<double>(segments.run.size()),
                                                             static_cast<int>(members.size()), levels::run / 2)
                                       .high;
        const std::vector<double> sigmas = record.truth_sigmas(members, {(1 + verdict.limits.margin) * above, 1});
        if (sigmas.front() > 0)
            verdict.turning_points.push_back({finding->where, unit_of(members.front()), sigmas.front(), sigmas.back()});
    }
}

/// Gives the means of the whole record the intervals of its segments.
void set_means(const ScenarioResults& segments, ArmReport& arm) {
    const Evidence& evidence = arm.evidence;
    for (ColumnReport& column : arm.columns) {
        Moments moments;
        if (column.name == "nees_ratio" && !std::isnan(column.summary.mean)) moments = evidence.groups.front().run;
        if (column.name == "nis_ratio" && !evidence.nis.empty()) {
            const NisEvidence& nis = evidence.nis.front();
            const auto count = static_cast<double>(evidence.segments.run.size());
            const double se = half_width(nis.ratio95) / t_quantile(0.05, count - 1);
            moments = {count, nis.ratio, se * std::sqrt(count), se};
        }
        if (column.name == "log_score") moments = column_moments(segments.arms.front(), RecordColumn::log_score);
        if (moments.count > 0) column.summary = summary_of(moments);
    }
}

/// NEES with the error in the other charts, where the given one is doubted: beside the record's own, without a verdict.
void try_other_charts(const Record& record, ArmReport& arm) {
    Consistency& verdict = arm.consistency;
    const GroupEvidence& own = arm.evidence.groups.front();
    const bool doubted = verdict.chart_doubted || std::ranges::any_of(verdict.findings, is_too_large);
    if (record.in_other_charts.empty() || verdict.mix_up || !doubted || !(own.run.count > 0)) return;
    const auto off = [](const GroupEvidence& group) { return std::abs(std::log(group.run.mean)); };
    std::string nearest;
    std::vector<std::string> tried{nees_text(own) + " with the error in the chart `" + record.chart + "`"};
    double least = off(own) / 2;
    for (const auto& read : record.in_other_charts) {
        const Record other = read();
        const Evidence evidence = evidence_of(other);
        for (const GroupEvidence& group : evidence.groups)
            arm.evidence.charts.push_back(
                {other.chart, group.name, group.dimension, group.run, group.step, group.anees});
        const GroupEvidence& theirs = evidence.groups.front();
        tried.push_back(nees_text(theirs) + " in the chart `" + other.chart + "`");
        if (off(theirs) < least) {
            least = off(theirs);
            nearest = other.chart;
        }
    }
    if (!nearest.empty()) verdict.hints.clear();  // they were of errors in the wrong chart
    verdict.mix_up = !nearest.empty();
    const std::string form = nearest == "plain" ? " (position in the world, heading apart: R2 x SO2, or R3 x SO3)" : "";
    verdict.hints.push_back("NEES/dim of " + own.name + " is " + joined(tried, ", and ") +
                            (nearest.empty() ? ": the chart is not what is wrong"
                                             : ": does the covariance belong to the error in `" + nearest + "`" + form +
                                                   "?"));
}

}  // namespace

Report make_record_report(Record record, const std::string& path, const Limits& limits) {
    ScenarioResults& results = record.results;
    Report report;
    report.source = "record " + printable(path, path.size());
    report.limits = limits;
    report.segments = record.segments.asked;
    report.troubles = record.troubles;
    report.not_judged = results.not_judged;
    results.scenario.title.clear();  // the source names it
    report.scenarios.push_back(results.scenario);
    constexpr std::uint64_t bootstrap_seed = 1;
    report.arms.push_back(report_arm(results, results.arms.front(), evidence_of(record), bootstrap_seed, limits));
    results.arms.clear();  // large, and of no further use
    ArmReport& arm = report.arms.front();
    arm.gaps = record.gaps;
    arm.curves = std::move(record.curves);
    if (arm.evidence.segments.count) {
        if (!arm.evidence.of_finite) set_means(*record.segments.results, arm);
        if (arm.evidence.of_few_runs())
            report.not_judged.push_back(
                "What is drawn once in a run, such as a constant bias, the map or the start, is seen once in each: so "
                "few "
                "runs cannot show whether P is right about it.");
    }
    arm.every = record.every;
    if (arm.every > 1) {
        const std::string every = std::to_string(arm.every);
        report.not_judged.push_back("Figures by step are of one step in " + every +
                                    ": their step k is step " + every + " (k - 1) + 1 of the record.");
    }
    const auto is_copy = [](const RecordTrouble& trouble) { return trouble.status == Status::completed; };
    if (std::ranges::any_of(record.troubles, is_copy)) arm.cause.reset();  // their status says less
    try_other_charts(record, arm);
    hint_at_known_start(record, arm.consistency);
    hint_at_gaps(arm.gaps, arm.consistency);
    hint_at_gate(record, arm.evidence, arm.consistency);
    hint_at_innovations(arm.evidence, arm.consistency);
    attribute_errors(record, arm);
    name_absent_groups(arm.evidence, limits, report.not_judged);
    if (record.truth_sigmas && (arm.evidence.of_few_runs() || arm.evidence.trials == 1))
        find_turning_points(record, arm.evidence, arm.consistency);
    show_finite_trials(arm.evidence, limits);
    return report;
}

}  // namespace credence
