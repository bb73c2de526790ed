#include <credence/detail/totals.hpp>

#include "base/nan.hpp"
#include "totals/visit_totals.hpp"

#include <algorithm>
#include <numeric>

namespace credence {

namespace {

/// Of each trial its column, NaN if it failed.
std::vector<double> values_of(const double* column, const double* statuses, std::size_t trials) {
    std::vector<double> values(column, column + trials);
    for (std::size_t i = 0; i < trials; ++i)
        if (failed(static_cast<Status>(static_cast<int>(statuses[i])))) values[i] = nan;
    return values;
}

}  // namespace

void SeriesTotals::add(const SeriesTotals& other, int sign) {
    credence::add(sum, other.sum, sign);
    credence::add(square_sum, other.square_sum, sign);
    credence::add(run_square_sum, other.run_square_sum, sign);
    if (run_sum) credence::add(*run_sum, *other.run_sum, sign);
    credence::add(covered, other.covered, sign);
    credence::add(present, other.present, sign);
    credence::add(runs, other.runs, sign);
    credence::add(dimensions, other.dimensions, sign);
}

std::vector<SeriesTotals>& Totals::of_diverged() {
    const auto none = [](const auto& parts) { return std::remove_cvref_t<decltype(parts)>(parts.size()); };
    if (diverged.empty())
        for (const SeriesTotals& of : series)
            diverged.push_back({none(of.sum), none(of.square_sum), {},
                                of.run_sum ? std::optional(ExactSum()) : std::nullopt, none(of.covered),
                                none(of.present), 0, none(of.dimensions)});
    return diverged;
}

std::vector<SeriesTotals> Totals::of_finite() const {
    std::vector<SeriesTotals> all = series;
    for (std::size_t f = 0; f < diverged.size(); ++f) all[f].add(diverged[f]);
    return all;
}

void TrialTotals::add(const TrialTotals& other, int sign) {
    credence::add(statuses, other.statuses, sign);
    credence::add(columns, other.columns, sign);
    credence::add(differences, other.differences, sign);
}

std::int64_t TrialTotals::trials() const { return std::accumulate(statuses.begin(), statuses.end(), std::int64_t{0}); }

std::int64_t TrialTotals::counted() const { return finite() - (diverged_count ? 0 : diverged()); }

std::int64_t TrialTotals::diverged() const { return statuses[static_cast<std::size_t>(Status::diverged)]; }
std::int64_t TrialTotals::finite() const { return statuses[static_cast<std::size_t>(Status::completed)] + diverged(); }

bool is_reported(const Column& column) {
    return column.type != ColumnType::status && column.name != "status_pose" && column.places.anywhere;
}

const char* problem_of(const TrialTotals& all) {
    const std::int64_t with_columns = all.finite();
    const auto none_of = [](std::int64_t count, std::int64_t most) { return count < 0 || count > most; };
    for (const std::int64_t trials : all.statuses)
        if (trials < 0) return "a number of trials is below 0";
    for (const ExactMoments& column : all.columns)
        if (none_of(column.count, with_columns)) return "a column has more values than trials";
    for (const std::vector<DifferenceTotals>& columns : all.differences)
        for (std::size_t c = 0; c < columns.size(); ++c) {
            const DifferenceTotals& totals = columns[c];
            if (none_of(totals.difference.count, all.columns[c].count)) return "there are more pairs than values";
            if (none_of(totals.below, totals.difference.count) ||
                none_of(totals.above, totals.difference.count - totals.below))
                return "more pairs differ than there are";
        }
    return nullptr;
}

std::vector<TrialTotals> empty_trial_totals(const std::vector<Column>& columns, std::size_t arms) {
    std::vector<TrialTotals> totals;
    for (std::size_t arm = 0; arm < arms; ++arm)
        totals.push_back({std::vector<std::int64_t>(status_names().size()),
                              std::vector<ExactMoments>(columns.size()),
                              {arm, std::vector<DifferenceTotals>(columns.size())}});
    return totals;
}

std::vector<TrialTotals> trial_totals(const std::vector<Column>& columns, std::size_t arms, std::size_t trials,
                                      const std::function<const double*(std::size_t arm, std::size_t column)>& all) {
    const std::size_t status = status_column(columns);
    std::vector<TrialTotals> totals = empty_trial_totals(columns, arms);
    for (std::size_t a = 0; a < arms; ++a)
        for (std::size_t i = 0; i < trials; ++i) ++totals[a].statuses[static_cast<std::size_t>(all(a, status)[i])];
    for (std::size_t c = 0; c < columns.size(); ++c) {
        if (!is_reported(columns[c])) continue;
        std::vector<std::vector<double>> values;
        for (std::size_t a = 0; a < arms; ++a) values.push_back(values_of(all(a, c), all(a, status), trials));
        for (std::size_t a = 0; a < arms; ++a) {
            totals[a].columns[c] = exact_moments(values[a]);
            for (std::size_t b = 0; b < a; ++b) totals[a].differences[b][c] = differences_of(values[a], values[b]);
        }
    }
    return totals;
}

}  // namespace credence
