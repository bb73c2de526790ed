#include "record/totals.hpp"

#include "base/formatted.hpp"
#include "base/nan.hpp"
#include "numeric/chi_square.hpp"
#include "record/results.hpp"
#include "record/segments.hpp"
#include "statistics/goodness.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

constexpr std::int64_t most_values = std::int64_t{1} << 24;  ///< limit on the NEES values, and on the cells
constexpr std::size_t most_troubles = 20;
constexpr double accuracy_of_nis = 0.005;  ///< a tenth of the usual margin: where rounding may do more, NIS is left out

}  // namespace

RecordTotals::RecordTotals(const RecordShape& shape, const std::string& path, DivergedTrials diverged, Copies copies,
                           SegmentPlanner* planner)
    : shape_(shape),
      kept_(shape_),
      diverged_(diverged),
      copies_(copies),
      planner_(planner),
      all_series_(record_series(shape_)),
      alike_(shape_),
      judge_(shape_, all_series_),
      presence_(shape_),
      gaps_(size(shape_.steps)),
      products_(size(lag_count(shape_.steps + 1)), size(shape_.m)),
      moments_(shape_.n, shape_.groups.size()) {
    const auto kept = static_cast<std::int64_t>(kept_.count);
    record_.every = static_cast<int>(kept_.every);
    record_.results = empty_record_results(shape_, all_series_.list, path, static_cast<int>(kept));
    record_.has_innovations = shape.has_innovations();
    record_.of_innovations = shape.of_innovations;
    for (std::size_t g = 0; shape.has_innovations() && g <= shape.row_groups.size(); ++g)
        record_.largest_nis.push_back({g == 0 ? "all" : shape.row_groups[g - 1].name, 0, 0, 0, {}});
    keeps_nees_ = shape.trials <= most_values / kept;
    keeps_cells_ = kept * distribution_cells <= most_values && !keeps_nees_;
    if (keeps_nees_) nees_.resize(size(kept));
    if (keeps_cells_) arm().totals.cells.resize(size(kept) * distribution_cells);
    bounds_ = coverage_bounds(shape.groups);
    values_.resize(size(shape.steps) * all_series_.list.size());
    roundings_.resize(size(kept) * (1 + shape.groups.size()));
    for (SeriesTotals& totals : arm().totals.series) totals.present.resize(size(kept));
    if (!shape.has_joint()) return;
    dimensions_.resize(size(shape.steps));
    arm().totals.series.front().dimensions.resize(size(kept));
    bounds_by_dimension_.resize(size(shape.n + 1) * coverage_level_count);
}

void RecordTotals::add(const RecordStep& step) {
    if (step.step == 0) start_trial();
    if (!failed(status_)) add_existing(step);  // the filter's values after a failure are ignored
    if (step.step + 1 < shape_.steps) return;
    if (!failed(status_)) check_end(step.trial);
    end_trial(step.trial);
}

void RecordTotals::add_existing(const RecordStep& step) {
    switch (presence_.check(step, checked_)) {
        case Presence::there: return add_figures(step, checked_);
        case Presence::broken: return note(step, Status::non_finite, checked_.broken);
        case Presence::absent: break;
    }
    products_.leave_out();
}

/// Ends a trial. One that has fewer steps than it should has failed, unless the record declares a lower number.
void RecordTotals::check_end(std::int64_t trial) {
    if (end_ == 0) return note({trial, 0}, Status::non_finite, "no step exists: every error is NaN");
    const int end = end_, asked = shape_.steps_of(trial);
    if (end == asked) return check_copy(trial);
    const std::string of = "the trial ends after " + std::to_string(end) + " of ";
    const bool declared = !shape_.declared.empty();
    note({trial, end}, Status::non_finite,
         of + (declared ? "the " : "") + std::to_string(asked) + " steps" +
             (declared ? " that `steps` declares" : ", and no dataset `steps` declares that it is shorter"));
}

void RecordTotals::check_copy(std::int64_t trial) {
    if (copies_ == Copies::count || present_.empty()) return;
    const std::optional<std::int64_t> first = copy_finder_.end_trial(trial);
    if (!first) return;
    note({trial, 0}, Status::non_finite,
         "its errors are those of trial " + std::to_string(*first) + ", to the last bit: it is a copy");
    trouble_.status = Status::completed;
}

