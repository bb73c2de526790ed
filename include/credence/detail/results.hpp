#pragma once
// Module totals: the results of a study in memory: its totals, and what is kept of the trials. Columns and series are
// known by declaration only.

#include <credence/detail/block_ranges.hpp>
#include <credence/detail/scenario.hpp>
#include <credence/detail/totals.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// How the columns, which hold one number a trial, are kept.
enum class Keep {
    trials,      ///< all of them
    aggregates,  ///< none: the totals alone
};
/// `trials`, `aggregates`
std::string keep_name(Keep keep);

/// Columns of one arm that are kept in a file, because they may exceed the memory: the values of rows first ... first +
/// count - 1 of a column, which must exist. Throws InputError or Failure where the file cannot provide them.
using KeptColumns = std::function<std::vector<double>(std::size_t column, std::int64_t first, std::int64_t count)>;

/// The columns of one arm: one number a trial, in memory or in a file. Who reads them need not know where they are.
class ArmColumns {
public:
    /// Whether no trial is kept.
    bool empty() const { return !kept_ && in_memory_.empty(); }
    /// A column's values as stored, of `count` rows from `first` on; NaN or fill where a trial failed.
    std::vector<double> values(std::size_t column, std::int64_t first, std::int64_t count) const;

    /// From now on they are in a file.
    void keep(std::shared_ptr<const KeptColumns> kept);
    /// nullptr where they are in memory.
    const std::shared_ptr<const KeptColumns>& kept() const { return kept_; }
    /// [columns][trials], for those who fill them. Throws std::logic_error where they are in a file.
    std::vector<std::vector<double>>& in_memory();
    const std::vector<std::vector<double>>& in_memory() const { return const_cast<ArmColumns&>(*this).in_memory(); }

private:
    std::vector<std::vector<double>> in_memory_;
    std::shared_ptr<const KeptColumns> kept_;
};

struct ScenarioResults;

/// Totals and details of a scenario that are kept in a file, because those of all scenarios may exceed the memory:
/// fills `results`, which has no block and totals of 0, with the kept blocks and their totals and details. Throws
/// InputError or Failure where the file cannot provide them.
using KeptTotals = std::function<void(ScenarioResults& results)>;

/// One arm of a scenario: its totals, and what is kept of its trials: all of their columns, details of the first ones.
struct ArmResults {
    std::string name;
    ArmColumns columns;
    Totals totals;
    std::vector<double> errors;                ///< [detailed trials, K - 1, n], NaN where there is none
    std::vector<double> nees;                  ///< [detailed trials, K - 1] of the first nees series, NaN likewise
    /// [detailed trials, moment_count], NaN likewise; empty where none are kept.
    std::vector<double> moments;
};

struct ScenarioResults {
    Scenario scenario;                      ///< resolved
    std::vector<Column> columns;
    std::vector<Series> all_series;
    std::vector<ArmResults> arms;
    std::int64_t trials = 0;                   ///< number of trials; rows of the columns, where these are kept
    /// The blocks that are present: row r is trial blocks[r / 256] * 256 + r % 256. Only the last may be partial. They
    /// are 0, 1, 2 ... except for shards and interrupted runs. Empty for a record.
    BlockRanges blocks{};
    Keep keep = Keep::trials;
    /// The source of the arms' totals (but those of trials, which are always in memory) and details if has_totals() is
    /// false [load_totals]; nullptr: no trial has been computed.
    std::shared_ptr<const KeptTotals> kept_totals{};
    /// False of a record without a covariance of the whole state: then nothing shows that all of it is consistent.
    bool has_joint_covariance = true;
    /// Relative spacing of the numbers in which covariances were given: 2^-52, or 2^-23 of a record in singles.
    double epsilon = std::numeric_limits<double>::epsilon();
    /// Of a record: what cannot be judged by what it holds, in full sentences.
    std::vector<std::string> not_judged{};

    int steps() const { return scenario.poses - 1; }
    /// Number of trials whose errors are kept: the rows of the details.
    std::int64_t detailed() const;
    /// n
    int state_size() const { return all_series.front().dimension; }
    /// Numbers in a detailed trial's moments.
    int moment_count() const;
};

