// What rounding leaves of one step of the filter, prediction and update, as the conditions of P and S grow to 10^20,
// beside the joint equations in 50 digits [docs/model.md, Filter].

#include "catch.hpp"
#include "fifty_digits_filter.hpp"

#include "slam/update.hpp"
#include "numeric/decompositions.hpp"

namespace credence::test::update_fifty_digits_long_test {

namespace {

using Linear = Layout<Process::translation, any_count>;  // which computes both axes, of any P
constexpr int n = 8, rows = 12;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// The translation model, three features, all edges; H has entries -1, 0 and 1, and no digit is lost in it.
FiftyMatrix joint_rows() {
    FiftyMatrix H = FiftyMatrix::Zero(rows, n);
    const auto pair = [&](int row, int minus, int plus) {
        for (int axis = 0; axis < 2; ++axis) H(row + axis, minus + axis) = -1, H(row + axis, plus + axis) = 1;
    };
    for (int j = 0; j < 3; ++j) pair(2 * j, 0, 2 + 2 * j);
    pair(6, 2, 4), pair(8, 2, 6), pair(10, 4, 6);
    return H;
}

/// Covariance after a step from P [n, n].
struct Step {
    MatrixXd left;
    FiftyMatrix prior, exact;

    Step(const Problem& problem, const MatrixXd& P) {
        const ProblemView& view = problem.view();
        auto belief = belief_of<Linear>(VectorXd::Zero(n), P);
        predict_robot(belief, view.filter, Linear(3), {});
        predict_features(belief, view.filter, Linear(3), 1);
        const double sigma = view.sensor.sigma;
        const Sighting<double> sightings[]{{true, {1, 0}, sigma}, {true, {0, 1}, sigma}, {true, {1, 1}, sigma}};
        Update<double, Linear::capacity> update;
        update_belief(belief, view.filter, Linear(3), sightings, [](int) { return Vector2<double>{}; },
                      AtMean<Linear, double>(belief.mean), update);
        left = dense(belief, n);
        prior = P.cast<Fifty>();
        for (int i = 0; i < n; ++i) prior(i, i) += i < 2 ? view.filter.variance_odometry : view.filter.variance_feature;
        FiftyVector N = FiftyVector::Constant(rows, view.filter.variance_edge);
        N.head(6).setConstant(believed_variance(view.filter, sigma));
        const FiftyMatrix H = joint_rows(), W = prior * H.transpose();
        FiftyMatrix S = H * W;
        S.diagonal() += N;
        exact = prior - W * S.llt().solve(FiftyMatrix(W.transpose()));
    }

    double error() const { return relative_error(left, exact); }
    double bound() const { return rounding_bound(left, epsilon); }
    /// |P^-| |P^-1|: P is a difference of numbers as large as the largest of P^-.
    double condition() const { return largest_eigenvalue(prior) * largest_of_inverse(exact); }
};

/// Runs `check(step)` on five beliefs of each condition from 1 to 10^20; noises of the size of the smallest eigenvalue
/// keep them as they are.
template <class Draw, class Check>
void each_condition(const Draw& draw, const Check& check) {
    std::mt19937_64 random(2);
    for (int exponent = 0; exponent <= 20; ++exponent) {
        const double condition = std::pow(10, exponent);
        const Problem problem(all_noises("translation", std::sqrt(1 / condition)));
        for (int i = 0; i < 5; ++i) {
            CAPTURE(exponent, i);
            check(Step(problem, rounded(draw(random, condition))));
        }
    }
}

}  // namespace

TEST_CASE("fifty digits: a step of the filter loses what the condition takes, and no more") {
    double closest = 0;
    const auto any = [](std::mt19937_64& random, double condition) { return conditioned(random, n, condition); };
    each_condition(any, [&](const Step& step) {
        // Each row changes P by n products that are rounded, and errors of the rows hardly add. The bound is one of
        // small errors.
        const double error = step.error(), bound = n * epsilon * step.condition();
        CAPTURE(error, bound);
        if (bound > 1) return;
        CHECK(error <= bound);
        closest = std::max(closest, error / bound);
    });
    CHECK(closest > 0.03);
}

TEST_CASE("fifty digits: what a step spoils of an ill-conditioned P is within the bound on the rounding of NEES") {
    int spoilt = 0, exact = 0;
    const auto together = [](auto& random, double condition) { return known_together(random, n, 0, condition); };
    each_condition(together, [&](const Step& step) {
        const double error = step.error(), bound = step.bound();
        CAPTURE(error, bound);
        if (bound < 0.1) CHECK(error <= bound);
        // A tenth of the usual margin: where fewer digits are left, the report leaves NEES out and says why.
        const double enough = rounding_share * 0.05;
        if (error > enough) CHECK(bound > enough);
        ++(error > enough ? spoilt : exact);
    });
    CHECK(spoilt > 30);
    CHECK(exact > 60);
}

}  // namespace credence::test::update_fifty_digits_long_test
