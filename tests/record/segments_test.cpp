// A few long runs are counted by segments [docs/statistics.md, One log].

#include <credence/report.hpp>
#include <credence/text.hpp>

#include "statistics/autocorrelation.hpp"
#include "record_support.hpp"

namespace credence::test::segments_test {

namespace {

std::vector<double> autoregressive(double correlation, int steps, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<double> values{normal(random)};
    const double fresh = std::sqrt(1 - correlation * correlation);
    while (std::ssize(values) < steps) values.push_back(correlation * values.back() + fresh * normal(random));
    return values;
}

/// Runs whose errors have P = 1 in two components, and decorrelate by `correlation` a step.
DrawnRecord logs(int runs, int steps, double correlation, unsigned seed = 1) {
    DrawnRecord record(runs, steps, 2, 1);
    for (int component = 0; component < 2; ++component)
        for (int run = 0; run < runs; ++run) {
            const std::vector<double> errors =
                autoregressive(correlation, steps, seed + 10 * static_cast<unsigned>(run) +
                                                       static_cast<unsigned>(component));
            for (int k = 0; k < steps; ++k) {
                record.error[record.at(run, k)](component) = errors[static_cast<std::size_t>(k)];
                record.covariance[record.at(run, k)] = Eigen::MatrixXd::Identity(2, 2);
            }
        }
    return record;
}

Report judged(const DrawnRecord& drawn, int segments = segments_auto, const Limits& limits = {}) {
    const TemporaryFolder folder;
    const std::string path = folder / "record.h5";
    write_file(path, [&](const Handle& root) { write_drawn(root, drawn); });
    return make_record_report(read_record(path, {}, segments), path, limits);
}

Consistency verdict_on(const DrawnRecord& drawn) { return judged(drawn).arms.front().consistency; }

}  // namespace

TEST_CASE("segments: the autocorrelation time of an autoregression is that of its formula") {
    for (const double correlation : {0.0, 0.5, 0.9, 0.98}) {
        // 1/2 + sum of the powers of the correlation
        const double expected = 0.5 + correlation / (1 - correlation);
        CAPTURE(correlation);
        CHECK(autocorrelation(autoregressive(correlation, 400000, 1), 0).time == Approx(expected).epsilon(0.06));
    }
    CHECK(autocorrelation({3, 3, 3, 3}, 3).time == 0.5);
    CHECK(autocorrelation({}, 0).time == 0.5);
    CHECK(autocorrelation({1, -1, 1, -1, 1, -1, 1, -1}, 0).time == 0.5);
    std::vector<double> offset = autoregressive(0, 1000, 1);
    for (double& value : offset) value += 1;
    CHECK(std::isinf(autocorrelation(offset, 0).time));
    CHECK(autocorrelation(offset, 1).time < 1);
    CHECK(f_upper_quantile(0.01, 3, 20) == Approx(4.938193).epsilon(1e-6));  // scipy.stats.f.isf(0.01, 3, 20)
}

TEST_CASE("segments: the page draws the autocorrelation that their length follows from, without the log's trend") {
    const DrawnRecord log = logs(1, 1000, 0.6);
    const SegmentEvidence found = judged(log).arms.front().evidence.segments;
    double longest = 0;
    std::size_t cut = 0;
    std::string slowest;
    std::vector<double> correlation;
    for (int component = 0; component < 2; ++component) {
        std::vector<double> sums{0};  // P is 1
        double mean = 0, slope = 0;
        const auto time_of = [](std::size_t k) { return static_cast<double>(k) - 499.5; };
        for (std::size_t k = 0; k < 1000; ++k) {
            mean += log.error[k](component) / 1000;
            slope += log.error[k](component) * time_of(k) * 12 / (1e9 - 1e3);
        }
        const auto error = [&](std::size_t k) { return log.error[k](component) - mean - slope * time_of(k); };
        for (std::size_t lag = 0; lag <= 500; ++lag) {
            for (std::size_t k = 0; k + lag < 1000; ++k) sums.back() += error(k) * error(k + lag);
            sums.push_back(0);
        }
        double time = 0.5;
        std::size_t window = 0;
        while (window == 0 || static_cast<double>(window) < 5 * time) time += sums[++window] / sums[0];
        if (time <= longest) continue;
        longest = time;
        cut = window;
        slowest = "error/sigma of x" + std::to_string(component);
        correlation = sums;
    }
    CHECK(found.autocorrelation_time == Approx(longest).epsilon(1e-12));
    CHECK(found.window == cut);
    CHECK(found.slowest == slowest);
    REQUIRE(found.correlation.size() == 2 * cut + 1);
    for (std::size_t lag = 0; lag <= 2 * cut; ++lag)
        CHECK(found.correlation[lag] == Approx(correlation[lag] / correlation[0]).margin(1e-12));
    CHECK(judged(log, 50).arms.front().evidence.segments.correlation.empty());
}

TEST_CASE("segments: a log is judged as a record whose trials are its segments") {
    const DrawnRecord log = logs(1, 1000, 0.3);
    DrawnRecord parts = log;
    parts.trials = 50;
    parts.steps = 20;
    const Report by_segment = judged(log, 20), by_trial = judged(parts);
    const ArmReport &segments = by_segment.arms.front(), &trials = by_trial.arms.front();
    CHECK(segments.evidence.segments.count);
    CHECK(segments.evidence.units() == "segments");
    CHECK(!trials.evidence.segments.count);
    const auto same = [](const Moments& a, const Moments& b) {
        CHECK(a.count == b.count);
        CHECK(a.mean == b.mean);
        CHECK(a.standard_error == b.standard_error);
    };
    for (std::size_t g = 0; g < trials.evidence.groups.size(); ++g)
        same(segments.evidence.groups[g].run, trials.evidence.groups[g].run);
    for (std::size_t j = 0; j < trials.evidence.bias.size(); ++j)
        same(segments.evidence.bias[j].run, trials.evidence.bias[j].run);
    CHECK(segments.consistency.trials_needed.value == 0);  // no number of segments shows what is drawn once
    CHECK(trials.consistency.trials_needed.value > 0);
    CHECK(segments.evidence.nis.front().ratio95.low == trials.evidence.nis.front().ratio95.low);
    CHECK(segments.evidence.whiteness.front().scaled == trials.evidence.whiteness.front().scaled);
    for (const char* name : {"nees_ratio", "nis_ratio"}) {
        const auto summary_in = [&](const ArmReport& arm) {
            for (const ColumnReport& column : arm.columns)
                if (column.name == name) return column.summary;
            throw std::logic_error(name);
        };
        CAPTURE(name);
        // The column's NIS is the mean over the trials, that of segments the ratio of sums: the rows are as many here.
        CHECK(summary_in(segments).mean == Approx(summary_in(trials).mean).epsilon(1e-12));
        CHECK(summary_in(segments).ci95.low == Approx(summary_in(trials).ci95.low).epsilon(1e-9));
    }
}

TEST_CASE("segments: their number follows from the autocorrelation, the number of runs and what is asked") {
    const auto segments = [](const DrawnRecord& drawn, int asked = segments_auto) {
        return judged(drawn, asked).arms.front().evidence.segments;
    };
    const SegmentEvidence found = segments(logs(1, 4000, 0.5));
    CHECK(found.count);
    CHECK(found.autocorrelation_time == Approx(1.5).epsilon(0.35));
    const int ten_times = static_cast<int>(std::ceil(10 * found.autocorrelation_time));
    CHECK(found.steps == 4000 / (4000 / ten_times));
    CHECK(std::ssize(found.run) == 4000 / found.steps);
    CHECK(segments(logs(3, 500, 0), 30).run.size() == 3 * (500 / 30));
    CHECK(!segments(logs(1, 500, 0), 30).count);  // 16 are fewer than 20
    CHECK(!segments(logs(1, 4000, 0.5), segments_off).count);
    for (const int runs : {19, 20, 21}) {
        const SegmentEvidence several = segments(logs(runs, 100, 0));
        CHECK(several.count);
        CHECK(std::ssize(several.run) == runs * (100 / several.steps));
    }
    const SegmentEvidence two = segments(logs(40, 41, 0));  // two of ten times it leave steps over: these do not
    CHECK(two.steps == 20);
    CHECK(std::ceil(10 * two.autocorrelation_time) < 20);
    CHECK(two.run.size() == 80);
    CHECK(!segments(logs(20, 12, 0)).count);  // as many runs are trials
    CHECK(segments(logs(201, 100, 0)).run.empty());
    CHECK(segments(logs(20, 100, 0), 10).run.size() == 200);
    CHECK(!segments(logs(1, 200, 0.99)).count);
    const SegmentEvidence shorter = segments(logs(1, 300, 0.5));  // 20 of ten times the autocorrelation time are longer
    CHECK(shorter.count);
    CHECK(shorter.steps == 15);
}

TEST_CASE("segments: a long gap ends one, and those without half of their steps are left out") {
    DrawnRecord log = logs(1, 1000, 0);
    const auto hide = [&](int from, int to) {
        for (int k = from; k < to; ++k)
            for (int component = 0; component < 2; ++component) log.hide(0, k, component);
    };
    hide(30, 90);    // segments of 20 begin at 0 and 20, of which the second has 10 steps of 20; the next at 90
    hide(995, 1000); // the last 5 steps: from 90 on there are 45 segments, the last of which ends at 990
    const SegmentEvidence found = judged(log, 20).arms.front().evidence.segments;
    CHECK(found.steps_of_runs == 1000 - 60 - 5);
    CHECK(found.run.size() == 1 + 45);
    CHECK(found.count);
}

TEST_CASE("segments: a covariance that is too small or too large is found in one log, and a right one is not refuted") {
    for (const double factor : {0.5, 1.0, 2.0})
        for (const int runs : {1, 5}) {
            DrawnRecord log = logs(runs, 6000, 0.5);
            for (Eigen::MatrixXd& P : log.covariance) P *= factor;
            const Consistency found = verdict_on(log);
            CAPTURE(factor, runs, joined(found.reasons, "; "));
            const bool is_small = factor > 1 && runs == 5;  // of one run, they may have been drawn once
            CHECK(found.verdict == (factor < 1   ? Verdict::optimistic
                                    : is_small   ? Verdict::pessimistic
                                    : factor > 1 ? Verdict::undecided
                                    : runs == 5  ? Verdict::consistent
                                                 : Verdict::undecided));
            CHECK(found.findings.empty() ==
                  (found.verdict == Verdict::undecided || found.verdict == Verdict::consistent));
            const std::string too_large = "P is larger than the errors of this run: NEES/dim of all";
            CHECK((joined(found.reasons, "; ").find(too_large) != std::string::npos) == (factor > 1 && runs == 1));
        }
    const Report within = judged(logs(5, 12000, 0.3), segments_auto, 0.2);
    CAPTURE(joined(within.arms.front().consistency.reasons, "; "));
    CHECK(within.arms.front().consistency.verdict == Verdict::consistent);
}

TEST_CASE(
    "segments: an offset or a drift of a log is a note, hides no wrong P, and is found if it is beyond one draw") {
    const auto shifted = [](double sigmas, double drift, double factor) {
        DrawnRecord log = logs(1, 3000, 0.5);
        for (std::size_t k = 0; k < log.error.size(); ++k) {
            log.error[k](0) += sigmas + drift * (static_cast<double>(k) / 2999 - 0.5);
            log.covariance[k] *= factor;
        }
        return verdict_on(log);
    };
    const auto says = [](const std::vector<Finding>& findings, Subject about, double value) {
        return std::ranges::any_of(findings, [&](const Finding& finding) {
            return finding.about == about && finding.where == "x0" && std::abs(finding.value - value) < 0.3;
        });
    };
    CHECK(shifted(0, 0, 1).cautions.empty());
    for (const double sigmas : {0.3, 1.5}) {
        const Consistency once = shifted(sigmas, 0, 1);
        CAPTURE(sigmas);
        CHECK(once.verdict == Verdict::undecided);
        CHECK(says(once.cautions, Subject::offset, sigmas));
        CHECK_THAT(joined(once.reasons, "; "), Catch::Contains("seen once in each: 5 runs can tell"));
    }
    const Consistency drifts = shifted(0, 2, 1);
    CHECK(drifts.verdict == Verdict::undecided);
    CHECK(says(drifts.cautions, Subject::offset, 2));
    for (const double drift : {0.0, 2.0}) CHECK(shifted(1.5, drift, 0.7).verdict == Verdict::optimistic);
    // Errors with an offset are no smaller than P says, whatever those about their mean are.
    CHECK_THAT(joined(shifted(1.5, 0, 2).reasons, "; "), !Catch::Contains("this run: NEES/dim of all"));
    const Consistency beyond = shifted(6, 0, 1);
    CHECK(beyond.verdict == Verdict::optimistic);
    CHECK(says(beyond.findings, Subject::bias, 6));
}

TEST_CASE("segments: runs that differ, and segments that are alike, withhold the verdict") {
    constexpr double wide = 0.3;
    const auto reasons = [&](const DrawnRecord& drawn, int asked) {
        return joined(judged(drawn, asked, Limits(wide)).arms.front().consistency.reasons, "; ");
    };
    for (const int runs : {4, 6}) {
        DrawnRecord several = logs(runs, 8000, 0.2);
        CHECK(judged(several, 50, Limits(wide)).arms.front().evidence.segments.count);
        for (int run = 0; run < runs; ++run)
            for (int k = 0; k < 8000; ++k) several.error[several.at(run, k)] *= run % 2 == 0 ? 1.05 : 0.95;
        CHECK(!judged(several, 50, Limits(wide)).arms.front().evidence.segments.count);
        CHECK_THAT(reasons(several, 50),
                   Catch::Contains("the runs differ among each other, so that each counts as one: NEES of all"));
    }
    CHECK_THAT(reasons(logs(1, 20000, 0.95), 10), Catch::Contains("segments of 10 steps are not independent"));
}

TEST_CASE("segments: too few to count, of one log or of two, find a covariance that is far too small") {
    for (const int runs : {1, 2}) {
        DrawnRecord few = logs(runs, 60 / runs, 0.5);
        const Consistency right = verdict_on(few);
        CAPTURE(runs);
        CHECK(right.verdict == Verdict::undecided);
        CHECK_THAT(joined(right.reasons, "; "), Catch::Contains("independent runs: 20 are needed, some"));
        for (Eigen::VectorXd& error : few.error) error(0) += 0.8;  // drawn once
        for (Eigen::MatrixXd& P : few.covariance) P *= 0.2;
        CHECK(verdict_on(few).verdict == Verdict::optimistic);
    }
}

TEST_CASE("segments: a short log decides nothing but what no correlation explains, and says what it is worth") {
    const Report report = judged(logs(1, 60, 0.5));
    CHECK(report.arms.front().consistency.verdict == Verdict::undecided);
    CHECK_THAT(report_html(judged(logs(1, 1000, 0.5), 25), {"log.h5", {}, ""}),
               Catch::Contains("credence judge log.h5 --margin 0.05 --segments 25 --format html"));
    CHECK_THAT(report_text(report), Catch::Contains("one log of 60 steps, worth about") &&
                                        Catch::Contains("independent runs: 20 are needed, some"));
    DrawnRecord wrong = logs(1, 60, 0.5);
    for (Eigen::MatrixXd& P : wrong.covariance) P *= 0.05;
    const Consistency found = verdict_on(wrong);
    CHECK(found.verdict == Verdict::optimistic);
    CHECK(found.findings.front().interval.low > 1.05);
    for (Eigen::MatrixXd& P : wrong.covariance) P *= 20 * 3000;
    CHECK(verdict_on(wrong).verdict == Verdict::pessimistic);
}

}  // namespace credence::test::segments_test
