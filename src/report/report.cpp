#include <algorithm>
#include <cmath>
#include <credence/error.hpp>
#include <credence/report.hpp>
#include <credence/text.hpp>
#include <map>
#include <tuple>

#include "base/nan.hpp"
#include "report/words.hpp"
#include "statistics/bootstrap.hpp"
#include "verdict/judgement.hpp"

namespace credence {

namespace {

/// The place of the arm's published value among these; NaN without values.
std::optional<PublishedPlace> place_of(const std::optional<std::vector<PublishedNumber>>& published,
                                       const std::string& arm, const std::vector<double>& values) {
    if (!published) return std::nullopt;
    for (const PublishedNumber& column : *published)
        if (column.arm == arm) return PublishedPlace{column.value, percentile_of(values, column.value)};
    return std::nullopt;
}

/// NEES and NIS ratios have tests of their own.
bool has_bootstrap(const std::string& column) { return column != "nees_ratio" && column != "nis_ratio"; }

/// Without the trials the distribution is not known.
ColumnReport column_report(const ScenarioResults& results, const ArmResults& arm, std::size_t c,
                           std::uint64_t root_seed) {
    const Column& column = results.columns[c];
    const bool trials = results.keep == Keep::trials;
    std::vector<double> values = trials ? figure_values(results, arm, c) : std::vector<double>();
    const auto published = published_for(results.scenario, column.name);
    ColumnReport report{column.name, column.unit, summary_of(column_moments(arm, c)), {}, std::nullopt,
                        place_of(published, arm.name, values), std::nullopt, column.places};
    if (has_bootstrap(column.name))
        report.bootstrap95 = trials ? bootstrap_mean_interval(
                                          values, root_seed, results.scenario.name + "/" + arm.name + "/" + column.name)
                                    : Interval{nan, nan};
    std::erase_if(values, [](double value) { return std::isnan(value); });
    report.summary.median = quantile(values, 0.5);
    for (const double p : reported_quantiles) report.quantiles.push_back(quantile(values, p));
    if (published && trials)
        report.histogram = histogram(values, column.type == ColumnType::real ? BinWidths::ratio : BinWidths::equal);
    return report;
}

std::optional<FailureCause> cause_of(const ScenarioResults& results, const ArmResults& arm) {
    const std::vector<std::int64_t>& counts = arm.totals.trials.statuses;
    const auto first = counts.begin() + static_cast<int>(Status::diverged);
    const auto most = std::max_element(first, counts.end());
    if (*most == 0) return std::nullopt;
    FailureCause cause{static_cast<Status>(most - counts.begin()), *most, -1, 0,
                       results.blocks.empty() ? "step" : "pose"};
    if (results.keep == Keep::aggregates) return cause;
    const std::size_t column = status_column(results.columns);
    const std::vector<double> statuses = column_values(results, arm, column),
                              poses = column_values(results, arm, column + 1);
    std::map<std::int64_t, std::int64_t> at;
    for (std::size_t i = 0; i < statuses.size(); ++i)
        if (statuses[i] == static_cast<double>(cause.status) && poses[i] >= 0)
            ++at[static_cast<std::int64_t>(poses[i])];
    if (at.empty()) return cause;
    std::tie(cause.pose, cause.at_pose) = *std::ranges::max_element(at, {}, [](const auto& one) { return one.second; });
    return cause;
}

/// Rounding may have changed it too much.
void leave_out_nees(std::vector<ColumnReport>& columns) {
    for (ColumnReport& column : columns) {
        if (column.name != "nees_ratio" && column.name != "log_score") continue;
        column.summary = summarise({});
        std::fill(column.quantiles.begin(), column.quantiles.end(), nan);
    }
}

/// A hint of the first refuted arm: the verdict says that P is wrong, and a budget because of what.
void hint_at_budget(Report& report) {
    const auto refuted = std::ranges::find_if(report.arms, [](const ArmReport& arm) {
        return arm.consistency.looks_wrong() && !arm.consistency.findings.empty();
    });
    if (refuted == report.arms.end()) return;
    const Scenario& scenario = *std::ranges::find(report.scenarios, refuted->scenario, &Scenario::name);
    if (scenario.settings.empty()) return;
    refuted->consistency.hints.push_back("the command `budget` tells which source of noise its error is of, and what "
                                         "P counts for it");
}

}  // namespace

ArmReport report_arm(const ScenarioResults& results, const ArmResults& arm, Evidence evidence, std::uint64_t root_seed,
                     const Limits& limits) {
    ArmReport report{results.scenario.name, arm.name, results.trials, 0, 0, {}, std::move(evidence), {}};
    report.consistency = judge(report.evidence, limits);
    report.evidence.moments.reset();  // large, and of no further use
    report.evidence.truth.reset();
    leave_out_rounded(report.evidence, limits);
    report.failed = report.evidence.left_out;
    report.diverged = report.evidence.diverged;
    report.cause = cause_of(results, arm);
    for (std::size_t c = 0; c < results.columns.size(); ++c)
        if (is_reported(results.columns[c])) report.columns.push_back(column_report(results, arm, c, root_seed));
    if (!report.evidence.groups.empty() && is_rounded(report.evidence.groups.front(), limits))
        leave_out_nees(report.columns);
    return report;
}

Report make_report(const Study& study, const Limits& limits) {
    Report report;
    report.source = "study " + study_hash(study);
    report.root_seed = study.root_seed;
    report.trials = study.trials;
    report.complete = study.complete;
    report.keep = keep_of(study);
    report.limits = limits;
    report.pairs = planned_against_baselines(study.scenarios, study.root_seed);
    for (const ScenarioResults& results : study.scenarios) {
        report.scenarios.push_back(results.scenario);
        const WithTotals with_totals(results);
        for (const ArmResults& arm : (*with_totals).arms) {
            report.arms.push_back(
                report_arm(*with_totals, arm, evidence_of(*with_totals, arm), study.root_seed, limits));
            show_finite_trials(report.arms.back().evidence, limits);
        }
    }
    hint_at_budget(report);
    return report;
}

Report together(std::vector<Report> reports) {
    Report all = std::move(reports.front());
    const bool several = reports.size() > 1;
    const auto name_troubles = [&](Report& report) {
        for (RecordTrouble& trouble : report.troubles)
            if (several)
                trouble.what = report.scenarios.front().name +
                               (report.arms.front().arm == "record" ? "" : "/" + report.arms.front().arm) + ": " +
                               trouble.what;
    };
    name_troubles(all);
    for (std::size_t i = 1; i < reports.size(); ++i) {
        Report& one = reports[i];
        const auto same = std::ranges::find(all.scenarios, one.scenarios.front().name, &Scenario::name);
        const bool again = same != all.scenarios.end(),
                   beside = again && same->components == one.scenarios.front().components &&
                            std::ranges::none_of(all.arms, [&](const ArmReport& arm) {
                                return arm.scenario == same->name && arm.arm == one.arms.front().arm;
                            });
        if (again && !beside) one.scenarios.front().name = one.arms.front().scenario += "_" + std::to_string(i + 1);
        name_troubles(one);
        all.source += ", " + one.source;
        if (!beside) all.scenarios.push_back(std::move(one.scenarios.front()));
        all.arms.push_back(std::move(one.arms.front()));
        all.troubles.insert(all.troubles.end(), one.troubles.begin(), one.troubles.end());
        all.not_judged.insert(all.not_judged.end(), one.not_judged.begin(), one.not_judged.end());
    }
    return all;
}

void require(const Report& report, Requirement requirement, bool strict) {
    std::vector<std::string> others;
    const bool proof = requirement == Requirement::consistent;
    for (const ArmReport& arm : report.arms) {
        const bool open = arm.consistency.verdict == Verdict::undecided && arm.evidence.trials > 0 && !proof;
        if (arm.consistency.verdict != Verdict::consistent && !open)
            others.push_back(arm.scenario + "/" + arm.arm + " " + verdict_clause(arm));
        else if (strict && !arm.consistency.cautions.empty())
            others.push_back(arm.scenario + "/" + arm.arm + " has a note (" +
                             sentence(arm.consistency.cautions.front()) + ")");
    }
    if (!others.empty())
        throw Failure(std::string("required ") + (proof ? "consistent" : "no finding") + ", but " + joined(others));
}

}  // namespace credence
