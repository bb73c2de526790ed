// What rounding does to the NEES of a record whose covariances are conditioned from 1 to 10^20, beside 50 digits: it
// stays within the bound that the report gives, or the report says that rounding hides it.

#include "catch.hpp"
#include "fifty_digits.hpp"
#include "record_support.hpp"

#include "numeric/decompositions.hpp"
#include "record/step.hpp"

#include <credence/report.hpp>

namespace credence::test::fifty_digits_long_test {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

RecordShape shape_of(int n) {
    RecordShape shape;
    shape.trials = shape.steps = 1;
    shape.n = n;
    shape.groups = {{"all", 0, n}};
    shape.covariance_epsilon = epsilon;
    return shape;
}

/// A covariance, the same rounded to doubles, and an error of it. The components have units of their own.
struct Conditioned {
    FiftyMatrix exact;
    CheckedStep step;

    Conditioned(std::mt19937_64& random, int n, double condition) : exact(conditioned(random, n, condition)) {
        std::uniform_int_distribution<int> exponent(-20, 20);
        for (int i = 0; i < n; ++i) {
            const Fifty unit = ldexp(Fifty(1), exponent(random));
            exact.row(i) *= unit;
            exact.col(i) *= unit;
        }
        step.P = exact.cast<double>();
        step.P = step.P.selfadjointView<Eigen::Lower>();
        step.e = (lower_factor(exact) * drawn_normal(random, n, 1)).cast<double>();
    }
};

/// What became of the steps of one condition.
struct Seen {
    int given = 0, bounded = 0, refused = 0;
    double worst = 0;  ///< error of NEES as a share of its bound, where the bound says something
};

Seen evaluate(std::mt19937_64& random, int n, double condition) {
    Seen seen;
    const RecordShape shape = shape_of(n);
    const StateSeries all_series = record_series(shape);
    StepEvaluator evaluator(shape, all_series);
    std::vector<double> values(all_series.list.size());
    for (int i = 0; i < 10; ++i) {
        const Conditioned drawn(random, n, condition);
        const double bound = rounding_bound(drawn.step.P, epsilon);
        CAPTURE(n, condition, i, bound);
        if (!evaluator.evaluate(drawn.step, values.data(), nullptr).empty()) {
            CHECK(bound > 0.1);  // no step is refused that doubles can evaluate
            ++seen.refused;
            continue;
        }
        ++seen.given;
        const Fifty exact = squared_error(drawn.exact, drawn.step.e.cast<Fifty>());
        const double error = std::abs(static_cast<double>((Fifty(values[0]) - exact) / exact));
        if (bound > 0.1) continue;  // first-order, it is the bound of small errors; the report leaves this NEES out
        CHECK(error <= bound);
        seen.worst = std::max(seen.worst, error / bound);
        ++seen.bounded;
    }
    return seen;
}

}  // namespace

TEST_CASE("fifty digits: NEES errs by no more than the bound, up to conditions at which a step is refused") {
    std::mt19937_64 random(1);
    double worst = 0;
    int refused = 0, hidden = 0;
    for (const int n : {2, 4, 7})
        for (int exponent = 0; exponent <= 20; ++exponent) {
            const Seen seen = evaluate(random, n, std::pow(10, exponent));
            worst = std::max(worst, seen.worst);
            refused += seen.refused;
            hidden += seen.given - seen.bounded;
            INFO("n = " << n << ", condition 1e" << exponent);
            if (exponent <= 10) CHECK(seen.bounded == 10);
            if (exponent >= 18) CHECK(seen.bounded == 0);
            if (exponent >= 18 && n > 2) CHECK(seen.refused == 10);  // axes of a plane may come out nearly upright
        }
    CHECK(worst > 0.01);  // the bound is one for the worst of all errors, and these are drawn
    CHECK(refused > 0);
    CHECK(hidden > 0);
}

TEST_CASE(
    "fifty digits: a record of steps ill-conditioned along axes of their own is not judged by what rounding made") {
    constexpr int n = 4, trials = 150;
    for (const int exponent : {9, 12, 14, 15}) {
        std::mt19937_64 random(3);
        DrawnRecord record(trials, 2, n);
        Fifty exact = 0;
        for (std::size_t i = 0; i < record.error.size(); ++i) {
            const Conditioned drawn(random, n, std::pow(10, exponent));
            record.covariance[i] = drawn.step.P;
            record.error[i] = drawn.step.e;
            exact += squared_error(drawn.exact, drawn.step.e.cast<Fifty>()) / (n * 2 * trials);
        }
        const TemporaryFolder folder;
        const std::string path = folder / "x.h5";
        write_file(path, [&](const Handle& root) { write_drawn(root, record); });
        const ArmReport arm = make_record_report(read_record(path), path, {}).arms.front();
        const GroupEvidence& all = arm.evidence.groups.front();
        CAPTURE(exponent, all.rounding, all.run.mean);
        CHECK(arm.failed == 0);
        CHECK(arm.consistency.findings.empty());
        // The mean of all covariances is well conditioned and hides that none is.
        CHECK(all.rounding > 1e-17 * std::pow(10, exponent));
        const bool left_out = exponent >= 14;
        CHECK(std::isnan(all.run.mean) == left_out);
        CHECK((arm.consistency.reasons.front().find("conditioning: NEES of all is left out") == 0) == left_out);
        if (!left_out) CHECK(std::abs(all.run.mean / static_cast<double>(exact) - 1) <= all.rounding);
    }
}

}  // namespace credence::test::fifty_digits_long_test
