// What the runs of a record add to its results by step.

#include "record/totals.hpp"

#include "numeric/chi_square.hpp"
#include "statistics/goodness.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

/// Totals take some 2.7 kB a step and group, as text as much again.
std::int64_t steps_between_kept(const RecordShape& shape) {
    constexpr std::int64_t most_steps = 99'999, most = 1'000'000, few_steps = 10'000, few = 100'000;
    const std::int64_t steps = shape.steps, groups = std::ssize(shape.groups);
    if (steps <= most_steps && groups * steps <= most) return 1;
    const std::int64_t kept = std::clamp<std::int64_t>(few / groups, 12, few_steps);
    return (steps + kept - 1) / kept;
}

}  // namespace

KeptSteps::KeptSteps(const RecordShape& shape)
    : every(static_cast<std::size_t>(steps_between_kept(shape))),
      count(static_cast<std::size_t>((shape.steps - 1) / static_cast<int>(every) + 1)) {}

/// Notes the dimension that the state has at this step, and scales its NEES to that of the whole state.
void RecordTotals::set_dimension(std::size_t k) {
    if (dimensions_.empty()) return;
    dimensions_[k] = static_cast<int>(std::ranges::count(checked_.here, 1));
    if (dimensions_[k] < shape_.n) series(0, k) *= static_cast<double>(shape_.n) / dimensions_[k];
}

/// What rounding may have done to each group's NEES at this step: the mean of many covariances may hide it.
void RecordTotals::add_rounding(std::size_t k) {
    const std::vector<double>& bounds = judge_.rounding();
    double* sums = &roundings_[kept_.place(k) * (1 + bounds.size())];
    ++sums[0];
    for (std::size_t b = 0; b < bounds.size(); ++b) sums[1 + b] += bounds[b];
}

void RecordTotals::finish_rounding() {
    const std::size_t groups = shape_.groups.size();
    arm().totals.rounding.assign(groups, 0);
    for (std::size_t k = 0; k < kept_.count; ++k) {
        const double* sums = &roundings_[k * (1 + groups)];
        for (std::size_t b = 0; sums[0] > 0 && b < groups; ++b)
            arm().totals.rounding[b] = std::max(arm().totals.rounding[b], sums[1 + b] / sums[0]);
    }
}

/// The NEES of the state as it is at this step.
double RecordTotals::nees_at(std::size_t k) {
    const bool partial = !dimensions_.empty() && dimensions_[k] < shape_.n;
    return partial ? series(0, k) * dimensions_[k] / shape_.n : series(0, k);
}

void RecordTotals::add_totals() {
    add_all_series(arm().totals.series);
    add_distribution();
    keep_largest_nis();
    for (std::size_t lag = 0; lag < products_.sum.size(); ++lag) {
        arm().totals.products.sum[lag].add(products_.sum[lag]);
        arm().totals.products.square_sum[lag].add(products_.sum[lag] * products_.sum[lag]);
        arm().totals.products.count[lag] += static_cast<std::int64_t>(products_.count[lag]);
    }
}

void RecordTotals::add_all_series(std::vector<SeriesTotals>& to) {
    for (std::size_t f = 0; f < to.size(); ++f) add_series(f, to[f]);
}

void RecordTotals::add_series(std::size_t f, SeriesTotals& totals) {
    const Series& declared = all_series_.list[f];
    const bool of_innovations = declared.role == SeriesRole::nis || declared.role == SeriesRole::rows;
    double run = 0, count = 0;
    for (const std::size_t k : present_) {
        const double value = series(f, k);
        if (std::isnan(value) || (of_innovations && !kept_.has(k))) continue;
        run += value;
        ++count;
        if (!kept_.has(k)) continue;
        const std::size_t kept = kept_.place(k);
        totals.sum[kept].add(value);
        if (!declared.integer) totals.square_sum[kept].add(value * value);
        if (f < shape_.groups.size()) add_coverage(f, k, f == 0 ? nees_at(k) : value, totals);
        if (!totals.present.empty()) ++totals.present[kept];
        if (f == 0 && !dimensions_.empty()) totals.dimensions[kept] += dimensions_[k];
    }
    if (count == 0) return;
    if (!of_innovations) run *= static_cast<double>(kept_.count) / count;
    totals.run_sum->add(run);
    totals.run_square_sum.add(run * run);
    ++totals.runs;
}

void RecordTotals::add_coverage(std::size_t f, std::size_t k, double value, SeriesTotals& totals) {
    const double* bound = bounds(f, k);
    for (std::size_t l = 0; l < coverage_level_count; ++l)
        totals.covered[kept_.place(k) * coverage_level_count + l] += value < bound[l];
}

/// The bounds [levels] of a group's NEES at a step.
const double* RecordTotals::bounds(std::size_t f, std::size_t k) {
    if (f != 0 || dimensions_.empty() || dimensions_[k] == shape_.n) return &bounds_[f * coverage_level_count];
    double* all = &bounds_by_dimension_[size(dimensions_[k]) * coverage_level_count];
    for (std::size_t l = 0; all[0] == 0 && l < coverage_level_count; ++l)
        all[coverage_level_count - 1 - l] =
            stable_chi_square_quantile(coverage_levels[coverage_level_count - 1 - l], dimensions_[k]);
    return all;
}

/// The values of `nees_` are their probabilities, so that those of states of any dimension are together.
void RecordTotals::add_distribution() {
    for (const std::size_t k : present_) {
        if (!kept_.has(k)) continue;
        const std::size_t kept = kept_.place(k);
        ++arm().totals.present[kept];
        const double nees = nees_at(k);
        if (std::isnan(nees)) continue;
        const int dimension = dimensions_.empty() ? shape_.n : dimensions_[k];
        if (keeps_cells_)
            ++arm().totals.cells[kept * distribution_cells + size(equiprobable_cells(dimension)->cell(nees))];
        if (keeps_nees_) nees_[kept].push_back(1 - chi_square_p(nees, dimension));
    }
}

void RecordTotals::keep_largest_nis() {
    constexpr std::size_t most = 10;
    for (LargestNis& nis : record_.largest_nis) {
        const std::size_t f = all_series_.nis + 2 * static_cast<std::size_t>(&nis - record_.largest_nis.data());
        for (const std::size_t k : present_) {
            const double value = series(f, k);
            const int rows = static_cast<int>(series(f + 1, k));
            if (rows == 0) continue;
            nis.rows = nis.rows == 0 || nis.rows == rows ? rows : -1;
            ++nis.count;
            nis.sum += value;
            if (nis.largest.size() == most && value <= nis.largest.front()) continue;
            nis.largest.insert(std::ranges::upper_bound(nis.largest, value), value);
            if (nis.largest.size() > most) nis.largest.erase(nis.largest.begin());
        }
    }
}

}  // namespace credence