/// Gives results, which have none yet, the arms of their scenario, with totals of no trial [clear_totals].
void name_arms(ScenarioResults& results);
/// Sets the totals, but those of trials, to 0.
void clear_totals(ScenarioResults& results);

/// Totals and details of a study are held in memory up to this many bytes, or those of the scenarios that are being
/// computed.
inline constexpr std::int64_t most_totals_in_memory = std::int64_t{128} << 20;

/// Whether the totals and details are in memory.
bool has_totals(const ScenarioResults& results);

/// Bytes of memory that the totals take, and the details of `detailed` trials.
std::int64_t totals_size(const ScenarioResults& results, std::int64_t detailed);

/// Loads totals and details into memory. For blocks that were not present when these were kept, totals are 0 and
/// details unspecified.
void load_totals(ScenarioResults& results);

/// Frees the memory of totals and details. Their values are lost unless they are kept in a file.
void drop_totals(ScenarioResults& results);

/// Totals that are loaded into memory, `most` bytes at most.
class TotalsInMemory {
public:
    explicit TotalsInMemory(std::int64_t most) : left_(most) {}
    /// Drops totals that are kept, where they are too large.
    void limit(ScenarioResults& results);
    /// Loads totals, unless they are too large.
    void load(ScenarioResults& results);

private:
    bool take(const ScenarioResults& results);

    std::int64_t left_;
};

/// A scenario's results with totals: a reference to them, or a loaded copy that exists as long as this object.
class WithTotals {
public:
    explicit WithTotals(const ScenarioResults& results);
    const ScenarioResults& operator*() const { return loaded_ ? *loaded_ : results_; }

private:
    const ScenarioResults& results_;
    std::optional<ScenarioResults> loaded_;
};

/// Mean and spread of a column over the trials that did not fail; and of its differences from those of another arm of
/// the scenario, a - b.
Moments column_moments(const ArmResults& arm, std::size_t column);
DifferenceTotals column_differences(const ScenarioResults& results, const ArmResults& a, const ArmResults& b,
                                    std::size_t column);

/// A column's values as stored, of all rows.
std::vector<double> column_values(const ScenarioResults& results, const ArmResults& arm, std::size_t column);

/// The same, failed trials as NaN whatever their fill.
std::vector<double> figure_values(const ScenarioResults& results, const ArmResults& arm, std::size_t column);

/// The arms that a name denotes: the one of that name, or all of that controller.
std::vector<const ArmResults*> arms_meant(const ScenarioResults& results, const std::string& name);

/// The arm that this one of the scenario is compared with; nullptr where there is none.
const ArmResults* baseline_of(const ScenarioResults& results, const ArmResults& arm);

/// Trials in block `blocks[place]`.
std::int64_t block_rows(const ScenarioResults& results, std::size_t place);

/// Trials that these blocks of a study of `trials` trials have.
std::int64_t trials_in(const BlockRanges& blocks, std::int64_t trials);

/// Trials of the smallest study that has all blocks of the scenario.
std::int64_t trials_up_to(const ScenarioResults& results);

/// The trials of rows first ... first + count - 1.
std::vector<std::int64_t> trial_numbers(const ScenarioResults& results, std::int64_t first, std::int64_t count);

/// The row at which a block begins; nothing where the block is not present.
std::optional<std::int64_t> first_row(const ScenarioResults& results, std::int64_t block);

/// Sets `blocks`, of a study of `trials` trials: rows of blocks that were present and stay are moved, rows of others
/// are unspecified until they are stored. Totals do not change, nor values that are not in memory.
void set_blocks(ScenarioResults& results, BlockRanges blocks, std::int64_t trials);

/// Copies the details, if any, of a block that both have. Different blocks may be copied at once.
void copy_details(ScenarioResults& to, const ScenarioResults& from, std::int64_t block);

/// Adds the totals of other trials of the same arm.
void add_totals(ArmResults& to, const ArmResults& from);

}  // namespace credence