void RecordTotals::start_trial() {
    status_ = Status::completed;
    present_.clear();
    end_ = 0;
    products_.start_trial();
    moments_.start_trial();
    copy_finder_.start_trial();
    log_score_ = 0;
}

void RecordTotals::add_figures(const RecordStep& step, const CheckedStep& checked) {
    const std::size_t k = size(step.step);
    double* values = &series(0, k);
    const std::string trouble = judge_.evaluate(checked, values, products_.now.data());
    if (!trouble.empty()) return note(step, Status::covariance_not_positive_definite, trouble);
    if (!figures_add_up(values, all_series_.list.size()))
        return note(step, Status::non_finite, "a figure of this step is beyond 1e140");
    end_ = step.step + 1;
    if (shape_.compared && !shape_.compared(step.trial, step.step)) return products_.leave_out();
    if (judge_.innovation_rounding() > accuracy_of_nis) {
        judge_.leave_out_innovation(values, products_.now.data());
        ++innovations_left_out_;
    }
    add_rounding(k);
    judge_.forget_unknown(values);
    alike_.keep(k, checked);
    set_dimension(k);
    log_score_ += judge_.log_score();
    present_.push_back(k);
    for (std::size_t j = 0; shape_.has_errors && j < size(shape_.n); ++j) copy_finder_.add(step.error[j]);
    for (const double nees : checked.nees) copy_finder_.add(nees);
    keep_details(step.trial, k, checked);
    if (record_.has_innovations) products_.correlate();
}

void RecordTotals::note(const RecordStep& step, Status status, const std::string& what) {
    status_ = status;
    trouble_ = {step.trial, step.step, what, status};
}

void RecordTotals::keep_details(std::int64_t trial, std::size_t k, const CheckedStep& checked) {
    if (trial >= record_.results.detailed()) return;
    if (shape_.has_errors) moments_.add(&series(0, k), &series(all_series_.standardised_error, k), checked.P);
    if (!kept_.has(k)) return;
    const std::size_t at = size(trial) * kept_.count + kept_.place(k);
    arm().nees[at] = !dimensions_.empty() && dimensions_[k] < shape_.n ? nan : series(0, k);
    for (Eigen::Index j = 0; j < checked.e.size(); ++j)
        arm().errors[at * size(shape_.n) + static_cast<std::size_t>(j)] =
            checked.has(static_cast<int>(j)) ? checked.e(j) : nan;
}

void RecordTotals::end_trial(std::int64_t trial) {
    add_columns(trial);
    keep_curves(size(trial));
    if (status_ != Status::completed) {
        ++record_.trouble_count;
        if (record_.troubles.size() < most_troubles) record_.troubles.push_back(trouble_);
    }
    if (trial < record_.results.detailed() && !failed(status_)) {
        const std::vector<double> moments = moments_.moments();
        std::copy(moments.begin(), moments.end(), arm().moments.begin() + trial * std::ssize(moments));
    }
    if (counts(status_) || (status_ == Status::diverged && diverged_ == DivergedTrials::counted)) {
        gaps_.add(trial, shape_.steps_of(trial), present_, [this](std::size_t k) { return series(0, k) / shape_.n; });
        add_totals();
        if (planner_ != nullptr)
            planner_->add(trial, present_, all_series_.list,
                          [this](std::size_t f, std::size_t k) { return series(f, k); });
    } else if (status_ == Status::diverged) {
        add_all_series(arm().totals.of_diverged());
    }
    if (!failed(status_)) return;
    if (trial >= record_.results.detailed()) return;
    const auto forget = [&](std::vector<double>& values, std::size_t row) {
        const auto first = values.begin() + trial * static_cast<std::ptrdiff_t>(row);
        std::fill(first, first + static_cast<std::ptrdiff_t>(row), nan);
    };
    forget(arm().nees, kept_.count);
    forget(arm().errors, kept_.count * size(shape_.n));
}

