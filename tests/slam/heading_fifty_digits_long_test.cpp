// What rounding leaves of the extended Kalman filter of the heading model, of its P, mean, NIS and NEES, step after
// step, as the conditions of P and S grow to 10^20, beside the joint equations in 50 digits [docs/model.md, Filter].

#include "catch.hpp"
#include "fifty_digits_filter.hpp"

#include "slam/estimators/estimator.hpp"
#include "numeric/decompositions.hpp"

namespace credence::test::heading_fifty_digits_long_test {

namespace {

using Heading = Layout<Process::heading, 3>;
constexpr int n = 9, rows = 12, steps = 6;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Errors of the filter in doubles after a step; infinite where the exact P, of which doubles gave the start, is not
/// positive definite.
struct Errors {
    double P = infinity;     ///< |L^-1 (P^ - P) L'^-1|
    double mean = infinity;  ///< |L^-1 (x^ - x)|: in standard deviations
    double nis = infinity, nees = infinity;  ///< relative
    double allowed = infinity;  ///< that of P, by the conditions of the steps so far
    double reported = 0;        ///< the report's bound on the rounding of NEES
};

/// The filter in doubles and that in 50 digits, from one belief.
class Chain {
public:
    Chain(const ProblemView& view, const VectorXd& x, const MatrixXd& P, std::mt19937_64& random)
        : view_(view), random_(random), belief_(belief_of<Heading>(x, P)),
          exact_{view.filter, x.cast<Fifty>(), P.cast<Fifty>(), {}, {}, {}} {}

    /// Goes on to pose k.
    Errors step(int k) {
        const Command<double> command{0.3, {0.9, 0.2}};
        filter_.predict(belief_, view_.filter, Heading(3), command, {}, k);
        exact_.predict(command, k);
        const double prior = largest_eigenvalue(exact_.P);
        const Measured measured = measure();
        exact_.update(measured);
        filter_.update(belief_, view_.filter, Heading(3), measured.sightings.data(),
                       [&](int e) { return measured.edges[static_cast<std::size_t>(e)]; },
                       AtMean<Heading, double>(belief_.mean), update_);
        if (exact_.P.llt().info() != Eigen::Success) return {.reported = rounding_bound(dense(belief_, n), epsilon)};
        // Each row changes P by n products that are rounded, and P is a difference of numbers as large as the largest
        // of P^-. Errors of earlier steps do not grow in units of P.
        allowed_ += rows * n * epsilon * prior * largest_of_inverse(exact_.P);
        return errors();
    }

private:
    /// Measurements that the exact filter finds likely: innovations drawn with its S.
    Measured measure() {
        Measured measured;
        measured.sightings.assign(3, {true, {}, view_.sensor.sigma});
        exact_.linearise(measured.sightings);
        const FiftyVector z = exact_.expected + lower_factor(exact_.S) * drawn_normal(random_, rows, 1);
        for (int row = 0; row < rows; row += 2) {
            const Vector2<double> pair{static_cast<double>(z[row]), static_cast<double>(z[row + 1])};
            if (row < 6)
                measured.sightings[static_cast<std::size_t>(row / 2)].z = pair;
            else
                measured.edges.push_back(pair);
        }
        return measured;
    }

    Errors errors() {
        const MatrixXd P = dense(belief_, n);
        const FiftyMatrix L = lower_factor(exact_.P);
        const FiftyVector moved = mean_of(belief_, n).cast<Fifty>() - exact_.mean;
        const VectorXd truth = (exact_.mean + L * drawn_normal(random_, n, 1)).cast<double>();
        const auto nees = static_cast<double>(squared_error(exact_.P, exact_.mean - truth.cast<Fifty>()));
        return {relative_error(P, exact_.P),
                static_cast<double>(L.triangularView<Eigen::Lower>().solve(moved).norm()),
                relative(update_.nis, static_cast<double>(exact_.nis)),
                relative(nees_about(truth), nees),
                allowed_,
                rounding_bound(P, epsilon)};
    }

