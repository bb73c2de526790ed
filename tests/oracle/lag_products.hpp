#pragma once
// How far one trial's whitened innovations are correlated in time [docs/statistics.md, Whiteness].

#include "base/nan.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace credence {

/// Products of whitened rows that were observed at a step and a lag before it, summed over steps and rows.
class LagProducts {
public:
    /// `rows`: of an innovation; 0 where there is none.
    LagProducts(std::size_t lags, std::size_t rows)
        : sum(lags), count(lags), whitened_(lags + 1, std::vector<double>(rows, nan)) {}

    void start_trial() {
        std::fill(sum.begin(), sum.end(), 0.0);
        std::fill(count.begin(), count.end(), 0.0);
        for (std::size_t k = 0; k < whitened_.size(); ++k) leave_out(k);
    }
    /// Where step k's whitened rows go, NaN where not observed.
    std::vector<double>& at(std::size_t k) { return whitened_[k % whitened_.size()]; }
    void leave_out(std::size_t k) { std::fill(at(k).begin(), at(k).end(), nan); }

    /// Takes step k's rows in; those of the steps before are there. A product with NaN does not count.
    void correlate(std::size_t k) {
        for (std::size_t lag = 1; lag < whitened_.size() && lag <= k; ++lag) {
            const std::vector<double>&now = at(k), &before = at(k - lag);
            for (std::size_t row = 0; row < now.size(); ++row) {
                const double product = now[row] * before[row];
                if (std::isnan(product)) continue;
                sum[lag - 1] += product;
                count[lag - 1] += 1;
            }
        }
    }

    std::vector<double> sum, count;  ///< [lags]

private:
    std::vector<std::vector<double>> whitened_;  ///< by step, modulo its length
};

}  // namespace credence
