#pragma once
// Sums over the steps of one trial: its moments [columns.hpp, moment_count], the slow form, for records and worlds of
// users, and how far its whitened innovations are correlated [docs/statistics.md, Whiteness].

#include "base/nan.hpp"
#include "scenario/state_series.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace credence {

/// Numbers that a step does not have are NaN, and are left out: of NEES and standardised errors the means are over the
/// steps that have them, of the products the sums.
class TrialMomentSums {
public:
    TrialMomentSums(int state_size, std::size_t groups)
        : n_(state_size),
          groups_(groups),
          sums_(static_cast<std::size_t>(moment_count(state_size, static_cast<int>(groups)))),
          counts_(sums_.size()) {}

    void start_trial() {
        std::fill(sums_.begin(), sums_.end(), 0.0);
        std::fill(counts_.begin(), counts_.end(), 0);
    }

    /// Adds a step: NEES of each group [groups], standardised errors [n], and covariance [n, n], empty where there is
    /// none.
    void add(const double* nees, const double* standardised, const Eigen::MatrixXd& P) {
        if (sums_.empty()) return;
        std::size_t at = 0;
        const auto put = [&](double value) {
            if (!std::isnan(value)) sums_[at] += value, ++counts_[at];
            ++at;
        };
        for (std::size_t b = 0; b < groups_; ++b) put(nees[b]);
        for (int j = 0; j < n_; ++j) put(standardised[j]);
        if (P.size() == 0) return;
        for (int i = 0; i < n_; ++i)
            for (int j = 0; j <= i; ++j) put(standardised[i] * standardised[j]);
        for (int i = 0; i < n_; ++i)
            for (int j = 0; j <= i; ++j)
                put(std::isnan(standardised[i] * standardised[j]) ? nan : P(i, j) / std::sqrt(P(i, i) * P(j, j)));
    }

    /// The trial's moments, NaN where it has none; empty where none are kept.
    std::vector<double> moments() const {
        std::vector<double> values = sums_;
        const std::size_t means = groups_ + static_cast<std::size_t>(n_);
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = counts_[i] == 0 ? nan : i < means ? values[i] / counts_[i] : values[i];
        return values;
    }

private:
    int n_;
    std::size_t groups_;
    std::vector<double> sums_;
    std::vector<int> counts_;
};

/// Products of a row's whitened innovation and of that a lag before, summed over steps and rows. A lag counts the
/// measurements of the row, whatever the steps between: a row that is observed at every eleventh step has its lag 1
/// there.
class RowProducts {
public:
    /// `rows`: of an innovation; 0 where there is none.
    RowProducts(std::size_t lags, std::size_t rows) : sum(lags), count(lags), now(rows), before_(rows) {}

    void start_trial() {
        sum.assign(sum.size(), 0.0);
        count.assign(count.size(), 0.0);
        for (std::vector<double>& row : before_) row.clear();
    }

    /// Adds the rows of `now`.
    void correlate() {
        for (std::size_t row = 0; row < now.size(); ++row) {
            std::vector<double>& before = before_[row];
            for (std::size_t lag = 1; lag <= sum.size() && lag <= before.size(); ++lag) {
                const double product = now[row] * before[before.size() - lag];
                if (std::isnan(product)) continue;
                sum[lag - 1] += product;
                count[lag - 1] += 1;
            }
            if (!std::isnan(now[row])) before.push_back(now[row]);
        }
    }

    /// A step that does not exist.
    void leave_out() {
        for (double& row : now) row = nan;
        correlate();
    }

    std::vector<double> sum, count;  ///< [lags]
    std::vector<double> now;         ///< [rows] of the current step, NaN where not observed

private:
    std::vector<std::vector<double>> before_;  ///< [rows] measurements of the trial so far
};

}  // namespace credence
