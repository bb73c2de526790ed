#pragma once
// Trials of a user's own world, one after the other, each evaluated as a step of a record is: the slow, obvious way,
// with which the lanes are compared.

#include "base/nan.hpp"
#include "numeric/chi_square.hpp"
#include "scenario/state_series.hpp"
#include "oracle/lag_products.hpp"
#include "record/moments.hpp"
#include "record/step.hpp"
#include "worlds/own/trial_ends.hpp"
#include <credence/detail/draws.hpp>
#include <credence/detail/own_simulation.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

namespace credence {

inline std::size_t index_of(int count) { return static_cast<std::size_t>(count); }

inline RecordShape evaluated_shape(const Scenario& scenario, const OwnReport& report) {
    RecordShape shape;
    shape.steps = scenario.poses - 1;
    shape.n = static_cast<int>(scenario.components.size());
    shape.m = report.largest_innovation;
    shape.groups = scenario.groups;
    shape.covariance_epsilon = shape.innovation_epsilon = std::numeric_limits<double>::epsilon();
    return shape;
}

/// What every trial of a scenario reads.
struct Case {
    Scenario scenario;
    OwnReport report;
    std::vector<Column> columns;
    RecordShape shape;
    StateSeries all_series;
    std::vector<double> coverage_bounds;  ///< [groups, levels]
    std::function<void(OwnTrial&)> run;

    Case(const Scenario& declared, const OwnReport& reported, std::function<void(OwnTrial&)> one)
        : scenario(declared),
          report(reported),
          columns(own_columns(declared, reported)),
          shape(evaluated_shape(declared, reported)),
          all_series(declared.components, declared.groups,
                  reported.largest_innovation > 0 ? Innovations::given : Innovations::none),
          run(std::move(one)) {
        for (const ComponentGroup& group : scenario.groups)
            for (const double level : coverage_levels)
                coverage_bounds.push_back(stable_chi_square_quantile(level, group.count));
    }
    std::size_t steps() const { return index_of(scenario.poses - 1); }
};

/// One trial after the other, evaluated step by step.
class EvaluatedTrial : public OwnTrial {
public:
    EvaluatedTrial(const Case& of, std::size_t arm)
        : case_(of),
          arm_(arm),
          evaluator_(of.shape, of.all_series),
          all_series_(of.all_series.list.size() * of.steps()),
          errors_(of.steps() * index_of(of.shape.n)),
          own_(of.report.columns.size()),
          step_series_(of.all_series.list.size()),
          products_(index_of(lag_count(of.scenario.poses)), index_of(of.shape.m)),
          moments_(of.shape.n, of.shape.groups.size()) {}

    void run(std::uint64_t root_seed, std::uint64_t trial) {
        draws_.emplace(root_seed, trial, std::numeric_limits<double>::infinity());
        std::fill(own_.begin(), own_.end(), 0.0);
        products_.start_trial();
        moments_.start_trial();
        status_ = Status::completed;
        status_pose_ = -1;
        step_ = 0;
        log_score_ = 0;
        try {
            case_.run(*this);
        } catch (const TrialEnds&) {
            return;
        }
        if (step_ != case_.steps())
            throw std::logic_error("world " + case_.scenario.world + ": a trial took " + std::to_string(step_) +
                                   " steps, not " + std::to_string(case_.steps()) + ".");
        const auto is_whole = [](double value) { return value == std::nearbyint(value) && std::abs(value) < 0x1p31; };
        for (std::size_t c = 0; c < own_.size(); ++c) {
            if (case_.report.columns[c].type != ColumnType::integer || is_whole(own_[c])) continue;
            status_ = Status::non_finite;
            status_pose_ = static_cast<int>(step_);
        }
        const int numbers = (case_.scenario.poses - 1) * case_.shape.n;
        if (status_ == Status::completed && numbers >= least_diverged_numbers && nees_ratio() > diverged_nees_ratio)
            status_ = Status::diverged;
    }

    std::size_t arm() const override { return arm_; }
    int poses() const override { return case_.scenario.poses; }
    // (Left to itself, g++ keeps the generator's rounds out of line, which costs a fifteenth of a tracker's time.)
    CREDENCE_FLAT Eigen::Vector2d normal(int source, int pose, int index) const override {
        const Vector2<double> draw =
            draws_->normal(static_cast<Source>(source), pose, key_index(case_.scenario.world, source, pose, index));
        return {draw.x, draw.y};
    }
    CREDENCE_FLAT double uniform(int source, int pose, int index) const override {
        return draws_->uniform(static_cast<Source>(source), pose, key_index(case_.scenario.world, source, pose, index));
    }
    void set(std::size_t column, double value) override {
        require(column < own_.size(), "a column that it does not have is set");
        own_[column] = value;
    }

