#pragma once
// Module study: the results of a study in memory: what blocks add up to. It knows columns and series by declaration only.

#include <credence/detail/aggregates.hpp>
#include <credence/detail/block.hpp>
#include <credence/detail/block_ranges.hpp>
#include <credence/detail/exact_sum.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// What is kept of the columns, which hold one number a trial.
enum class Keep {
    trials,      ///< all of them
    aggregates,  ///< totals over the trials [aggregates.hpp]
};
/// `trials`, `aggregates`
std::string keep_name(Keep keep);

/// Totals over trials of one declared series.
struct SeriesTotals {
    std::vector<ExactSum> sum;         ///< [K - 1] over the trials that did not fail
    std::vector<ExactSum> square_sum;  ///< [K - 1]; empty for integer series
    ExactSum run_square_sum;           ///< of (sum over the steps of one trial), squared
    std::optional<ExactSum> run_sum;   ///< of the sum over the steps of one trial; none: the sum of `sum`
    std::vector<std::int64_t> covered; ///< [K - 1, levels] of a nees: trials below the quantile of chi-square; else empty
};

/// Totals over the detailed trials of products of whitened innovations, by lag from 1 up.
struct ProductTotals {
    std::vector<ExactSum> sum;
    std::vector<ExactSum> square_sum;  ///< of each trial's sum, squared
    std::vector<std::int64_t> count;   ///< products
};

/// Columns of one arm that are kept in a file, because they may exceed the memory.
class KeptColumns {
public:
    virtual ~KeptColumns() = default;
    /// The values of rows first ... first + count - 1, which must be there. Throws InputError or Failure where the file
    /// does not give them.
    virtual std::vector<double> values(std::size_t column, std::int64_t first, std::int64_t count) const = 0;
};

struct ScenarioResults;

/// Totals and details of a scenario that are kept in a file, because those of all scenarios may exceed the memory.
class KeptTotals {
public:
    virtual ~KeptTotals() = default;
    /// Gives `results`, which has no block and totals of 0, the blocks that are kept and their totals and details. Throws
    /// InputError or Failure where the file does not give them.
    virtual void load(ScenarioResults& results) const = 0;
};

/// One arm of a scenario: per-trial columns and per-step totals.
struct ArmResults {
    std::string name;
    /// [columns][trials]; NaN or fill where a trial failed. Empty where `kept` has them (read column_values), and where no
    /// trial is kept.
    std::vector<std::vector<double>> columns;
    std::shared_ptr<const KeptColumns> kept;
    ArmAggregates aggregates;                  ///< where no trial is kept; else empty
    std::vector<SeriesTotals> totals;          ///< [series_count]
    std::int64_t counted = 0;                  ///< trials in the totals: those that did not fail
    std::vector<std::int64_t> cells;           ///< [K - 1, distribution_cells] trials by cell of the first nees series
    ProductTotals products;
    std::vector<double> errors;                ///< [detailed trials, K - 1, n], NaN where there is none
    std::vector<double> nees;                  ///< [detailed trials, K - 1] of the first nees series, NaN likewise

    // Of a record only: runs may differ in length there, and its values are at hand.
    std::vector<std::int64_t> present;         ///< [K - 1] trials that have the step; empty: all that are counted
    std::vector<double> distribution_distance;        ///< [K - 1] exact distance of the NEES from chi-square; empty: by cells

    std::int64_t counted_at(std::size_t step) const { return present.empty() ? counted : present[step]; }
};

struct ScenarioResults {
    Scenario scenario;                      ///< resolved
    std::vector<Column> columns;
    std::vector<Series> all_series;
    std::vector<ArmResults> arms;
    std::int64_t trials = 0;                   ///< that are there: rows of the columns, where they are kept
    /// The blocks that are there: row r is trial blocks[r / 256] * 256 + r % 256. Only the last may be partial.
    /// 0, 1, 2 ... but for shards and interrupted runs. Empty for a record.
    BlockRanges blocks{};
    Keep keep = Keep::trials;
    /// What gives the arms their totals (but `aggregates`, which are always in memory) and details where has_totals() says
    /// that they are not in memory [load_totals]; nullptr: no trial has been computed.
    std::shared_ptr<const KeptTotals> kept_totals{};

    int steps() const { return scenario.poses - 1; }
    /// Trials that are there whose errors are kept: the rows of the details.
    std::int64_t detailed() const;
    /// n
    int state_size() const { return all_series.front().dimension; }
};

/// An empty result of a resolved scenario. Throws InputError where there is no such world.
ScenarioResults empty_results(const Scenario& scenario, Keep keep = Keep::trials);

/// The same, its totals not in memory.
ScenarioResults results_without_totals(const Scenario& scenario, Keep keep = Keep::trials);

