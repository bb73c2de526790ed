#pragma once
// The moments of one trial [columns.hpp, moment_count], step by step: the slow form, for records and worlds of users.

#include "base/nan.hpp"
#include "scenario/state_series.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
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

}  // namespace credence
