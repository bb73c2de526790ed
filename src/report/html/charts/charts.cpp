// The page's charts over all steps: the verdict as a picture, coverage, whiteness; and the layout of charts on the
// page.

#include "report/html/charts/chart.hpp"
#include <credence/text.hpp>

#include "report/format.hpp"
#include "report/html/page.hpp"
#include "report/words.hpp"

#include <algorithm>
#include <cmath>

namespace credence::page {

namespace {

constexpr double width = 360, left = 96, right = width - 12, top = 34, row_gap = 7, arm_height = 13;

/// The labels of rows, and their positions.
struct Rows {
    std::vector<std::string> names;
    std::size_t arms;

    double row_height() const { return arm_height * static_cast<double>(arms) + row_gap; }
    double bottom() const { return top + row_height() * static_cast<double>(names.size()); }
    double y(std::size_t row, std::size_t arm) const {
        return top + row_height() * static_cast<double>(row) + row_gap / 2 +
               arm_height * (static_cast<double>(arm) + 0.5);
    }
    void draw(Svg& svg) const {
        constexpr std::size_t longest = 14;
        for (std::size_t row = 0; row < names.size(); ++row) {
            const double middle = top + row_height() * (static_cast<double>(row) + 0.5);
            svg.text({left - 8, middle + 4}, Anchor::end, shortened(names[row], longest), "label row");
        }
    }
};

const GroupEvidence* group_named(const ArmReport& arm, const std::string& name) {
    for (const GroupEvidence& group : arm.evidence.groups)
        if (group.name == name) return &group;
    return nullptr;
}

/// The component groups of the first arm that has any.
Rows rows_of(const Part& part) {
    Rows rows{{}, part.arms.size()};
    for (const ArmReport* arm : part.arms) {
        if (!rows.names.empty() || arm->evidence.trials == 0) continue;
        for (const GroupEvidence* group : shown_groups(arm->evidence)) rows.names.push_back(group->name);
    }
    return rows;
}

/// Calls visit(row, arm, group) for each component group that an arm has.
template <class Visit>
void each_group(const Part& part, const Rows& rows, const Visit& visit) {
    for (std::size_t row = 0; row < rows.names.size(); ++row)
        for (std::size_t arm = 0; arm < part.arms.size(); ++arm)
            if (const GroupEvidence* group = group_named(*part.arms[arm], rows.names[row]))
                if (!std::isnan(group->run.mean)) visit(row, arm, *group);
}

std::string interval_text(const Interval& interval) {
    return !std::isfinite(half_width(interval)) ? ""
                                    : ", 95 % " + short_number(interval.low) + " to " + short_number(interval.high);
}

/// Draws the region within the margin, and the labels of both sides.
void draw_margin(Svg& svg, const Scale& x, double margin, double bottom) {
    svg.box({x(1 - margin), top}, {x(1 + margin), bottom}, "margin",
            "within the margin: " + short_number(1 - margin) + " to " + short_number(1 + margin));
    svg.line({x(1), top}, {x(1), bottom}, "ideal");
    svg.text({left, 12}, Anchor::start, "◀ pessimistic");
    svg.text({x(1), top - 4}, Anchor::middle, "1 ± " + to_text(margin));
    svg.text({right, 12}, Anchor::end, "optimistic ▶");
}

}  // namespace

Html chart(const std::string& caption, const Html& svg) {
    return element("figure", element("figcaption", escaped(caption)) + "\n"_html + svg) + "\n"_html;
}

Html chart(const Part& part, const std::string& caption, const Svg& svg, const std::string& what,
           const std::string& title, const std::string& description) {
    return chart(caption, svg.html(part.id(what), part.scenario.name + ": " + title, description));
}

Html chart_group(const std::string& head, const std::string& text, const Html& drawings) {
    if (drawings.empty()) return {};
    return element("h4", escaped(head)) + "\n"_html + element("p", escaped(text)) + "\n<div class=\"charts\">\n"_html +
           drawings + "</div>\n"_html;
}

Html no_distributions(Keep keep) {
    if (keep == Keep::trials) return {};
    return element("p", escaped("No chart of how trials and pairs are spread: " + no_trials_note())) + "\n"_html;
}

Html legend(const Part& part) {
    Html items;
    for (std::size_t i = 0; i < part.arms.size(); ++i) {
        Svg key(36, 12);
        key.line({0, 6}, {36, 6}, "line " + series_class(i));
        key.mark({18, 6}, i, {});
        items += " <span>"_html + key.sign("key") + " "_html + escaped(part.arms[i]->arm) + "</span>"_html;
    }
    return element("p", items, "class=\"legend\""_html) + "\n"_html;
}

Html equivalence_chart(const Part& part) {
    const Rows rows = rows_of(part);
    const double margin = part.report.limits.margin;
    Range range;
    for (const double end : {1 - 1.6 * margin, 1 + 1.6 * margin}) range.include(end);
    each_group(part, rows, [&](std::size_t, std::size_t, const GroupEvidence& group) {
        range.include(group.run.mean);
        if (const Interval interval = over_steps95(group); interval.low > 0)
            range.include(interval.low), range.include(interval.high);
    });
    if (rows.names.empty()) return {};
    const Scale x = range.scale(left, right, 4);
    Svg svg(width, rows.bottom() + 36);
    draw_margin(svg, x, margin, rows.bottom());
    rows.draw(svg);
    Axes{x, {ScaleKind::linear, 0, 1, rows.bottom(), top}, "NEES/dim, mean over the steps, 95 % interval", "", 5, 0}
        .draw(svg);
    std::string described;
    each_group(part, rows, [&](std::size_t row, std::size_t arm, const GroupEvidence& group) {
        const Interval interval = over_steps95(group);
        const double y = rows.y(row, arm);
        const std::string says = part.arms[arm]->arm + ", " + group.name + ": NEES/dim " +
                                 short_number(group.run.mean) + interval_text(interval);
        svg.line({x(interval.low), y}, {x(interval.high), y}, "whisker " + series_class(arm), says);
        svg.mark({x(group.run.mean), y}, arm, says);
        described += says + ". ";
    });
    const std::string title = "NEES/dim by group against the margin";
    return chart(part, title, svg, "equivalence", title, described);
}

Html coverage_chart(const Part& part) {
    const Rows rows = rows_of(part);
    if (rows.names.empty()) return {};
    double least = 0.4;
    each_group(part, rows, [&](std::size_t, std::size_t, const GroupEvidence& group) {
        for (const Coverage& level : group.coverage) least = std::min(least, level.over_steps);
    });
    const Scale x{ScaleKind::normal, std::max(0.0, least - 0.05), 0.9997, left, right};
    Svg svg(width, rows.bottom() + 36);
    rows.draw(svg);
    for (const double level : coverage_levels) {
        svg.line({x(level), top}, {x(level), rows.bottom()}, "ideal");
        svg.text({x(level), rows.bottom() + 15}, Anchor::middle, to_text(100 * level));
    }
    svg.text({(left + right) / 2, rows.bottom() + 29}, Anchor::middle, "% of trials below that quantile of chi-square",
             "label name");
    svg.text({left, 12}, Anchor::start, "◀ covers too little");
    svg.text({right, 12}, Anchor::end, "too much ▶");
    std::string described;
    each_group(part, rows, [&](std::size_t row, std::size_t arm, const GroupEvidence& group) {
        described += part.arms[arm]->arm + ", " + group.name + ": ";
        for (const Coverage& level : group.coverage) {
            const std::string says =
                number(100 * level.over_steps, 2) + " % instead of " + to_text(100 * level.level) + " %";
            svg.mark({x(level.over_steps), rows.y(row, arm)}, arm,
                     part.arms[arm]->arm + ", " + group.name + ": covers " + says);
            described += says + (level.level < 0.99 ? ", " : ". ");
        }
    });
    return chart(part, "Coverage, mean over the steps", svg, "coverage", "coverage by group", described);
}

Html charts(const Part& part) {
    const std::string over_all =
        "The verdict: a group whose interval lies wholly in the shaded region is within the margin. "
        "Coverage: a filter that is right has its marks on the lines.";
    const std::string bands =
        "Shaded: the 95 % band of a consistent filter, for a step by itself (dark) and for all steps "
        "together (light).";
    const Html by_step =
        chart_group("Errors by step",
                    "Shaded: two sigma of P to either side, where 95 % of the errors of a filter that is right are. "
                    "The mark is the error that is largest in sigmas. Of many components the first are drawn.",
                    error_charts(part)) +
        chart_group("NEES/dim by step", bands, nees_panels(part)) +
        chart_group("NIS/m by step", bands, nis_panels(part)) +
        chart_group("How long steps depend on each other",
                    "The autocorrelation of the series in which it lasts longest. Its time is 1/2 and the sum of the "
                    "correlations from lag 1 up to the first lag (dashed) of at least five times that; a segment has "
                    "ten times as many steps.",
                    autocorrelation_chart(part));
    const bool few_runs = !part.arms.front()->curves.empty();
    Html differences;
    for (std::size_t i = 0; i < part.pairs.size(); ++i) differences += difference_charts(*part.pairs[i], i);
    const Html html =
        (few_runs ? by_step : Html()) +
        chart_group("Over all steps", over_all, equivalence_chart(part) + coverage_chart(part)) +
        chart_group("Directions",
                    "Combinations of the state, each component in units of its own sigma: where the "
                    "squared error is largest and smallest against what P says. A filter that is right has "
                    "its marks in the shaded region, and its errors on the circle.",
                    direction_charts(part)) +
        (few_runs ? Html() : by_step) +
        chart_group("Innovations a lag apart",
                    "A consistent filter's innovations are not correlated: dark, the 95 % band of a "
                    "lag by itself; light, of all lags together.",
                    whiteness_chart(part)) +
        chart_group("What trials end with",
                    "Bars: share of the trials. The filled mark is the mean, the bar over it the median; "
                    "a dashed line marks a published single run.",
                    distribution_charts(part)) +
        chart_group("Differences of pairs",
                    "Trial by trial, with the same draws. Left of 0 the first arm is lower. The mark is "
                    "the mean with its 95 % interval.",
                    differences) +
        no_distributions(part.report.keep);
    return html.empty() ? html
                        : element("h3", "Charts"_html, "id=\""_html + escaped(part.id("charts")) + "\""_html) +
                              "\n<p>Values show where the pointer rests on a mark.</p>\n"_html + legend(part) + html;
}

}  // namespace credence::page