/// Totals and details of a study are held in memory up to so many bytes, or those of the scenarios that are computed.
inline constexpr std::int64_t most_totals_in_memory = std::int64_t{128} << 20;

/// Whether the totals and details are in memory.
bool has_totals(const ScenarioResults& results);

/// Bytes of memory that the totals take, and the details of `detailed` trials.
std::int64_t totals_size(const ScenarioResults& results, std::int64_t detailed);

/// Brings totals and details into memory, those of blocks that were not there when they were kept as 0 and anything.
void load_totals(ScenarioResults& results);

/// Frees the memory of totals and details. What they were is lost where nothing has kept them.
void drop_totals(ScenarioResults& results);

/// Totals that are in memory, `most` bytes at most.
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

/// A scenario's results with totals: themselves, or a copy for as long as this lives.
class WithTotals {
public:
    explicit WithTotals(const ScenarioResults& results);
    const ScenarioResults& operator*() const { return loaded_ ? *loaded_ : results_; }

private:
    const ScenarioResults& results_;
    std::optional<ScenarioResults> loaded_;
};

/// Whether a column is a series of the trial, not its status.
bool is_reported(const Column& column);

/// Trials by how they ended.
std::vector<std::int64_t> status_counts(const ScenarioResults& results, const ArmResults& arm);

/// What all rows of a column, failed trials left out, have in common where no trial is kept; and their differences from
/// those of another arm of the scenario, a - b.
Moments aggregate_moments(const ArmResults& arm, std::size_t column);
DifferenceTotals aggregate_differences(const ScenarioResults& results, const ArmResults& a, const ArmResults& b,
                                       std::size_t column);

/// A column's values as stored, of all rows or of `count` rows from `first` on; read where they are kept in a file.
std::vector<double> column_values(const ScenarioResults& results, const ArmResults& arm, std::size_t column);
std::vector<double> column_values(const ArmResults& arm, std::size_t column, std::int64_t first, std::int64_t count);

/// The same, failed trials as NaN whatever their fill.
std::vector<double> figure_values(const ScenarioResults& results, const ArmResults& arm, std::size_t column);

/// The arms that a name means: the one that has it, or all of that controller.
std::vector<const ArmResults*> arms_meant(const ScenarioResults& results, const std::string& name);

/// The arm that a planned one is compared with: `fixed.X` beside `greedy.X`; beside `horizon.X` the greedy one, or the fixed
/// one. nullptr where there is none.
const ArmResults* partner_of(const ScenarioResults& results, const ArmResults& arm);

/// Trials in block `blocks[place]`.
std::int64_t block_rows(const ScenarioResults& results, std::size_t place);

/// Trials that these blocks of a study of `trials` trials have.
std::int64_t trials_in(const BlockRanges& blocks, std::int64_t trials);

/// The trials of rows first ... first + count - 1.
std::vector<std::int64_t> trial_numbers(const ScenarioResults& results, std::int64_t first, std::int64_t count);

/// The row at which a block begins; nothing where the block is not there.
std::optional<std::int64_t> first_row(const ScenarioResults& results, std::int64_t block);

/// Makes `blocks`, of a study of `trials` trials, those that are there: rows of blocks that were and stay are moved, rows
/// of others hold anything until they are stored. Totals are not touched, nor what is not in memory.
void set_blocks(ScenarioResults& results, BlockRanges blocks, std::int64_t trials);

/// All blocks of `trials` trials, the totals in memory.
void extend(ScenarioResults& results, std::int64_t trials);

/// What of a block's columns is kept in its totals: nothing where the trials are kept. From several threads at once.
std::vector<ArmAggregates> block_aggregates(const ScenarioResults& results, const Block& block);

/// Adds a block's totals, and its details and columns (where they are kept, and not in a file) at their rows. Those of
/// different blocks may be stored from several threads at once; totals may not.
void store_columns(ScenarioResults& results, const Block& block);
void add_totals(ScenarioResults& results, const Block& block, const std::vector<ArmAggregates>& aggregates);
void add_totals(ScenarioResults& results, const Block& block);

/// Whether the details of a block that both have, where it has any, are the same in both, under one arm.
bool same_details(const ScenarioResults& a, const ScenarioResults& b, std::size_t arm, std::int64_t block);

/// Copies the details of a block that both have, where it has any. Different blocks may be copied at once.
void copy_details(ScenarioResults& to, const ScenarioResults& from, std::int64_t block);

/// Adds the totals of other trials of the same arm.
void add_totals(ArmResults& to, const ArmResults& from);

/// Takes a block's totals back, exactly: a partial last block is computed again when a study grows.
void remove_totals(ScenarioResults& results, const Block& block);

}  // namespace credence
