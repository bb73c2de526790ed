#include <credence/detail/results.hpp>

#include "base/nan.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace credence {

namespace {

/// A column of an arm's block, NaN where a trial failed.
std::vector<double> values_of(const ArmBlock& arm, std::size_t column, std::size_t status, std::size_t trials) {
    const auto begin = arm.columns.begin() + static_cast<std::ptrdiff_t>(column * trials);
    std::vector<double> values(begin, begin + static_cast<std::ptrdiff_t>(trials));
    for (std::size_t i = 0; i < trials; ++i)
        if (failed(static_cast<Status>(static_cast<int>(arm.columns[status * trials + i])))) values[i] = nan;
    return values;
}

template <class T>
void add_each(std::vector<T>& to, const std::vector<T>& from) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i].add(from[i]);
}

template <class T>
void subtract_each(std::vector<T>& to, const std::vector<T>& from) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i].subtract(from[i]);
}

}  // namespace

void ArmAggregates::add(const ArmAggregates& other) {
    std::transform(statuses.begin(), statuses.end(), other.statuses.begin(), statuses.begin(), std::plus<>());
    add_each(columns, other.columns);
    for (std::size_t a = 0; a < differences.size(); ++a) add_each(differences[a], other.differences[a]);
}

void ArmAggregates::subtract(const ArmAggregates& other) {
    std::transform(statuses.begin(), statuses.end(), other.statuses.begin(), statuses.begin(), std::minus<>());
    subtract_each(columns, other.columns);
    for (std::size_t a = 0; a < differences.size(); ++a) subtract_each(differences[a], other.differences[a]);
}

std::int64_t ArmAggregates::trials() const {
    return std::accumulate(statuses.begin(), statuses.end(), std::int64_t{0});
}

std::int64_t ArmAggregates::counted() const {
    std::int64_t trials = 0;
    for (std::size_t status = 0; status < statuses.size(); ++status)
        if (!failed(static_cast<Status>(status))) trials += statuses[status];
    return trials;
}

const char* problem_of(const ArmAggregates& aggregates) {
    const std::int64_t counted = aggregates.counted();
    const auto none_of = [](std::int64_t count, std::int64_t most) { return count < 0 || count > most; };
    for (const std::int64_t trials : aggregates.statuses)
        if (trials < 0) return "a number of trials is below 0";
    for (const ExactMoments& column : aggregates.columns)
        if (none_of(column.count, counted)) return "a column has more values than trials";
    for (const std::vector<DifferenceTotals>& columns : aggregates.differences)
        for (std::size_t c = 0; c < columns.size(); ++c) {
            const DifferenceTotals& totals = columns[c];
            if (none_of(totals.difference.count, aggregates.columns[c].count))
                return "there are more pairs than values";
            if (none_of(totals.below, totals.difference.count) ||
                none_of(totals.above, totals.difference.count - totals.below))
                return "more pairs differ than there are";
        }
    return nullptr;
}

std::vector<ArmAggregates> empty_aggregates(const std::vector<Column>& columns, std::size_t arms) {
    std::vector<ArmAggregates> aggregates;
    for (std::size_t arm = 0; arm < arms; ++arm)
        aggregates.push_back({std::vector<std::int64_t>(status_names().size()),
                              std::vector<ExactMoments>(columns.size()),
                              {arm, std::vector<DifferenceTotals>(columns.size())}});
    return aggregates;
}

std::vector<ArmAggregates> aggregates_of(const std::vector<Column>& columns, const Block& block) {
    const auto trials = static_cast<std::size_t>(block.trials);
    const std::size_t status = status_column(columns);
    std::vector<ArmAggregates> aggregates = empty_aggregates(columns, block.arms.size());
    for (std::size_t a = 0; a < block.arms.size(); ++a)
        for (std::size_t i = 0; i < trials; ++i)
            ++aggregates[a].statuses[static_cast<std::size_t>(block.arms[a].columns[status * trials + i])];
    for (std::size_t c = 0; c < columns.size(); ++c) {
        if (!is_reported(columns[c])) continue;
        std::vector<std::vector<double>> values;
        for (const ArmBlock& arm : block.arms) values.push_back(values_of(arm, c, status, trials));
        for (std::size_t a = 0; a < values.size(); ++a) {
            aggregates[a].columns[c] = exact_moments(values[a]);
            for (std::size_t b = 0; b < a; ++b) aggregates[a].differences[b][c] = differences_of(values[a], values[b]);
        }
    }
    return aggregates;
}

}  // namespace credence
