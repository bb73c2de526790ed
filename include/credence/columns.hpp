#pragma once
// Module scenario: the declaration of what a trial reports: columns, series, components and their groups. Engine,
// statistics, store and report process these lists and contain nothing else that is specific to a world.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace credence {

/// How a trial ended. Only the last two have no columns; the verdict is on those of the first one.
enum class Status : std::int8_t {
    completed = 0,
    diverged = 1,  ///< its NEES/n is beyond `diverged_nees_ratio`
    covariance_not_positive_definite = 2,
    non_finite = 3,
};
/// Beyond this a number of a trial counts as not finite: its squares' squares must still add up.
inline constexpr double largest_number = 1e70;
/// A trial diverged if NEES/n of the whole state, mean over its steps, is beyond this: errors of five sigma throughout.
inline constexpr double diverged_nees_ratio = 25;
/// So many numbers, steps times components, a trial has at least that may be diverged: in fewer, a large error or two
/// are chance.
inline constexpr int least_diverged_numbers = 20;

const std::vector<std::string>& status_names();

inline bool failed(Status status) { return status >= Status::covariance_not_positive_definite; }
/// Whether the trial is in the totals by step.
inline bool counts(Status status) { return status == Status::completed; }

enum class ColumnType { real, integer, status };

/// Where a column is shown that has not room for all; a scenario's report, JSON and CSV have them all.
struct ColumnPlaces {
    bool watch = true;                     ///< `credence watch`
    bool sweep = true, sweep_pairs = true; ///< the tables by point of a sweep: of an arm, of a pair
    bool anywhere = true;                  ///< false of what a budget alone reads: nothing is said of it
};

/// One number per trial.
struct Column {
    std::string name, long_name, unit;
    ColumnType type = ColumnType::real;
    double fill = 0;                       ///< value of a failed trial: NaN for real columns
    ColumnPlaces places{};
};

/// A value published elsewhere for a column of one arm, shown with its place in the distribution over the trials.
struct PublishedNumber {
    std::string arm;                     ///< such as greedy.kf
    double value = 0;
    friend bool operator==(const PublishedNumber&, const PublishedNumber&) = default;
};

/// The statistical meaning of a series.
enum class SeriesRole {
    nees,                ///< normalised squared error of one component group, chi-square(dimension)
    standardised_error,  ///< e_j / sqrt(P_jj), mean 0 and variance 1
    nis,                 ///< normalised innovation squared, chi-square with as many degrees as it has rows
    rows,                ///< number of measurement rows
    squared_error,       ///< |e|^2 of one component group
    variance,            ///< trace of that group's part of P: the filter's own value for the mean of |e|^2
    nees_in_chart,       ///< NEES of a group with its error in another chart: shown beside `nees`, without a verdict
    other,
};

/// One number per trial and step k = 1 ... K - 1, of which the file keeps totals over trials.
struct Series {
    std::string name, long_name, unit;
    SeriesRole role = SeriesRole::other;
    int dimension = 0;                     ///< of a component group
    bool integer = false;
    std::string part;                      ///< the component group, the component, or the group of rows
    std::string rows;                      ///< of a nis: the series that counts its rows; empty where there is none
    int more_rows = 0;                     ///< of a nis: rows beside those
};

/// Levels at which the coverage of a NEES is counted: the share of trials below that quantile of chi-square.
inline constexpr double coverage_levels[] = {0.5, 0.9, 0.95, 0.99};
inline constexpr int coverage_level_count = 4;

/// Numbers that a detailed trial keeps of its steps k, for the directions, the bias and the advice of the verdict
/// [docs/statistics.md]: mean NEES of each group, [groups]; mean of e_j/sigma_j, [n]; sums of e_i e_j/(sigma_i sigma_j)
/// and of P_ij/(sigma_i sigma_j), each the lower triangle row by row, [n (n + 1)/2]; sigma_j^2 = P_jj. 0 for states of
/// more than `largest_moment_state`, whose trials keep none.
inline constexpr int largest_moment_state = 64;
inline int moment_count(int state_size, int groups) {
    return state_size > largest_moment_state ? 0 : groups + state_size + state_size * (state_size + 1);
}

/// Number of first trials of which more is kept: their errors and moments, and the correlation of their innovations in
/// time. Whole blocks; 4096 trials, or as many as give 2^24 errors an arm.
int detailed_trials(int steps, int state_size);

/// Lags at which innovations are correlated, 1 ... lag_count.
inline int lag_count(int poses) { return poses - 2 < 10 ? (poses > 2 ? poses - 2 : 0) : 10; }

/// A group of components of the state that is evaluated by itself: `count` of them from `first` on, or those of a list.
struct ComponentGroup {
    std::string name;
    int first = 0, count = 0;
    std::vector<int> components{};         ///< [count] where they are not contiguous and in order; else empty

    bool contiguous() const { return components.empty(); }
    /// The i-th component of the group, by its index in the state.
    int component(int i) const { return contiguous() ? first + i : components[static_cast<std::size_t>(i)]; }
};

/// A component of the state.
struct Component {
    std::string name, unit;
    friend bool operator==(const Component&, const Component&) = default;
};

/// The column of every world that has the log score: the mean over the steps of the negative log-likelihood of the
/// truth under the belief, (n log 2 pi + log det P + NEES)/2, in nats.
Column log_score_column();

/// Position of the column that says how a trial ended. Every world declares one, and after it the pose at which that
/// happened.
std::size_t status_column(const std::vector<Column>& columns);

/// The names and units of the last two columns of every world.
std::vector<Column> status_columns();

/// Steps of which the signed errors are columns: none, the last, or up to most_kept_steps from the first to the last.
enum class KeptErrors { none, last, mean };
const std::vector<std::string>& kept_errors_names();
inline constexpr int most_kept_steps = 10;

/// How a scenario takes part in a budget [docs/budget.md].
struct BudgetSettings {
    std::uint32_t other = 0;  ///< the sources of an independent world [draws.hpp, source_bit]
    KeptErrors errors = KeptErrors::none;

    /// Variances are kept of the trials whose draws are the study's own.
    bool keeps_variances() const { return errors != KeptErrors::none && other == 0; }
};

/// The steps from 0 on whose errors are kept, of `steps`.
std::vector<int> kept_steps(KeptErrors kept, int steps);

/// Columns, with those of the kept errors before the last two: of each kept step in turn one for each component, called
/// by it and, unless the last step alone is kept, by the step; then the variances likewise.
std::vector<Column> with_errors(std::vector<Column> columns, const std::vector<Component>& components, int steps,
                                const BudgetSettings& budget);

/// Replaces the columns of a failed trial by their fill values, status and its pose excepted; leaves others as they
/// are. `values` [columns]. Returns whether the trial failed.
bool fill_failed(const std::vector<Column>& columns, double* values);

}  // namespace credence
