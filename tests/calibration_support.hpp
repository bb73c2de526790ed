#pragma once
// What the tests that judge the judge share: worlds whose truth is known, replications, and how often a test rejected
// over them against how often it should. Seeds are fixed; a false-alarm rate is what other seeds would have.

#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <credence/evidence.hpp>
#include "of_scenarios.hpp"
#include <functional>
#include <map>
#include <string>

#include "catch.hpp"
#include "matched.hpp"

namespace credence::test {

/// The same where each feature is missed with 0.3, by its own draw: rows and P vary from trial to trial, and all is
/// exact as before. (Gating on the true range is not: what is seen then tells of the error.)
inline DeformableSettings matched_with_gaps() {
    DeformableSettings s = matched_linear();
    s.sensor.detection = 0.7;
    return s;
}

inline ScenarioResults replication(const DeformableSettings& scenario, std::int64_t trials, std::uint64_t root_seed) {
    validate(scenario);
    Study study = new_study({resolved(scenario)}, root_seed);
    run_study(study, {trials, 1, {}});
    return study.scenarios.front();
}

/// The evidence of studies with the root seeds 1 ... replications, one after the other; without the credibility
/// indices, which have no level and take their time.
inline void replicate(const DeformableSettings& scenario, std::int64_t trials, int replications,
                      const std::function<void(const Evidence&)>& look) {
    for (int r = 1; r <= replications; ++r) {
        ScenarioResults results = replication(scenario, trials, static_cast<std::uint64_t>(r));
        ArmResults& arm = results.arms.front();
        arm.nees.clear();
        arm.errors.clear();
        look(evidence_of(results, arm));
    }
}

/// Whether an interval fails to cover a value; NaN counts as a failure.
inline bool misses(const Interval& interval, double value) {
    return !(interval.low <= value && value <= interval.high);
}

/// Counts of rejections and sums of figures, by name, over independent replications.
class Calibration {
public:
    /// The level of the test lies between `least` and `most`.
    void between(const std::string& test, double least, double most, bool rejected) {
        Rejections& r = rejections_[test];
        r.least = least;
        r.most = most;
        ++r.tried;
        r.rejected += rejected;
    }
    void exactly(const std::string& test, double level, bool rejected) { between(test, level, level, rejected); }
    void at_most(const std::string& test, double level, bool rejected) { between(test, 0, level, rejected); }

    /// A figure with this mean.
    void on_average(const std::string& figure, double mean, double value) {
        Sums& s = sums_[figure];
        s.expected = mean;
        ++s.count;
        s.sum += value - mean;
        s.squares += (value - mean) * (value - mean);
    }

    /// Every count inside its binomial interval, every mean within 4 standard errors of the replications. Another seed
    /// leaves them with 1e-3 each (counts) and 6e-5 (means; a few times as much for counts of rare steps).
    void check() const {
        for (const auto& [test, r] : rejections_) {
            const double share = static_cast<double>(r.rejected) / r.tried;
            INFO(test << ": " << r.rejected << " of " << r.tried << " = " << share);
            CHECK(r.rejected >= quantile(boost::math::binomial(r.tried, r.least), 0.0005));
            CHECK(r.rejected <= quantile(boost::math::binomial(r.tried, r.most), 0.9995));
        }
        for (const auto& [figure, s] : sums_) {
            const double mean = s.sum / s.count, variance = s.squares / s.count - mean * mean;
            INFO(figure << ": " << s.expected + mean << " +- " << std::sqrt(variance / s.count));
            CHECK(std::abs(mean) < 4 * std::sqrt(variance / s.count));
        }
    }

private:
    struct Rejections {
        double least = 0, most = 0;
        int tried = 0, rejected = 0;
    };
    struct Sums {
        double expected = 0, sum = 0, squares = 0;
        int count = 0;
    };
    std::map<std::string, Rejections> rejections_;
    std::map<std::string, Sums> sums_;
};

}  // namespace credence::test
