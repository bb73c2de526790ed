#pragma once
// The totals over the trials of a record.

#include <credence/record.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "record/alike.hpp"
#include "record/presence.hpp"
#include "record/reader.hpp"
#include "record/runs.hpp"
#include "record/moments.hpp"

namespace credence {

class SegmentPlanner;

/// Whether trials that diverged are left out of the series, or count as the others.
enum class DivergedTrials { set_aside, counted };

/// The steps of which a record has results by step: one in `every` [Record::every].
struct KeptSteps {
    std::size_t every, count;

    explicit KeptSteps(const RecordShape& shape);
    bool has(std::size_t k) const { return k % every == 0; }
    /// The place of step k, or of the kept one before it.
    std::size_t place(std::size_t k) const { return k / every; }
};

/// Receives a record's steps one after the other, and makes results of them.
class RecordTotals {
public:
    /// `path` names the scenario; `planner` learns of the runs.
    RecordTotals(const RecordShape& shape, const std::string& path, DivergedTrials diverged, Copies copies,
                 SegmentPlanner* planner = nullptr);
    RecordTotals(const RecordTotals&) = delete;
    RecordTotals& operator=(const RecordTotals&) = delete;

    /// Adds a step; every step of every trial comes once, in order. Throws RecordError for bad input.
    void add(const RecordStep& step);

    /// Whether trials that were taken for copies agree by chance.
    bool agree_by_chance() const { return copy_finder_.copies() > 0 && copy_finder_.by_chance(); }

    /// The results, after the last step.
    Record finish();

private:
    static std::size_t size(std::int64_t count) { return static_cast<std::size_t>(count); }
    ArmResults& arm() { return record_.results.arms.front(); }
    double& series(std::size_t f, std::size_t k) { return values_[k * all_series_.list.size() + f]; }

    void start_trial();
    void add_existing(const RecordStep& step);
    void add_figures(const RecordStep& step, const CheckedStep& checked);
    void note(const RecordStep& step, Status status, const std::string& what);
    void note_diverged(std::int64_t trial, double nees_ratio);
    void check_end(std::int64_t trial);
    void check_copy(std::int64_t trial);
    void keep_details(std::int64_t trial, std::size_t k, const CheckedStep& checked);
    void end_trial(std::int64_t trial);
    void keep_curves(std::size_t trial);
    void add_columns(std::int64_t trial);
    void add_totals();
    void add_all_series(std::vector<SeriesTotals>& to);
    void add_series(std::size_t f, SeriesTotals& totals);
    void add_coverage(std::size_t f, std::size_t k, double value, SeriesTotals& totals);
    void add_distribution();
    void keep_largest_nis();
    void set_dimension(std::size_t k);
    void add_rounding(std::size_t k);
    void finish_rounding();
    double nees_at(std::size_t k);
    const double* bounds(std::size_t f, std::size_t k);

    RecordShape shape_;
    KeptSteps kept_;
    DivergedTrials diverged_;
    Copies copies_;
    SegmentPlanner* planner_;
    StateSeries all_series_;
    AlikeSums alike_;
    StepEvaluator judge_;
    PresenceChecker presence_;
    GapCounter gaps_;
    CopyFinder copy_finder_;
    Record record_;
    bool keeps_nees_ = false, keeps_cells_ = false;
    std::int64_t innovations_left_out_ = 0;      ///< steps of all trials
    /// [kept steps, 1 + groups] trials with the step or one behind it that is not kept, sums over them of the bounds.
    std::vector<double> roundings_;
    std::vector<std::vector<double>> nees_;      ///< [kept steps] of the whole state, all trials; for the distance
    std::vector<double> bounds_;                 ///< [groups, levels] NEES below them counts as covered
    /// [n + 1, levels] the same of a state of that dimension; 0: not known yet.
    std::vector<double> bounds_by_dimension_;

    // State of the current trial.
    CheckedStep checked_;
    Status status_ = Status::completed;
    RecordTrouble trouble_;                      ///< why the trial failed, if it did
    std::vector<std::size_t> present_;           ///< steps that exist and count, in order
    int end_ = 0;                                ///< behind the last step that exists
    std::vector<double> values_;                 ///< [steps, series_count], only of steps that exist
    /// [steps] of the state, if there is a joint covariance; else empty.
    std::vector<int> dimensions_;
    double log_score_ = 0;                       ///< sum over the steps
    RowProducts products_;
    TrialMomentSums moments_;
};

}  // namespace credence
