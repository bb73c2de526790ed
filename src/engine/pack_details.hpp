#pragma once
// What is kept of a pack of detailed trials, whatever the world: the errors of the state, moments [columns.hpp,
// moment_count], and how far whitened innovations are correlated in time [docs/statistics.md, Whiteness, NCI].

#include <credence/columns.hpp>
#include <credence/detail/batch.hpp>
#include <credence/detail/lane.hpp>
#include "slam/trial/problem.hpp"

#include <cstddef>

namespace credence {

inline constexpr int largest_lag = 10;

inline namespace CREDENCE_TARGET {

/// Products of whitened rows that were observed at a step and a lag before it, summed over steps and rows.
template <class Real>
class LaneProducts {
public:
    /// Reals that it needs beside itself.
    static std::size_t room(int rows) { return static_cast<std::size_t>(2 * (largest_lag + 1) * rows); }

    void start(int rows, Real* room) {
        rows_ = rows;
        history_ = room;
        for (int lag = 0; lag < largest_lag; ++lag) sum_[lag] = count_[lag] = Real(0);
    }
    /// Row `row` of step k, counted from 0: its whitened innovation and 1, or 0 and 0 where it was not observed.
    void keep(int k, int row, Real whitened, Real observed) {
        Real* cell = at(k) + 2 * row;
        cell[0] = whitened;
        cell[1] = observed;
    }
    /// Takes step k in; the steps before are there.
    [[gnu::noinline]] void correlate(int k) {
        for (int lag = 1; lag <= largest_lag && lag <= k; ++lag) {
            const Real *now = at(k), *before = at(k - lag);
            Real sum = sum_[lag - 1], count = count_[lag - 1];
            for (int cell = 0; cell < 2 * rows_; cell += 2) {
                sum = fma(now[cell], before[cell], sum);
                count = fma(now[cell + 1], before[cell + 1], count);
            }
            sum_[lag - 1] = sum;
            count_[lag - 1] = count;
        }
    }
    /// Adds those of the trials that count to the batch's running sums.
    void add_to(const Batch& batch, int poses, Mask<Real> counts, int trial) const {
        for (int lag = 0; lag < lag_count(poses); ++lag) {
            const Real sum = select(counts, sum_[lag], Real(0));
            const int place = lag * octet + trial % octet;
            double *sums = batch.product_sums + place, *squares = batch.product_square_sums + place;
            double* counted = batch.product_counts + place;
            store(load<Real>(sums) + sum, sums);
            store(fma(sum, sum, load<Real>(squares)), squares);
            store(load<Real>(counted) + select(counts, count_[lag], Real(0)), counted);
        }
    }

private:
    Real* at(int k) { return history_ + 2 * (k % (largest_lag + 1)) * rows_; }

    int rows_ = 0;
    Real* history_ = nullptr;                     ///< [steps modulo its length, rows, 2]
    Real sum_[largest_lag], count_[largest_lag];  ///< [lag - 1]
};

/// Adds a step to moments [moment_count, those of the groups' NEES left out]. `P(i, j)`, i <= j, covariance [n, n];
/// `standardised` e_j/sigma_j [n]; `inverse_sigma` 1/sqrt(P_jj) [n].
template <class Real, class Covariance>
[[gnu::noinline]] void add_moments(int n, const Covariance& P, const Real* standardised, const Real* inverse_sigma,
                                   Real* moments) {
    for (int j = 0; j < n; ++j) moments[j] = moments[j] + standardised[j];
    Real *products = moments + n, *correlations = products + n * (n + 1) / 2;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j <= i; ++j, ++products, ++correlations) {
            *products = fma(standardised[i], standardised[j], *products);
            *correlations = fma(P(j, i) * inverse_sigma[i], inverse_sigma[j], *correlations);
        }
}

/// Stores a pack's numbers [cells] in their places in [cells, octets, 8].
template <class Real>
void copy_out(const Real* from, int cells, int trial, const Batch& batch, double* to) {
    const int padded = (batch.trials + octet - 1) / octet * octet;
    for (int cell = 0; cell < cells; ++cell) store(from[cell], to + cell * padded + trial);
}

template <class Real>
class PackDetails {
public:
    bool on = false;          ///< false: the batch asks for none, and of the rest only what a budget keeps is touched
    bool keeps_errors = false;
    Real* errors = nullptr;   ///< [n, K - 1] x^ - x after the updates
    Real* variances = nullptr;  ///< [n, K - 1] P_jj after the updates, for a budget; else null
    Real* moments = nullptr;  ///< [moment_count], those of the groups' NEES left out; null where there are none
    LaneProducts<Real> products;

    /// Reals that it needs beside itself, with whitened innovations of `rows` rows.
    static std::size_t room(const CommonView& problem, int rows) {
        return error_cells(problem) * (problem.keeps_variances ? 2 : 1) + moment_cells(problem) +
               LaneProducts<Real>::room(rows);
    }

    PackDetails(const CommonView& problem, int rows, const Batch& batch, Real* room)
        : on(batch.errors != nullptr), keeps_errors(on || problem.kept_count > 0), errors(room), problem_(problem),
          rows_(rows), history_(room + error_cells(problem) + moment_cells(problem)) {
        if (on && moment_cells(problem) > 0) moments = errors + error_cells(problem);
        if (problem.keeps_variances) variances = history_ + LaneProducts<Real>::room(rows);
    }

    /// Before each pack.
    void start() {
        if (on) products.start(rows_, history_);
        for (std::size_t i = 0; moments != nullptr && i < moment_cells(problem_); ++i) moments[i] = Real(0);
    }
    /// Writes the columns of a budget [columns.hpp, with_errors] before the last two of the `own` ones of a trial.
    void write_columns(int own, Real* columns) const {
        if (problem_.kept_count == 0) return;
        Real* to = columns + own - 2;
        const Real status = to[0], pose = to[1];
        for (const Real* from : {errors, variances})
            for (int i = 0; from != nullptr && i < problem_.kept_count; ++i)
                for (int j = 0; j < problem_.state_size; ++j)
                    *to++ = from[j * (problem_.poses - 1) + problem_.kept_steps[i]];
        to[0] = status;
        to[1] = pose;
    }
    /// Stores what there is of the trials from `trial` on: of moments, NEES and standardised errors as means over the
    /// steps.
    void keep(const Real* all_series, Mask<Real> counts, int trial, const Batch& batch) const {
        if (!on) return;
        copy_out(errors, static_cast<int>(error_cells(problem_)), trial, batch, batch.errors);
        products.add_to(batch, problem_.poses, counts, trial);
        if (moments == nullptr) return;
        const int steps = problem_.poses - 1, padded = (batch.trials + octet - 1) / octet * octet;
        const Real share = Real(1.0 / steps);
        double* to = batch.moments + trial;
        for (int b = 0; b < problem_.group_count; ++b, to += padded) {
            Real sum = Real(0);
            for (int k = 0; k < steps; ++k) sum = sum + all_series[b * steps + k];
            store(sum * share, to);
        }
        for (std::size_t i = 0; i < moment_cells(problem_); ++i, to += padded)
            store(i < size(problem_.state_size) ? moments[i] * share : moments[i], to);
    }

private:
    static std::size_t size(int count) { return static_cast<std::size_t>(count); }
    static std::size_t error_cells(const CommonView& problem) {
        return size(problem.state_size) * size(problem.poses - 1);
    }
    static std::size_t moment_cells(const CommonView& problem) { return size(moment_count(problem.state_size, 0)); }

    const CommonView& problem_;
    int rows_;
    Real* history_;  ///< of the products
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
