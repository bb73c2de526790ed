// The bootstrap of a mean, against a second program made from its description (its own Philox, NumPy's sums
// and quantiles), and by replication.

#include "statistics/bootstrap.hpp"
#include <string>

#include "reference.hpp"
#include "synthetic.hpp"

extern "C" {  // OpenMP's; the library is linked with it, the tests are not compiled with it
int omp_get_max_threads();
void omp_set_num_threads(int);
}

namespace credence::test::bootstrap_test {

namespace {

const double missing = std::numeric_limits<double>::quiet_NaN();

/// The column that make_statistics.py describes.
std::vector<double> long_column(const Json& reference_case) {
    std::vector<double> values;
    for (int i = 0; i < reference_case["trials"].get<int>(); ++i) {
        const bool failed =
            (reference_case["failed"] == 1 && i % 97 == 5) || (reference_case["empty_block"] == 1 && i / 256 == 3);
        values.push_back(failed ? missing : (i * 7919 % 1009) / 64.0 + i / 256 % 7);
    }
    return values;
}

Interval bootstrap_of(const Json& reference_case, const std::vector<double>& values) {
    return bootstrap_mean_interval(values, reference_case["seed"], reference_case["figure"], reference_case["alpha"]);
}

bool same(const Interval& a, const Interval& b) { return a.low == b.low && a.high == b.high; }

/// Of `replications` bootstrap intervals, how many hold the mean.
int intervals_that_hold(double mean, int replications, int values, std::uint64_t seed, double (*shape)(double)) {
    Normals normals(seed);
    int held = 0;
    for (int r = 0; r < replications; ++r) {
        std::vector<double> sample(static_cast<std::size_t>(values));
        for (double& x : sample) x = shape(normals());
        const Interval interval = bootstrap_mean_interval(sample, static_cast<std::uint64_t>(r), "coverage");
        held += interval.low <= mean && mean <= interval.high;
    }
    return held;
}

}  // namespace

TEST_CASE("bootstrap: intervals of trials and of blocks are those that NumPy gives") {
    // Sums in another order: 1e-12. The cases cover 25,599 and 25,600 trials, where blocks begin; failed trials; a
    // block in which all failed, with 99 or 100 blocks left; partial last blocks; alpha 0.1 and 0.01.
    for (const Json& one : reference("bootstrap")) {
        CAPTURE(one["figure"], one["seed"]);
        check_agrees(bootstrap_of(one, one.contains("trials") ? long_column(one) : numbers(one["values"])),
                     one["interval"], 1e-12);
    }
}

TEST_CASE("bootstrap: the same bits for any number of threads, in any order of calls") {
    const int threads = omp_get_max_threads();
    const std::vector<double> by_block = long_column(reference("bootstrap")[9]);
    const std::vector<double> by_trial(by_block.begin(), by_block.begin() + 3001);
    omp_set_num_threads(1);
    const Interval of_trials = bootstrap_mean_interval(by_trial, 1, "f");
    const Interval of_blocks = bootstrap_mean_interval(by_block, 1, "f");
    for (const int number_of_threads : {5, 3, 2}) {
        omp_set_num_threads(number_of_threads);
        CHECK(same(bootstrap_mean_interval(by_block, 1, "f"), of_blocks));
        CHECK(same(bootstrap_mean_interval(by_trial, 1, "f"), of_trials));
    }
    omp_set_num_threads(threads);
}

TEST_CASE("bootstrap: root seed and column key the draws") {
    const std::vector<double> values{1, 2, 4, 8, 16, 32, 64};
    const Interval interval = bootstrap_mean_interval(values, 1, "trace_P");
    CHECK(same(interval, bootstrap_mean_interval(values, 1, "trace_P")));
    CHECK_FALSE(same(interval, bootstrap_mean_interval(values, 2, "trace_P")));
    CHECK_FALSE(same(interval, bootstrap_mean_interval(values, 1ULL << 32 | 1, "trace_P")));
    CHECK_FALSE(same(interval, bootstrap_mean_interval(values, 1, "trace_Q")));
}

TEST_CASE("bootstrap: equal values give a point, too few values and infinite ones NaN") {
    for (const std::size_t count : {2u, 3u, 1000u, 30000u}) {
        const Interval point = bootstrap_mean_interval(std::vector<double>(count, 0.1), 1, "f");
        CHECK(point.low == 0.1);
        CHECK(point.high == 0.1);
    }
    for (const std::vector<double>& values : {std::vector<double>{},
                                              {4.0},
                                              {missing, 4.0, missing},
                                              {1.0, 2.0, HUGE_VAL},
                                              std::vector<double>(30000, missing)}) {
        CHECK(std::isnan(bootstrap_mean_interval(values, 1, "f").low));
        CHECK(std::isnan(bootstrap_mean_interval(values, 1, "f").high));
    }
}

TEST_CASE("bootstrap: below 25,600 trials failed trials are as good as absent") {
    CHECK(
        same(bootstrap_mean_interval({1, missing, 3, 7, missing}, 5, "f"), bootstrap_mean_interval({1, 3, 7}, 5, "f")));
}

TEST_CASE("bootstrap: of many normal values, by trial and by block, the interval is about the normal one") {
    // An end is off by 0.06 standard errors for 2000 resamples, and for 100 blocks by 7 % of 1.96 of them besides: 0.15
    // together. Beyond 4 of these with 6e-5 each, four of them 2.4e-4. By alpha in each tail the ends would be off by
    // 0.3 standard errors: the first pair would show it.
    for (const int values : {20000, 25600}) {
        Normals normals(21);
        std::vector<double> sample;
        for (int i = 0; i < values; ++i) sample.push_back(normals() + 3);
        const Summary summary = summarise(sample);
        const Interval interval = bootstrap_mean_interval(sample, 1, "normal");
        const double bound = values == 20000 ? 0.24 : 0.6;
        CHECK(std::abs((interval.low - summary.mean) / summary.standard_error + 1.96) < bound);
        CHECK(std::abs((interval.high - summary.mean) / summary.standard_error - 1.96) < bound);
    }
}

TEST_CASE("bootstrap: coverage of 50 normal and lognormal values is what replication elsewhere finds", "[long]") {
    // The percentile bootstrap of 50 values covers less than its nominal 95 %: 94.0 % for normal values (z in place of
    // t, n in place of n - 1), 89.4 % for lognormal ones, whose mean is drawn from a heavy tail. Both by 10,000
    // replications in NumPy; 1,000 here are 4 standard deviations off with 6e-5 each.
    const Json& coverage = reference("bootstrap_coverage");
    const int values = coverage["values"], replications = 1000;
    const auto normal = [](double x) { return x; };
    const auto lognormal = [](double x) { return std::exp(x); };
    CHECK(within_binomial(intervals_that_hold(0, replications, values, 31, normal), replications, coverage["normal"]));
    CHECK(within_binomial(intervals_that_hold(std::exp(0.5), replications, values, 32, lognormal), replications,
                          coverage["lognormal"]));
}

}  // namespace credence::test::bootstrap_test
