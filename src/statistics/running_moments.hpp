#pragma once
// Mean and spread of values that arrive in parts.

#include <credence/statistics.hpp>

#include "base/nan.hpp"

#include <cmath>
#include <vector>

namespace credence {

/// Count, mean and sum of squared deviations; parts are combined without the cancellation of a sum of squares [Chan,
/// Golub and LeVeque 1983, Algorithms for computing the sample variance].
struct RunningMoments {
    std::int64_t count = 0;
    double mean = 0;
    double squares = 0;  ///< sum of (x - mean)^2

    /// Computes the moments of the values that are not NaN, in two passes.
    static RunningMoments of(const std::vector<double>& values) {
        RunningMoments part;
        double sum = 0;
        for (const double value : values)
            if (!std::isnan(value)) sum += value, ++part.count;
        if (part.count == 0) return part;
        part.mean = sum / static_cast<double>(part.count);
        for (const double value : values)
            if (!std::isnan(value)) part.squares += (value - part.mean) * (value - part.mean);
        return part;
    }

    void add(const RunningMoments& other) {
        if (other.count == 0) return;
        const double share = static_cast<double>(other.count) / static_cast<double>(count + other.count);
        const double difference = other.mean - mean;
        squares += other.squares + difference * difference * share * static_cast<double>(count);
        mean += difference * share;
        count += other.count;
    }

    /// NaN where there are too few values.
    Moments moments() const {
        const auto n = static_cast<double>(count);
        const double variance = count > 1 ? squares / (n - 1) : nan;
        return {n, count > 0 ? mean : nan, std::sqrt(variance), std::sqrt(variance / n)};
    }
};

}  // namespace credence