    double nees_about(const VectorXd& truth) {
        double error[n], nees = 0;
        for (int i = 0; i < n; ++i) error[i] = belief_.mean[i] - truth[i];
        nested_squared_errors<false>(belief_.covariance, error, zero, Known<n>{}, work_,
                                     [&](auto, const SquaredError<double>& sum) { nees = sum.value; });
        return nees;
    }

    const ProblemView& view_;
    std::mt19937_64& random_;
    KalmanFilter<Heading, double> filter_;
    Belief<double, Heading::capacity> belief_;
    FiftyFilter exact_;
    Update<double, Heading::capacity> update_;
    Elimination<double, Heading::capacity> work_;
    double allowed_ = 0;
};

/// Runs `check(errors)` after each step from five beliefs of each condition from 1 to 10^20; noises of the size of the
/// smallest eigenvalue keep them as they are.
template <class Draw, class Check>
void each_condition(const Draw& draw, const Check& check) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> place(-2, 2);
    for (int exponent = 0; exponent <= 20; ++exponent) {
        const double condition = std::pow(10, exponent);
        const Problem problem(all_noises("heading", std::sqrt(1 / condition)));
        for (int i = 0; i < 5; ++i) {
            const VectorXd x = VectorXd::NullaryExpr(n, [&] { return place(random); });
            Chain chain(problem.view(), x, rounded(draw(random, condition)), random);
            for (int k = 1; k <= steps; ++k) {
                CAPTURE(exponent, i, k);
                check(chain.step(k));
            }
        }
    }
}

}  // namespace

TEST_CASE("fifty digits: steps of the heading filter lose what the conditions take, and no more") {
    int compared = 0;
    double closest = 0;
    const auto any = [](std::mt19937_64& random, double condition) { return conditioned(random, n, condition); };
    each_condition(any, [&](const Errors& errors) {
        CAPTURE(errors.P, errors.mean, errors.nis, errors.allowed);
        if (!(errors.allowed < 1)) return;  // the bound is one of small errors
        CHECK(errors.P <= errors.allowed);
        CHECK(errors.mean <= errors.allowed);
        CHECK(errors.nis <= errors.allowed);
        closest = std::max(closest, errors.P / errors.allowed);
        ++compared;
    });
    CHECK(compared > 300);
    CHECK(closest > 0.001);  // or the bound would say little
}

TEST_CASE("fifty digits: what steps of the heading filter spoil of NEES and NIS is within the bound of the report") {
    int spoilt = 0, exact = 0;
    const auto together = [](auto& random, double condition) { return known_together(random, n, 1, condition); };
    each_condition(together, [&](const Errors& errors) {
        CAPTURE(errors.P, errors.nees, errors.nis, errors.reported);
        const double greatest = std::max({errors.P, errors.nees, errors.nis});
        if (errors.reported < 0.1) CHECK(greatest <= errors.reported);
        // A tenth of the usual margin: where fewer digits are left, the report leaves NEES out and says why.
        const double enough = rounding_share * 0.05;
        if (greatest > enough) CHECK(errors.reported > enough);
        ++(greatest > enough ? spoilt : exact);
    });
    CHECK(spoilt > 150);
    CHECK(exact > 300);
}

TEST_CASE("fifty digits: a sighting tells a lost heading, and loses what the condition takes, and no more") {
    const auto lost = [](auto& random, double condition) {
        FiftyMatrix P = conditioned(random, n, 10) / Fifty(condition);
        P(0, 0) += 1;
        return P;
    };
    int compared = 0;
    each_condition(lost, [&](const Errors& errors) {
        CAPTURE(errors.P, errors.mean, errors.nis, errors.allowed);
        if (!(errors.allowed < 1)) return;
        CHECK(errors.P <= errors.allowed);
        CHECK(errors.mean <= errors.allowed);
        CHECK(errors.nis <= errors.allowed);
        ++compared;
    });
    CHECK(compared > 300);
}

}  // namespace credence::test::heading_fifty_digits_long_test
