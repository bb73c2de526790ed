#include <credence/report.hpp>

#include <credence/text.hpp>

#include <cmath>
#include <cstdio>

namespace credence {

namespace {

/// Left- or right-pads to a width counted in characters, not bytes.
std::string padded(const std::string& text, int width, bool right = true) {
    int characters = 0;
    for (const char c : text) characters += (static_cast<unsigned char>(c) & 0xc0) != 0x80;
    const std::string space(static_cast<std::size_t>(std::max(0, width - characters)), ' ');
    return right ? space + text : text + space;
}

std::string number(double value, int digits) {
    if (std::isnan(value)) return "-";
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, "%.*f", digits, value);
    return buffer;
}

/// Decimals that show two digits of the uncertainty, at most 6.
int decimals_for(double uncertainty) {
    if (!(uncertainty > 0)) return 4;
    return std::clamp(1 - static_cast<int>(std::floor(std::log10(uncertainty))), 0, 6);
}

std::string with_interval(const Summary& summary) {
    const double half = (summary.ci95.high - summary.ci95.low) / 2;
    const int digits = decimals_for(half);
    return number(summary.mean, digits) + " ± " + number(half, digits);
}

std::string title_of(const std::string& figure, const std::string& unit) {
    const std::string name = figure == "trace_P" ? "trace(P)" : figure == "pose_error" ? "pose error" : figure;
    return unit == "1" ? name : name + " [" + unit + "]";
}

std::string published_text(const FigureReport& figure) {
    if (!figure.published) return "";
    return to_text(figure.published->value) + " (" + number(figure.published->percentile, 1) + " %)";
}

std::string figure_row(const std::string& label, const FigureReport& figure) {
    const Summary& s = figure.summary;
    const int digits = decimals_for((s.ci95.high - s.ci95.low) / 2);
    return "    " + padded(label, 24, false) + padded(with_interval(s), 22) + padded(number(s.median, digits), 12) +
           padded(number(s.standard_deviation, digits), 12) + padded(published_text(figure), 20) + "\n";
}

const FigureReport& figure_of(const std::vector<FigureReport>& figures, const std::string& name) {
    for (const FigureReport& figure : figures)
        if (figure.name == name) return figure;
    return figures.front();
}

/// A part with the arms and their differences, one row each.
std::string figure_part(const Report& report, const std::string& scenario, const std::string& name) {
    std::string text;
    for (const ArmReport& arm : report.arms) {
        if (arm.scenario != scenario) continue;
        const FigureReport& figure = figure_of(arm.figures, name);
        if (text.empty()) text = "  " + title_of(name, figure.unit) + "\n";
        text += figure_row(arm.arm, figure);
    }
    for (const PairReport& pair : report.pairs)
        if (pair.scenario == scenario) text += figure_row("greedy - fixed", figure_of(pair.figures, name));
    return text;
}

std::string consistency_part(const Report& report, const std::string& scenario) {
    std::string text = "  consistency" + padded("NEES/n", 31) + padded("NIS/m", 22) + padded("failed", 10) + "   verdict\n";
    for (const ArmReport& arm : report.arms) {
        if (arm.scenario != scenario) continue;
        text += "    " + padded(arm.arm, 18, false) + padded(with_interval(figure_of(arm.figures, "nees_ratio").summary), 22) +
                padded(with_interval(figure_of(arm.figures, "nis_ratio").summary), 22) +
                padded(std::to_string(arm.failed), 10) + "   " + verdict_name(arm.consistency.verdict) + "\n";
    }
    return text;
}

/// The findings of one arm, the widest blocks first, cut to what a reader takes in; JSON has them all.
std::string findings_part(const ArmReport& arm) {
    constexpr std::size_t most = 6;
    std::string text;
    const std::vector<Finding>& findings = arm.consistency.findings;
    for (std::size_t i = 0; i < std::min(most, findings.size()); ++i)
        text += "    " + padded(i == 0 ? arm.arm : "", 12, false) + sentence(findings[i]) + "\n";
    if (findings.size() > most)
        text += "    " + padded("", 12) + "and " + std::to_string(findings.size() - most) + " more (--format json)\n";
    if (arm.consistency.verdict == Verdict::undecided && arm.consistency.trials_to_decide > 0)
        text += "    " + padded(findings.empty() ? arm.arm : "", 12, false) + "undecided: about " +
                number(arm.consistency.trials_to_decide, 0) + " trials would decide\n";
    return text;
}

std::string scenario_part(const Report& report, const Scenario& scenario) {
    std::string text = "\n" + scenario.name + (scenario.title.empty() ? "" : ": " + scenario.title) + "\n";
    text += padded("mean ± 95 %", 50) + padded("median", 12) + padded("sd", 12) + padded("published (pctl.)", 20) + "\n";
    for (const char* name : {"trace_P", "unseen", "pose_error"}) text += figure_part(report, scenario.name, name);
    text += consistency_part(report, scenario.name);
    for (const ArmReport& arm : report.arms)
        if (arm.scenario == scenario.name) text += findings_part(arm);
    return text;
}

/// Studies with many failed trials say so before anything else.
std::string warnings_part(const Report& report) {
    std::string text;
    for (const ArmReport& arm : report.arms) {
        const std::string name = arm.scenario + "/" + arm.arm;
        if (static_cast<double>(arm.failed) > 0.01 * static_cast<double>(arm.trials))
            text += "WARNING: " + std::to_string(arm.failed) + " of " + std::to_string(arm.trials) + " trials of " + name +
                    " failed and are left out of its figures.\n";
        if (arm.diverged > 0)
            text += "note: " + std::to_string(arm.diverged) + " trials of " + name + " diverged; they are in the figures.\n";
    }
    if (!report.complete) text += "note: the study is not complete.\n";
    return text;
}

}  // namespace

std::string report_text(const Report& report) {
    std::string text = warnings_part(report);
    const std::int64_t trials = report.arms.empty() ? 0 : report.arms.front().trials;
    text += "study " + report.study_hash + ": " + std::to_string(trials) + " trials of each arm, root seed " +
            std::to_string(report.root_seed) + ". NEES/n and NIS/m are 1 for a consistent filter;\n" +
            "the verdict holds every block of the state, at every step, against 1 ± " + to_text(report.margin) +
            ". Intervals are two-sided 95 %.\n";
    for (const Scenario& scenario : report.scenarios) text += scenario_part(report, scenario);
    return text;
}

}  // namespace credence
