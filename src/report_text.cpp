#include <credence/report.hpp>

#include <credence/text.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace credence {

namespace {

/// Left- or right-pads to a width counted in characters, not bytes.
std::string padded(const std::string& text, int width, bool right = true) {
    int characters = 0;
    for (const char c : text) characters += (static_cast<unsigned char>(c) & 0xc0) != 0x80;
    const std::string space(static_cast<std::size_t>(std::max(1, width - characters)), ' ');  // never glued together
    return right ? space + text : text + space;
}

std::string number(double value, int digits) {
    if (std::isnan(value)) return "-";
    char buffer[64];
    if (std::abs(value) < 1e6) std::snprintf(buffer, sizeof buffer, "%.*f", digits, value);
    else std::snprintf(buffer, sizeof buffer, "%.4g", value);
    return buffer;
}

/// Decimals that show two digits of the uncertainty, at most 6.
int decimals_for(double uncertainty) {
    if (!(uncertainty > 0) || std::isinf(uncertainty)) return 4;
    return std::clamp(1 - static_cast<int>(std::floor(std::log10(uncertainty))), 0, 6);
}

std::string with_interval(const Summary& summary) {
    const double half = (summary.ci95.high - summary.ci95.low) / 2;
    const int digits = decimals_for(half);
    return std::isnan(half) ? number(summary.mean, digits)
                            : number(summary.mean, digits) + " ± " + number(half, digits);
}

std::string title_of(const std::string& figure, const std::string& unit) {
    const std::string name = figure == "trace_P" ? "trace(P)" : figure == "pose_error" ? "pose error" : figure;
    return unit == "1" ? name : name + " [" + unit + "]";
}

std::string published_text(const PublishedPlace& published) {
    return to_text(published.value) + " (" + number(published.percentile, 1) + " %)";
}

std::string figure_row(const std::string& label, const FigureReport& figure) {
    const Summary& s = figure.summary;
    const int digits = decimals_for((s.ci95.high - s.ci95.low) / 2);
    return "    " + padded(label, 24, false) + padded(with_interval(s), 22) + padded(number(s.median, digits), 12) +
           padded(number(s.standard_deviation, digits), 12) +
           (figure.published ? padded(published_text(*figure.published), 20) : "") + "\n";
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
    std::string text =
        "  consistency" + padded("NEES/n", 31) + padded("NIS/m", 22) + padded("failed", 10) + "   verdict\n";
    for (const ArmReport& arm : report.arms) {
        if (arm.scenario != scenario) continue;
        text += "    " + padded(arm.arm, 18, false) +
                padded(with_interval(figure_of(arm.figures, "nees_ratio").summary), 22) +
                padded(with_interval(figure_of(arm.figures, "nis_ratio").summary), 22) +
                padded(std::to_string(arm.failed), 10) + "   " + verdict_name(arm.consistency.verdict) + "\n";
    }
    return text;
}

/// How far a finding is from what a consistent filter gives.
double distance_off(const Finding& finding) {
    return finding.what == "biased" ? std::abs(finding.value) : std::abs(std::log(finding.value));
}

/// The findings of one kind: each block or component at its worst, the farthest off first.
std::vector<std::string> findings_parts(const std::vector<Finding>& findings, const std::string& what) {
    constexpr std::size_t most = 4;
    std::vector<Finding> worst;
    for (const Finding& finding : findings) {
        if (finding.what != what) continue;
        const auto same =
            std::find_if(worst.begin(), worst.end(), [&](const Finding& f) { return f.where == finding.where; });
        if (same == worst.end()) worst.push_back(finding);
        else if (distance_off(finding) > distance_off(*same)) *same = finding;
    }
    std::sort(worst.begin(), worst.end(),
              [](const Finding& f, const Finding& g) { return distance_off(f) > distance_off(g); });
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < std::min(most, worst.size()); ++i)
        parts.push_back(worst[i].where + " " + number(worst[i].value, 2) + " (" + worst[i].when + ")");
    if (worst.size() > most) parts.push_back(std::to_string(worst.size() - most) + " more");
    return parts;
}

/// `head` and the parts between commas, wrapped.
std::string wrapped_list(const std::string& head, const std::vector<std::string>& parts) {
    constexpr std::size_t width = 96;
    std::string text = head;
    std::size_t column = head.size();
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (column + parts[i].size() > width) {
            text += "\n" + std::string(18, ' ');
            column = 2;
        }
        text += (i > 0 && text.back() == ' ' ? "" : " ") + parts[i] + (i + 1 < parts.size() ? "," : "");
        column += parts[i].size() + 2;
    }
    return text;
}

/// Why an arm has its verdict; JSON has every finding with its interval.
std::string findings_part(const ArmReport& arm) {
    std::string text;
    const auto add = [&](const std::string& line) {
        text += "    " + padded(text.empty() ? arm.arm : "", 12, false) + line + "\n";
    };
    for (const char* what : {"optimistic", "pessimistic", "biased"})
        if (const auto parts = findings_parts(arm.consistency.findings, what); !parts.empty())
            add(wrapped_list(std::string(what) + (std::string(what) == "biased" ? " (error/sigma):" : " (NEES/dim):"),
                             parts));
    if (arm.consistency.verdict == Verdict::undecided && arm.consistency.trials_to_decide > 0)
        add("undecided: about " + number(arm.consistency.trials_to_decide, 0) + " trials would decide");
    return text;
}

bool has_published(const Scenario& scenario) {
    return !(scenario.published.trace_P.empty() && scenario.published.unseen.empty() &&
             scenario.published.pose_error.empty());
}

std::string scenario_part(const Report& report, const Scenario& scenario) {
    std::string text = "\n" + scenario.name + (scenario.title.empty() ? "" : ": " + scenario.title) + "\n";
    text += padded("mean ± 95 %", 50) + padded("median", 12) + padded("sd", 12) +
            (has_published(scenario) ? padded("published (pctl.)", 20) : "") + "\n";
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
            text += "WARNING: " + std::to_string(arm.failed) + " of " + std::to_string(arm.trials) + " trials of " +
                    name + " failed and are left out of its figures.\n";
        if (arm.diverged > 0)
            text += "note: " + std::to_string(arm.diverged) + " trials of " + name +
                    " diverged; they are in the figures.\n";
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
