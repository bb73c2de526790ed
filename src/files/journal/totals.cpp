#include "files/journal/commit.hpp"

#include "totals/visit_totals.hpp"

#include <algorithm>

namespace credence {

namespace {

constexpr std::uint64_t most_counted = std::uint64_t{1} << 62;

void put(ByteWriter& to, const ExactSum& sum) {
    const std::vector<double> parts = sum.parts();
    to.put_count(parts.size());
    to.put_all(parts);
}

void get(ByteReader& from, ExactSum& sum) {
    constexpr std::uint64_t most_parts = 64;  // the 2098 bits of doubles give at most 40 parts that do not overlap
    const std::uint64_t count = from.get_count();
    if (count == 0 || count > most_parts) throw BadBytes("a sum has an impossible number of parts");
    sum = ExactSum::from_parts(from.get_all<double>(count));
}

void put(ByteWriter& to, const std::vector<ExactSum>& sums) {
    for (const ExactSum& sum : sums) put(to, sum);
}

void get(ByteReader& from, std::vector<ExactSum>& sums) {
    for (ExactSum& sum : sums) get(from, sum);
}

std::int64_t get_number(ByteReader& from) {
    const std::uint64_t value = from.get_count();
    if (value > most_counted) throw BadBytes("a count is too large");
    return static_cast<std::int64_t>(value);
}

/// Writes counts with long runs of 0, such as those of cells early in a run: each 0 is followed by the number of
/// further ones.
void put(ByteWriter& to, const std::vector<std::int64_t>& counts) {
    for (auto count = counts.begin(); count != counts.end();) {
        to.put_count(static_cast<std::uint64_t>(*count));
        if (*count++ != 0) continue;
        const auto end = std::find_if(count, counts.end(), [](std::int64_t other) { return other != 0; });
        to.put_count(static_cast<std::uint64_t>(end - count));
        count = end;
    }
}

void get(ByteReader& from, std::vector<std::int64_t>& counts) {
    for (auto count = counts.begin(); count != counts.end();) {
        *count++ = get_number(from);
        if (count[-1] != 0) continue;
        const std::uint64_t more = from.get_count();
        if (more > static_cast<std::uint64_t>(counts.end() - count)) throw BadBytes("has too many counts");
        std::fill_n(count, more, 0);
        count += static_cast<std::ptrdiff_t>(more);
    }
}

void put_moments(ByteWriter& to, const ExactMoments& moments) {
    to.put_count(static_cast<std::uint64_t>(moments.count));
    put(to, moments.sum);
    put(to, moments.square_sum);
}

void get_moments(ByteReader& from, ExactMoments& moments) {
    moments.count = get_number(from);
    get(from, moments.sum);
    get(from, moments.square_sum);
}

void put_trials(ByteWriter& to, const TrialTotals& all) {
    for (const std::int64_t trials : all.statuses) to.put_count(static_cast<std::uint64_t>(trials));
    for (const ExactMoments& column : all.columns) put_moments(to, column);
    for (const std::vector<DifferenceTotals>& columns : all.differences)
        for (const DifferenceTotals& totals : columns) {
            put_moments(to, totals.difference);
            to.put_count(static_cast<std::uint64_t>(totals.below));
            to.put_count(static_cast<std::uint64_t>(totals.above));
        }
}

void get_trials(ByteReader& from, TrialTotals& all) {
    for (std::int64_t& trials : all.statuses) trials = get_number(from);
    for (ExactMoments& column : all.columns) get_moments(from, column);
    for (std::vector<DifferenceTotals>& columns : all.differences)
        for (DifferenceTotals& totals : columns) {
            get_moments(from, totals.difference);
            totals.below = get_number(from);
            totals.above = get_number(from);
        }
    if (const char* problem = problem_of(all)) throw BadBytes(problem);
}

}  // namespace

void put_totals(ByteWriter& to, const ScenarioResults& results) {
    for (const ArmResults& arm : results.arms) put_trials(to, arm.totals.trials);
    for (const ArmResults& arm : results.arms) visit_totals([&](const auto& part) { put(to, part); }, arm.totals);
}

void get_totals(ByteReader& from, ScenarioResults& results, std::int64_t trials) {
    for (ArmResults& arm : results.arms) get_trials(from, arm.totals.trials);
    for (ArmResults& arm : results.arms) {
        if (arm.totals.trials.diverged() > 0) arm.totals.of_diverged();
        visit_totals([&](auto& part) { get(from, part); }, arm.totals);
    }
    if (from.left() != 0) throw BadBytes("has more than the totals");
    for (const ArmResults& arm : results.arms)
        if (arm.totals.trials.trials() != trials) throw BadBytes("totals of an impossible number of trials");
}

}  // namespace credence
