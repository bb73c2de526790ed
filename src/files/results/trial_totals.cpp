#include "files/results/format.hpp"
#include "files/results/parts.hpp"

#include <algorithm>

namespace credence {

namespace {

using hdf5::Dataset;
using hdf5::Dimension;
using hdf5::Error;
using hdf5::Extents;
using hdf5::Handle;

std::vector<std::size_t> reported_columns(const ScenarioResults& results) {
    std::vector<std::size_t> columns;
    for (std::size_t c = 0; c < results.columns.size(); ++c)
        if (is_reported(results.columns[c])) columns.push_back(c);
    return columns;
}

/// One member of each of a list.
template <class T, class List, class Get>
std::vector<T> each(const List& list, const Get& get) {
    std::vector<T> values;
    for (const auto& item : list) values.push_back(get(item));
    return values;
}

Dimension new_column_dimension(const Handle& group, const ScenarioResults& results) {
    const std::vector<std::size_t> reported = reported_columns(results);
    const auto texts = [&](const std::string& separator, std::string Column::*member) {
        return joined(each<std::string>(reported, [&](std::size_t c) { return results.columns[c].*member; }),
                      separator);
    };
    Dimension column = numbered<std::int32_t>(group, "column", 0, reported.size(), "column of the trials");
    hdf5::write_text(column.scale, "column_names", texts(" ", &Column::name));
    hdf5::write_text(column.scale, "column_units", texts(", ", &Column::unit));
    return column;
}

void write_statuses(const Handle& group, const TrialTotals& totals) {
    Dimension code = numbered<std::int8_t>(group, "status_code", 0, totals.statuses.size(), "how a trial ended");
    write_status_flags(code.scale);
    hdf5::new_variable(group, "status_count", totals.statuses, {&code}, {"trials by how they ended", "1"});
    code.close();
}

/// Writes counts and exact totals of columns, along `along` and the parts.
template <class T, class Get>
void write_moments(const Handle& group, const std::string& name, hdf5::Dimensions along, const Dimension& part,
                   const std::string& what, const std::vector<T>& items, const Get& moments) {
    hdf5::new_variable(group, name + "_count", each<std::int64_t>(items, [&](auto& i) { return moments(i).count; }),
                       along, {"number of " + what, "1"});
    const auto sums = each<ExactSum>(items, [&](auto& i) { return moments(i).sum; }),
               squares = each<ExactSum>(items, [&](auto& i) { return moments(i).square_sum; });
    along.push_back(&part);
    hdf5::new_variable(group, name + "_total", parts_of(sums, part.size), along,
                       {"total of " + what, "see column_units"});
    hdf5::new_variable(group, name + "_square_total", parts_of(squares, part.size), along,
                       {"total of the squares of " + what, "squares of column_units"});
}

void write_differences(const Handle& group, const Dimension& column, const Dimension& part,
                       const ScenarioResults& results, const TrialTotals& totals) {
    std::vector<DifferenceTotals> pairs;
    std::vector<std::string> names;
    for (std::size_t b = 0; b < totals.differences.size(); ++b) {
        names.push_back(results.arms[b].name);
        for (const std::size_t c : reported_columns(results)) pairs.push_back(totals.differences[b][c]);
    }
    Dimension other = numbered<std::int32_t>(group, "subtracted_arm", 0, names.size(), "arm that is subtracted");
    hdf5::write_text(other.scale, "arm_names", joined(names, " "));
    const std::string what = "differences, this arm minus the other, over the trials that failed in neither";
    write_moments(group, "difference", {&other, &column}, part, what, pairs,
                  [](const DifferenceTotals& one) { return one.difference; });
    const auto write_trials = [&](const std::string& name, std::int64_t DifferenceTotals::* member,
                                  const std::string& long_name) {
        hdf5::new_variable(group, name, each<std::int64_t>(pairs, [&](auto& one) { return one.*member; }),
                           {&other, &column}, {long_name, "1"});
    };
    write_trials("difference_below", &DifferenceTotals::below, "trials in which this arm's column is lower");
    write_trials("difference_above", &DifferenceTotals::above, "trials in which this arm's column is higher");
    other.close();
}

/// Reads counts and exact totals as write_moments wrote them.
std::vector<ExactMoments> read_moments(const Handle& group, const std::string& name, Extents extents, hsize_t parts) {
    const auto counts = read_as<std::int64_t>(group, name + "_count", extents);
    extents.push_back(parts);
    const std::vector<ExactSum> sums = read_sums(group, name + "_total", extents),
                                squares = read_sums(group, name + "_square_total", extents);
    std::vector<ExactMoments> moments;
    for (std::size_t i = 0; i < counts.size(); ++i) moments.push_back({counts[i], sums[i], squares[i]});
    return moments;
}

void read_differences(const Handle& group, const ScenarioResults& results, hsize_t parts, TrialTotals& totals) {
    const std::vector<std::size_t> reported = reported_columns(results);
    const Extents extents{totals.differences.size(), reported.size()};
    check_numbered<std::int32_t>(group, "subtracted_arm", 0, extents[0]);
    const std::vector<ExactMoments> moments = read_moments(group, "difference", extents, parts);
    const auto below = read_as<std::int64_t>(group, "difference_below", extents),
               above = read_as<std::int64_t>(group, "difference_above", extents);
    for (std::size_t i = 0; i < moments.size(); ++i)
        totals.differences[i / reported.size()][reported[i % reported.size()]] = {moments[i], below[i], above[i]};
}

}  // namespace

std::vector<std::string> trial_totals_links(std::size_t place) {
    std::vector<std::string> names{"status_code",  "status_count", "column",
                                   "column_count", "column_total", "column_square_total"};
    if (place > 0)
        names.insert(names.end(), {"subtracted_arm", "difference_count", "difference_total", "difference_square_total",
                                   "difference_below", "difference_above"});
    return names;
}

std::size_t largest_part_count(const TrialTotals& totals) {
    std::size_t largest = 1;
    const auto note = [&](const ExactMoments& moments) {
        largest = std::max({largest, moments.sum.parts().size(), moments.square_sum.parts().size()});
    };
    std::for_each(totals.columns.begin(), totals.columns.end(), note);
    for (const std::vector<DifferenceTotals>& arm : totals.differences)
        for (const DifferenceTotals& totals : arm) note(totals.difference);
    return largest;
}

void write_block_ranges(const Handle& group, const BlockRanges& blocks) {
    const std::vector<BlockRange> ranges = blocks.ranges();
    Dimension first =
        hdf5::new_dimension(group, "first_block", each<std::int64_t>(ranges, [](auto& range) { return range.first; }),
                            {"first block of a range of those that are there", "1"});
    hdf5::new_variable(group, "last_block", each<std::int64_t>(ranges, [](auto& range) { return range.last; }),
                       {&first}, {"last block of that range", "1"});
    first.close();
}

BlockRanges read_block_ranges(const Handle& group, std::int64_t asked) {
    const Dataset dataset = open_list(group, "first_block");
    const auto first = dataset.read<std::int64_t>(),
               last = read_as<std::int64_t>(group, "last_block", dataset.extents());
    BlockRanges blocks;
    for (std::size_t i = 0; i < first.size(); ++i) {
        const std::int64_t least = i == 0 ? 0 : last[i - 1] + 2;  // adjacent ranges would be one range
        if (first[i] < least || last[i] < first[i] || last[i] >= block_count(asked))
            throw Error(dataset.place(), "and last_block are no ranges of the study's blocks, rising and apart");
        blocks.add(BlockRange{first[i], last[i]});
    }
    return blocks;
}

void write_trial_totals(const Handle& group, const Dimension& part, const ScenarioResults& results,
                      const ArmResults& arm) {
    write_statuses(group, arm.totals.trials);
    Dimension column = new_column_dimension(group, results);
    write_moments(group, "column", {&column}, part, "columns of the trials that did not fail, where they have them",
                  reported_columns(results), [&](std::size_t c) { return arm.totals.trials.columns[c]; });
    if (!arm.totals.trials.differences.empty()) write_differences(group, column, part, results, arm.totals.trials);
    column.close();
}

TrialTotals read_trial_totals(const Handle& group, const ScenarioResults& results, hsize_t parts) {
    const std::vector<std::size_t> reported = reported_columns(results);
    TrialTotals totals = empty_trial_totals(results.columns, results.arms.size() + 1).back();
    check_numbered<std::int8_t>(group, "status_code", 0, totals.statuses.size());
    totals.statuses = read_as<std::int64_t>(group, "status_count", {totals.statuses.size()});
    check_numbered<std::int32_t>(group, "column", 0, reported.size());
    const std::vector<ExactMoments> columns = read_moments(group, "column", {reported.size()}, parts);
    for (std::size_t i = 0; i < reported.size(); ++i) totals.columns[reported[i]] = columns[i];
    if (!totals.differences.empty()) read_differences(group, results, parts, totals);
    if (const char* problem = problem_of(totals)) throw Error(hdf5::place_of(group, "status_count"), problem);
    if (totals.trials() != results.trials)
        throw Error(hdf5::place_of(group, "status_count"),
                    "adds up to " + std::to_string(totals.trials()) + " trials, but the blocks have " +
                        std::to_string(results.trials));
    return totals;
}

}  // namespace credence
