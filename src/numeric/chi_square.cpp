#include "numeric/chi_square.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <mutex>

namespace credence {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// e^-x for x >= 0, from products and sums alone: the Taylor series at x / 2^k, squared k times.
double decay(double x) {
    int halvings = 0;
    while (x > 0.125) {
        x /= 2;
        ++halvings;
    }
    double term = 1, sum = 1;
    for (int i = 1; i < 16; ++i) {
        term *= -x / i;
        sum += term;
    }
    for (; halvings > 0; --halvings) sum *= sum;
    return sum;
}

/// Density and distribution of chi-square(degrees) at x > 0 [Abramowitz and Stegun 6.5.29, 26.4]: with a = degrees/2,
/// y = x/2 the distribution is y^a e^-y / Gamma(a + 1) (1 + y/(a + 1) + y^2/((a + 1)(a + 2)) + ...), all terms
/// positive.
struct ChiSquare {
    double density = 0, distribution = 0;
};
ChiSquare chi_square_at(double x, int degrees) {
    const double y = x / 2, a = degrees / 2.0, pi = 3.14159265358979323846;
    // y^a / Gamma(a + 1), a factor at a time, with the exponential shared out so that nothing overflows.
    const double share = decay(y / (degrees + 1));
    double power = share;
    for (int i = degrees; i > 1; i -= 2) power *= y / (i / 2.0) * share * share;
    if (degrees % 2 != 0) power *= std::sqrt(y) / (std::sqrt(pi) / 2) * share;
    double term = 1, sum = 1;
    for (double i = a + 1; term > 1e-17 * sum; ++i) {
        term *= y / i;
        sum += term;
    }
    return {power * a / y / 2, power * sum};
}

/// The quantile above `low`, by Newton's method kept inside a bracket.
double quantile_above(double low, double p, int degrees) {
    double high = low > 0 ? low : degrees;
    while (chi_square_at(high, degrees).distribution < p) high *= 2;
    double x = low > 0 ? low : high / 2;
    for (int i = 0; i < 200; ++i) {
        const ChiSquare at = chi_square_at(x, degrees);
        (at.distribution < p ? low : high) = x;
        double next = x - (at.distribution - p) / at.density;
        if (!(next > low && next < high)) next = (low + high) / 2;
        if (std::abs(next - x) <= 1e-15 * x) return next;
        x = next;
    }
    return x;
}

}  // namespace

double stable_chi_square_quantile(double p, int degrees) { return quantile_above(0, p, degrees); }

EquiprobableCells::EquiprobableCells(int degrees) {
    double bound = 0;
    for (int i = 1; i < distribution_cells; ++i) {
        bound = quantile_above(bound, static_cast<double>(i) / distribution_cells, degrees);
        upper_.push_back(bound);
    }
    limit_ = bound;
    upper_.push_back(infinity);
    constexpr int slots = 1 << 14;
    scale_ = (slots - 1) / limit_;
    for (int slot = 0, cell = 0; slot < slots; ++slot) {
        // The slot is computed with rounding, so the search starts a little early.
        const double start = (slot - 0.001) / scale_;
        while (upper_[static_cast<std::size_t>(cell)] <= start) ++cell;
        first_.push_back(static_cast<std::uint16_t>(cell));
    }
}

std::shared_ptr<const EquiprobableCells> equiprobable_cells(int degrees) {
    static std::mutex mutex;
    // A run in another thread needs them while the process exits.
    static auto& kept = *new std::map<int, std::shared_ptr<const EquiprobableCells>>;
    const std::lock_guard lock(mutex);
    auto& cells = kept[degrees];
    if (!cells) cells = std::make_shared<const EquiprobableCells>(degrees);
    return cells;
}

}  // namespace credence
