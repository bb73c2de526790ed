#pragma once
// How far the whitened innovations of a pack of trials are correlated in time, as LagProducts says it of one trial.

#include "engine/detail.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// Products of whitened rows that were observed at a step and a lag before it, summed over steps and rows.
template <class Real>
class LaneProducts {
public:
    static std::size_t room(int rows) { return static_cast<std::size_t>(2 * (largest_lag + 1) * rows); }

    Real sum[largest_lag], count[largest_lag];  ///< [lag - 1]

    /// `room`: as many Reals as room() says, which belong to this.
    void start(int rows, Real* room) {
        rows_ = rows;
        history_ = room;
        for (int lag = 0; lag < largest_lag; ++lag) sum[lag] = count[lag] = Real(0);
    }
    /// Row `row` of step k: its whitened innovation and 1, or 0 and 0 where it was not observed.
    void keep(int k, int row, Real whitened, Real observed) {
        Real* cell = at(k) + 2 * row;
        cell[0] = whitened;
        cell[1] = observed;
    }
    /// Takes step k in, k counted from 0; the steps before are there.
    void correlate(int k) {
        for (int lag = 1; lag <= largest_lag && lag <= k; ++lag) {
            const Real *now = at(k), *before = at(k - lag);
            for (int cell = 0; cell < 2 * rows_; cell += 2) {
                sum[lag - 1] = fma(now[cell], before[cell], sum[lag - 1]);
                count[lag - 1] = fma(now[cell + 1], before[cell + 1], count[lag - 1]);
            }
        }
    }

private:
    Real* at(int k) { return history_ + 2 * (k % (largest_lag + 1)) * rows_; }

    int rows_ = 0;
    Real* history_ = nullptr;  ///< [steps modulo its length, rows, 2]
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
