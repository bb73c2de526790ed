#include <credence/report.hpp>

#include <credence/error.hpp>
#include <credence/text.hpp>

#include <cmath>
#include <limits>

namespace credence {

namespace {

bool is_figure(const Column& column) { return column.type != ColumnType::status && column.name != "status_pose"; }

/// A column's values with failed trials as NaN, whatever their fill.
std::vector<double> figure_values(const ArmResults& arm, std::size_t column) {
    std::vector<double> values = arm.columns[column];
    for (std::size_t i = 0; i < values.size(); ++i)
        if (failed(static_cast<Status>(static_cast<int>(arm.columns[column_status][i]))))
            values[i] = std::numeric_limits<double>::quiet_NaN();
    return values;
}

const std::vector<PublishedFigure>* published_of(const Scenario& scenario, const std::string& column) {
    if (column == "trace_P") return &scenario.published.trace_P;
    if (column == "unseen") return &scenario.published.unseen;
    if (column == "pose_error") return &scenario.published.pose_error;
    return nullptr;
}

std::optional<PublishedPlace> place_of(const Scenario& scenario, const std::string& column, const std::string& arm,
                                       const std::vector<double>& values) {
    if (const auto* figures = published_of(scenario, column))
        for (const PublishedFigure& figure : *figures)
            if (figure.arm == arm) return PublishedPlace{figure.value, percentile_of(values, figure.value)};
    return std::nullopt;
}

ArmReport arm_report(const ScenarioResults& results, const ArmResults& arm, double margin) {
    ArmReport report{results.scenario.name, arm.name, results.trials, 0, 0, {}, judge(results, arm, margin)};
    for (const double status : arm.columns[column_status]) {
        report.failed += failed(static_cast<Status>(static_cast<int>(status)));
        report.diverged += static_cast<int>(status) == static_cast<int>(Status::diverged);
    }
    for (std::size_t c = 0; c < results.columns.size(); ++c) {
        const Column& column = results.columns[c];
        if (!is_figure(column)) continue;
        const std::vector<double> values = figure_values(arm, c);
        report.figures.push_back({column.name, column.unit, summarise(values),
                                  place_of(results.scenario, column.name, arm.name, values)});
    }
    return report;
}

PairReport pair_report(const ScenarioResults& results, const ArmResults& planned, const ArmResults& fixed) {
    PairReport report{results.scenario.name, planned.name + " - " + fixed.name, {}};
    for (std::size_t c = 0; c < results.columns.size(); ++c)
        if (is_figure(results.columns[c]))
            report.figures.push_back({results.columns[c].name, results.columns[c].unit,
                                      summarise(paired_differences(figure_values(planned, c),
                                                                   figure_values(fixed, c))), {}});
    return report;
}

/// `greedy.X` has its partner in `fixed.X`.
const ArmResults* fixed_partner(const ScenarioResults& results, const ArmResults& arm) {
    const std::size_t dot = arm.name.find('.');
    if (arm.name.substr(0, dot) != "greedy") return nullptr;
    for (const ArmResults& other : results.arms)
        if (other.name == "fixed" + arm.name.substr(dot)) return &other;
    return nullptr;
}

}  // namespace

Report make_report(const Study& study, double margin) {
    Report report{study_hash(study), study.root_seed, study.complete, margin, {}, {}, {}};
    for (const ScenarioResults& results : study.scenarios) {
        report.scenarios.push_back(results.scenario);
        for (const ArmResults& arm : results.arms) report.arms.push_back(arm_report(results, arm, margin));
        for (const ArmResults& arm : results.arms)
            if (const ArmResults* partner = fixed_partner(results, arm))
                report.pairs.push_back(pair_report(results, arm, *partner));
    }
    return report;
}

void require_consistent(const Report& report) {
    std::vector<std::string> others;
    for (const ArmReport& arm : report.arms)
        if (arm.consistency.verdict != Verdict::consistent)
            others.push_back(arm.scenario + "/" + arm.arm + " is " + verdict_name(arm.consistency.verdict));
    if (!others.empty()) throw Failure("required consistent, but " + joined(others) + ".");
}

}  // namespace credence
