#pragma once
// How far one trial's whitened innovations are correlated [docs/statistics.md, Whiteness].

#include "base/nan.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace credence {

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
