// Scales, their ticks, and the selection of points where there are many.

#include "report/html/charts/chart.hpp"

#include "report/format.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace credence {

namespace {

/// Position of a value on an axis, in the scale's own measure.
double measure(ScaleKind kind, double value) {
    if (kind == ScaleKind::logarithmic) return std::log10(value);
    if (kind == ScaleKind::normal) return std::isnan(value) ? value : normal_quantile(1 - value);
    return value;
}

/// The numbers are counted by an integer: beyond 2^53 a double stays the same when 1 is added.
std::vector<double> linear_ticks(double low, double high, int about) {
    const double rough = high / about - low / about, power = std::pow(10, std::floor(std::log10(rough)));
    double step = 10 * power;
    for (const double factor : {5.0, 2.0, 1.0})
        if (factor * power >= 0.999 * rough) step = factor * power;
    if (!(step > 0)) return {};  // it is below every double
    const double first = std::ceil(low / step - 1e-9), last = std::floor(high / step + 1e-9);
    std::vector<double> found;
    for (int i = 0; i <= about && first + i <= last; ++i) found.push_back((first + i) * step + 0.0);
    return found;
}

std::vector<double> logarithmic_ticks(double low, double high, int about) {
    const int first = static_cast<int>(std::floor(std::log10(low))),
              last = static_cast<int>(std::ceil(std::log10(high)));
    std::vector<double> found;
    const double decades = std::log10(high) - std::log10(low);  // the ratio may be beyond doubles
    const int apart = std::max(1, static_cast<int>(std::ceil(decades / about)));
    for (int decade = first; decade <= last; decade += apart)
        for (const double factor : {1.0, 2.0, 5.0}) {
            const double tick = factor * std::pow(10, decade);
            if (tick >= low * 0.999 && tick <= high * 1.001 && (factor == 1 || 3 * decades <= about + 1))
                found.push_back(tick);
        }
    return found;
}

/// Powers of ten from 10^5 on as 1e5.
std::string power_text(double tick) {
    const int power = static_cast<int>(std::floor(std::log10(tick) + 1e-9));
    if (power < 5 && power > -4) return short_number(tick);
    return number(tick / std::pow(10, power), 0) + "e" + std::to_string(power);
}

}  // namespace

Scale scale_between(ScaleKind kind, double low, double high, double from, double to) {
    constexpr double least = std::numeric_limits<double>::min(), most = std::numeric_limits<double>::max() / 4,
                     nearest = 1e-12;  // closer ends could not be told apart, neither by ticks nor by their texts
    if (kind == ScaleKind::logarithmic) {
        low = std::clamp(low, least, most / 2);
        return {kind, low, std::clamp(high, low * (1 + nearest), most), from, to};
    }
    low = std::clamp(low, -most, most);
    high = std::clamp(high, -most, most);
    const double lacking = std::max({1e-300, nearest * std::abs(low), nearest * std::abs(high)}) - (high - low);
    return lacking > 0 ? Scale{kind, low - lacking, high + lacking, from, to} : Scale{kind, low, high, from, to};
}

double Scale::operator()(double value) const {
    const double first = measure(kind, low), last = measure(kind, high);
    const double share = (measure(kind, std::clamp(value, low, high)) - first) / (last - first);
    return from + share * (to - from);
}

std::vector<double> ticks(const Scale& scale, int about) {
    const bool logarithmic = scale.kind == ScaleKind::logarithmic;
    if (about <= 0 || !(scale.low < scale.high) || std::isinf(scale.high) || (logarithmic && !(scale.low > 0)))
        return {};
    if (logarithmic && scale.high > 10 * scale.low) return logarithmic_ticks(scale.low, scale.high, about);
    return linear_ticks(scale.low, scale.high, about);
}

std::vector<std::string> tick_texts(const std::vector<double>& ticks) {
    int decimals = 0;
    for (const double tick : ticks) {
        int needed = 0;
        while (needed < 6 && std::abs(tick * std::pow(10, needed) - std::nearbyint(tick * std::pow(10, needed))) >
                                 1e-6 * std::pow(10, needed) * std::abs(tick))
            ++needed;
        decimals = std::max(decimals, needed);
    }
    std::vector<std::string> texts;
    const bool far_apart = ticks.size() > 1 && ticks.front() > 0 && ticks.back() > 99 * ticks.front();
    for (const double tick : ticks) texts.push_back(far_apart ? power_text(tick) : number(tick, decimals));
    return texts;
}

void Range::include(double value) {
    if (!std::isfinite(value)) return;
    low = known ? std::min(low, value) : value;
    high = known ? std::max(high, value) : value;
    known = true;
}

Scale Range::scale(double from, double to, double logarithmic_from) const {
    constexpr double margin = 0.04;
    if (known && low > 0 && high > logarithmic_from * low) {
        const double more = std::exp(margin * (std::log(high) - std::log(low)));
        return scale_between(ScaleKind::logarithmic, low / more, high * more, from, to);
    }
    const double spread = high > low ? high - low : std::max(1e-9, std::abs(low));
    return scale_between(ScaleKind::linear, low - margin * spread, high + margin * spread, from, to);
}

std::vector<std::size_t> thinned(std::size_t count, std::size_t most) {
    const std::size_t apart = count > most ? (count + most - 1) / most : 1;
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < count; i += apart) chosen.push_back(i);
    if (count > 0 && chosen.back() != count - 1) chosen.push_back(count - 1);
    return chosen;
}

std::vector<std::size_t> observed(const std::vector<double>& values) {
    std::vector<std::size_t> steps;
    for (std::size_t k = 0; k < values.size(); ++k)
        if (!std::isnan(values[k])) steps.push_back(k);
    return steps;
}

}  // namespace credence