void RecordTotals::add_columns(std::int64_t trial) {
    const std::vector<Column>& columns = record_.results.columns;
    const std::size_t at_status = status_column(columns);
    std::vector<double> row(columns.size(), nan);
    for (std::size_t own = 0, next = RecordColumn::own; own < shape_.columns.size(); ++own) {
        const bool known = shape_.columns[own].name == unseen_column;
        row[known ? std::size_t{RecordColumn::unseen} : next++] = shape_.column_values[own][size(trial)];
    }
    // Sums and means are over the steps at which the series has a value; NaN where it has none.
    const auto at = [&](std::size_t f, std::size_t k) {
        const double all = series(f, k);
        return f == all_series_.variance                             ? alike_.variance(k, all)
               : f == all_series_.squared_error + pose_group(shape_) ? alike_.error(k, all)
                                                                     : all;
    };
    const auto count = [&](std::size_t f) {
        return static_cast<double>(
            std::ranges::count_if(present_, [&](std::size_t k) { return !std::isnan(at(f, k)); }));
    };
    const auto over_steps = [&](std::size_t f) {
        double sum = 0;
        for (const std::size_t k : present_)
            if (const double value = at(f, k); !std::isnan(value)) sum += value;
        return count(f) > 0 ? sum : nan;
    };
    row[at_status + 1] = failed(status_) ? trouble_.step + 1 : -1;
    row[at_status] = static_cast<double>(status_);
    if (!fill_failed(columns, row.data())) {
        if (shape_.has_errors) {
            row[RecordColumn::trace_P] = present_.empty() ? nan : at(all_series_.variance, present_.back());
            row[RecordColumn::mean_trace_P] = over_steps(all_series_.variance) / count(all_series_.variance);
            row[RecordColumn::log_score] = log_score_ / static_cast<double>(present_.size());
            row[RecordColumn::pose_error] = over_steps(all_series_.squared_error + pose_group(shape_));
        }
        row[RecordColumn::nees_ratio] = over_steps(0) / count(0) / shape_.n;
        const bool by_P_alone = shape_.has_truth_covariance && shape_.truth != TruthUse::added;
        if (!by_P_alone && row[RecordColumn::nees_ratio] > diverged_nees_ratio &&
            std::ssize(present_) * shape_.n >= least_diverged_numbers)
            note_diverged(trial, row[RecordColumn::nees_ratio]);
        row[RecordColumn::nis_ratio] =
            record_.has_innovations ? over_steps(all_series_.nis) / over_steps(all_series_.rows) : nan;
    }
    row[at_status] = static_cast<double>(status_);
    for (std::size_t c = 0; c < row.size(); ++c) arm().columns.in_memory()[c][size(trial)] = row[c];
}

/// Names the step at which the NEES of a diverged trial is largest.
void RecordTotals::note_diverged(std::int64_t trial, double nees_ratio) {
    const auto nees = [&](std::size_t k) { return std::isnan(series(0, k)) ? -1 : series(0, k); };
    const std::size_t worst = *std::ranges::max_element(present_, {}, nees);
    note({trial, static_cast<int>(worst)}, Status::diverged,
         formatted("the trial diverged: NEES/dim %.3g over its steps, most here", nees_ratio));
}

Record RecordTotals::finish() {
    finish_rounding();
    record_.gaps = gaps_.finish();
    arm().totals.trials = trial_totals(record_.results.columns, 1, size(shape_.trials),
                                       [&](std::size_t, std::size_t c) { return arm().columns.in_memory()[c].data(); })
                              .front();
    arm().totals.trials.diverged_count = diverged_ == DivergedTrials::counted;
    std::vector<std::string>& said = record_.results.not_judged;
    if (innovations_left_out_ > 0)
        said.push_back("The innovations of " + std::to_string(innovations_left_out_) +
                       " steps are left out: their covariance cannot be inverted to 0.5 %.");
    if (copy_finder_.copies() > 0) said.insert(said.begin(), copy_finder_.note(shape_.trials));
    if (keeps_nees_ || !keeps_cells_) arm().totals.distribution_distance.assign(kept_.count, nan);
    for (std::size_t k = 0; k < nees_.size(); ++k)
        arm().totals.distribution_distance[k] = uniform_distance(std::move(nees_[k]));
    return std::move(record_);
}

}  // namespace credence
