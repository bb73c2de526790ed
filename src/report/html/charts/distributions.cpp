// The page's histograms: columns of trials, and differences of pairs.

#include "report/html/charts/chart.hpp"
#include <credence/text.hpp>

#include "report/format.hpp"
#include "report/html/page.hpp"
#include "report/words.hpp"

#include <algorithm>
#include <cmath>

namespace credence::page {

namespace {

constexpr double width = 360, left = 14, right = width - 14, top = 20, row = 74, bar = 46;

/// A value and its name, at a histogram.
struct Sample {
    std::string arm;
    std::size_t number;
    const ColumnReport* column;
};

double share_of(const Histogram& histogram, std::size_t bin) {
    return static_cast<double>(histogram.counts[bin]) / static_cast<double>(histogram.total());
}

double largest_share(const Histogram& histogram) {
    double largest = 0;
    for (std::size_t bin = 0; bin < histogram.counts.size(); ++bin)
        largest = std::max(largest, share_of(histogram, bin));
    return largest;
}

std::string percent_text(double share) { return number(100 * share, share < 0.1 ? 2 : 1) + " %"; }

/// The range of a bin as text; one whole number is shown by itself.
std::string bin_text(double low, double high) {
    if (high - low == 1 && low + 0.5 == std::nearbyint(low + 0.5)) return short_number(low + 0.5);
    return short_number(low) + " to " + short_number(high);
}

/// Bars that start at `foot`.
void draw_bars(Svg& svg, const Scale& x, const Histogram& histogram, double foot, const std::string& classes,
               const std::string& name) {
    const double largest = largest_share(histogram);
    for (std::size_t bin = 0; bin < histogram.counts.size(); ++bin) {
        if (histogram.counts[bin] == 0) continue;
        const double low = histogram.edges[bin], high = histogram.edges[bin + 1], share = share_of(histogram, bin);
        svg.box({x(low), foot}, {x(high), foot - bar * share / largest}, classes,
                name + ": " + bin_text(low, high) + ", " + percent_text(share) + " of trials");
    }
    svg.line({x.from, foot}, {x.to, foot}, "axis");
}

/// The whole range; wider where it is only a bin or two, such as for values that do not vary.
Scale scale_over(Range edges, bool ratio, std::size_t bins) {
    if (bins < 5) {
        const double spread = edges.high - edges.low;
        edges.include(ratio ? edges.low / 2 : edges.low - 4 * spread);
        edges.include(ratio ? edges.high * 2 : edges.high + 4 * spread);
    }
    return scale_between(ratio ? ScaleKind::logarithmic : ScaleKind::linear, edges.low, edges.high, left, right);
}

void draw_published(Svg& svg, const Scale& x, const ColumnReport& column, double foot) {
    if (!column.published) return;
    const std::string says = "published " + to_text(column.published->value) + " (" +
                             number(column.published->percentile, 1) + " % of the trials are lower)";
    const double at = x(column.published->value);
    svg.line({at, foot}, {at, foot - bar - 2}, "published", says);
    const bool right_half = at > (x.from + x.to) / 2;
    svg.text({at + (right_half ? -4 : 4), foot - bar + 7}, right_half ? Anchor::end : Anchor::start,
             "published " + to_text(column.published->value) + " (" + number(column.published->percentile, 1) + " %)",
             "label halo");
}

std::string draw_sample(Svg& svg, const Scale& x, const Sample& sample, double foot) {
    const ColumnReport& column = *sample.column;
    const Summary& s = column.summary;
    svg.text({left, foot - bar - 5}, Anchor::start, sample.arm, "label row");
    draw_bars(svg, x, *column.histogram, foot, "bar " + series_class(sample.number), sample.arm);
    svg.text({x.to, foot - bar - 5}, Anchor::end, "highest bar " + percent_text(largest_share(*column.histogram)));
    draw_published(svg, x, column, foot);
    svg.line({x(s.median), foot + 1}, {x(s.median), foot - 9}, "median",
             sample.arm + ": median " + short_number(s.median));
    svg.mark({x(s.mean), foot + 5}, sample.number,
             sample.arm + ": mean " + short_number(s.mean) + ", 95 % " + short_number(s.ci95.low) + " to " +
                 short_number(s.ci95.high));
    const std::int64_t beyond = column.histogram->below + column.histogram->above;
    return sample.arm + ": mean " + short_number(s.mean) + ", median " + short_number(s.median) +
           (column.published ? ", published " + to_text(column.published->value) + " at " +
                                   number(column.published->percentile, 1) + " %"
                             : "") +
           (beyond > 0 ? ", " + std::to_string(beyond) + " trials beyond the axis" : "") + ". ";
}

Html distribution(const Part& part, const std::string& name, const std::vector<Sample>& samples) {
    Range edges;
    std::size_t bins = 0;
    for (const Sample& sample : samples) {
        bins = std::max(bins, sample.column->histogram->counts.size());
        edges.include(sample.column->histogram->edges.front());
        edges.include(sample.column->histogram->edges.back());
    }
    const bool ratio = std::ranges::all_of(
        samples, [](const Sample& sample) { return sample.column->histogram->widths == BinWidths::ratio; });
    for (const Sample& sample : samples)  // a logarithmic axis has no place for what is not positive: it is at the end
        if (const auto& published = sample.column->published; published && (!ratio || published->value > 0))
            edges.include(published->value);
    const std::string title = column_words(name, samples.front().column->unit);
    const Scale x = scale_over(edges, ratio, bins);
    const double foot = top + row * static_cast<double>(samples.size()) - 14;
    Svg svg(width, foot + 48);
    std::string described;
    for (std::size_t i = 0; i < samples.size(); ++i)
        described += draw_sample(svg, x, samples[i], top + row * static_cast<double>(i + 1) - 18);
    Axes{x, {ScaleKind::linear, 0, 1, foot + 10, top}, title, "", 6, 0}.draw(svg);
    return chart(part, title, svg, name, "distribution of " + title, described);
}

Html difference(const Comparison& pair, const ComparedColumn& column, const std::string& id) {
    const PairedComparison& paired = column.paired;
    const Summary& s = paired.difference;
    Range edges;
    for (const double value : {paired.histogram.edges.front(), paired.histogram.edges.back(), 0.0})
        edges.include(value);
    const Scale x = scale_over(edges, false, paired.histogram.counts.size());
    constexpr double foot = top + row - 18;
    Svg svg(width, foot + 58);
    const std::string shares = percent(paired.wins_a) + " below, " + percent(paired.wins_b) + " above" +
                               (paired.ties > 0 ? ", " + percent(paired.ties) + " equal" : "");
    svg.text({left, foot - bar - 5}, Anchor::start, shares, "label row");
    draw_bars(svg, x, paired.histogram, foot, "bar pair", pair.name());
    svg.line({x(0), foot + 12}, {x(0), foot - bar - 2}, "ideal", "0: no difference");
    const std::string says =
        "mean " + short_number(s.mean) + ", 95 % " + short_number(s.ci95.low) + " to " + short_number(s.ci95.high);
    svg.line({x(s.ci95.low), foot + 7}, {x(s.ci95.high), foot + 7}, "whisker", says);
    svg.mark({x(s.mean), foot + 7}, 1, pair.name() + ": " + says, "pair");
    const std::string title = column_words(column.name, column.unit);
    const std::string axis = "difference" + (column.unit == "1" ? "" : " [" + with_powers(column.unit) + "]");
    Axes{x, {ScaleKind::linear, 0, 1, foot + 16, top}, axis, "", 6, 0}.draw(svg);
    return chart(title, svg.html(id, pair.scenario + ": " + pair.name() + " of " + title, says + "; " + shares + ". "));
}

}  // namespace

Html distribution_charts(const Part& part) {
    Html html;
    if (part.arms.empty()) return html;
    for (const ColumnReport& first : part.arms.front()->columns) {
        std::vector<Sample> samples;
        for (std::size_t i = 0; i < part.arms.size(); ++i)
            if (const ColumnReport& column = column_named(part.arms[i]->columns, first.name);
                column.histogram && !column.histogram->counts.empty())
                samples.push_back({part.arms[i]->arm, i, &column});
        if (!samples.empty()) html += distribution(part, first.name, samples);
    }
    return html;
}

Html difference_charts(const Comparison& pair, std::size_t number) {
    Html html;
    for (const ComparedColumn& column : pair.columns)
        if (!column.paired.histogram.counts.empty())
            html += difference(pair, column, pair.scenario + ".pair" + std::to_string(number) + "-" + column.name);
    return html;
}

}  // namespace credence::page