    void step(const Vector& error, const Matrix& P) override {
        checked_.rows.clear();
        take(error, P);
    }
    void step(const Vector& error, const Matrix& P, const Vector& innovation, const Matrix& S) override {
        require(innovation.size() <= case_.shape.m, "an innovation longer than innovation_rows");
        require(S.rows() == innovation.size() && S.cols() == S.rows(), "an S of another size than its innovation");
        checked_.rows.clear();
        for (Eigen::Index row = 0; row < innovation.size(); ++row)
            if (!std::isnan(innovation(row))) checked_.rows.push_back(static_cast<int>(row));
        const auto m = static_cast<Eigen::Index>(checked_.rows.size());
        checked_.nu.resize(m);
        checked_.S.resize(m, m);
        for (Eigen::Index a = 0; a < m; ++a) {
            const int i = checked_.rows[static_cast<std::size_t>(a)];
            checked_.nu(a) = innovation(i);
            for (Eigen::Index b = 0; b <= a; ++b)
                checked_.S(a, b) = checked_.S(b, a) = S(i, checked_.rows[static_cast<std::size_t>(b)]);
        }
        take(error, P);
    }

    /// [series_count, K - 1]; steps of a failed trial hold anything.
    const std::vector<double>& all_series() const { return all_series_; }
    const std::vector<double>& errors() const { return errors_; }  ///< [K - 1, n]
    const LagProducts& products() const { return products_; }
    /// Whether trials keep moments, from the next one on.
    void keep_moments(bool keep) { keeps_moments_ = keep; }
    std::vector<double> moments() const { return moments_.moments(); }
    bool is_counted() const { return credence::counts(status_); }
    bool has_failed() const { return failed(status_); }
    std::size_t steps_taken() const { return step_; }

    void columns(std::vector<double>& row) const {
        const StateSeries& at = case_.all_series;
        const double steps = static_cast<double>(case_.steps());
        const bool innovations = case_.shape.has_innovations();
        row = {all_series_[(at.variance + 1) * case_.steps() - 1]};
        row.insert(row.end(), own_.begin(), own_.end());
        row.insert(row.end(), {total(at.squared_error), nees_ratio(),
                               innovations ? total(at.nis) / total(at.rows) : nan, total(at.variance) / steps,
                               log_score_ / steps, static_cast<double>(status_), static_cast<double>(status_pose_)});
    }

private:
    double total(std::size_t f) const {
        double sum = 0;
        for (std::size_t k = 0; k < case_.steps(); ++k) sum += all_series_[f * case_.steps() + k];
        return sum;
    }
    double nees_ratio() const { return total(0) / static_cast<double>(case_.steps()) / case_.shape.n; }

    void require(bool good, const char* otherwise) const {
        if (!good) throw std::logic_error("world " + case_.scenario.world + ": " + otherwise + ".");
    }

    void take(const Vector& error, const Matrix& P) {
        const Eigen::Index n = case_.shape.n;
        require(step_ < case_.steps(), "a trial took more steps than it has");
        require(error.size() == n && P.rows() == n && P.cols() == n, "an error or P of another size than the state");
        checked_.e = error;
        checked_.P = P.selfadjointView<Eigen::Lower>();
        if (!error.allFinite() || !checked_.P.allFinite() ||
            (!checked_.rows.empty() && !(checked_.nu.allFinite() && checked_.S.allFinite())))
            end(Status::non_finite);
        if (!evaluator_.evaluate(checked_, step_series_.data(), products_.at(step_).data()).empty())
            end(Status::covariance_not_positive_definite);
        if (!figures_add_up(step_series_.data(), step_series_.size())) end(Status::non_finite);
        for (std::size_t f = 0; f < step_series_.size(); ++f) all_series_[f * case_.steps() + step_] = step_series_[f];
        std::copy(error.begin(), error.end(), errors_.begin() + static_cast<std::ptrdiff_t>(step_) * n);
        products_.correlate(step_);
        if (keeps_moments_)
            moments_.add(step_series_.data(), step_series_.data() + case_.all_series.standardised_error, checked_.P);
        log_score_ += evaluator_.log_score();
        ++step_;
    }

    void note(Status status) {
        status_ = status;
        status_pose_ = static_cast<int>(step_) + 1;
    }
    [[noreturn]] void end(Status status) {
        note(status);
        throw TrialEnds();
    }

    const Case& case_;
    std::size_t arm_;
    StepEvaluator evaluator_;
    std::optional<KeyedDraws<double>> draws_;
    CheckedStep checked_;
    Status status_ = Status::completed;
    int status_pose_ = -1;
    std::size_t step_ = 0;
    double log_score_ = 0;
    std::vector<double> all_series_, errors_, own_, step_series_;
    LagProducts products_;
    TrialMomentSums moments_;
    bool keeps_moments_ = false;
};

}  // namespace credence
