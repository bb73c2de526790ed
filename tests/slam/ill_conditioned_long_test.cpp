// What rounding does to trials whose P and S are ill-conditioned, with every estimator: NEES, the gate and failures in
// doubles beside the same code in 50 digits, which has the same draws.

#include "catch.hpp"
#include "fifty_digits.hpp"
#include "support.hpp"

#include "slam/estimators/estimators.hpp"
#include "slam/trial/workspace.hpp"
#include "slam/planning/controller.hpp"
#include "slam/update.hpp"
#include "numeric/decompositions.hpp"

#include <boost/math/constants/constants.hpp>

#define CALL [[gnu::noinline]]
namespace credence {
inline namespace CREDENCE_TARGET {

/// A scalar of the filters' equations with 50 decimal digits. Its functions are calls: where the equations ask for all
/// of them to be inlined, the compiler would take minutes.
struct FiftyReal {
    test::Fifty value = 0;

    CALL FiftyReal() {}
    CALL FiftyReal(double x) : value(x) {}
    CALL FiftyReal(const test::Fifty& x) : value(x) {}
    CALL FiftyReal(const FiftyReal& x) : value(x.value) {}
    CALL FiftyReal& operator=(const FiftyReal& x) { return value = x.value, *this; }
    explicit operator double() const { return static_cast<double>(value); }

    CALL friend FiftyReal operator+(const FiftyReal& a, const FiftyReal& b) { return test::Fifty(a.value + b.value); }
    CALL friend FiftyReal operator-(const FiftyReal& a, const FiftyReal& b) { return test::Fifty(a.value - b.value); }
    CALL friend FiftyReal operator*(const FiftyReal& a, const FiftyReal& b) { return test::Fifty(a.value * b.value); }
    CALL friend FiftyReal operator/(const FiftyReal& a, const FiftyReal& b) { return test::Fifty(a.value / b.value); }
    CALL friend FiftyReal operator-(const FiftyReal& a) { return test::Fifty(-a.value); }
    CALL friend bool operator<(const FiftyReal& a, const FiftyReal& b) { return a.value < b.value; }
    CALL friend bool operator<=(const FiftyReal& a, const FiftyReal& b) { return a.value <= b.value; }
    CALL friend bool operator>(const FiftyReal& a, const FiftyReal& b) { return a.value > b.value; }
    CALL friend bool operator>=(const FiftyReal& a, const FiftyReal& b) { return a.value >= b.value; }
    CALL friend bool operator==(const FiftyReal& a, const FiftyReal& b) { return a.value == b.value; }

    CALL friend FiftyReal fma(const FiftyReal& a, const FiftyReal& b, const FiftyReal& c) { return a * b + c; }
    CALL friend FiftyReal fnma(const FiftyReal& a, const FiftyReal& b, const FiftyReal& c) { return c - a * b; }
    CALL friend FiftyReal sqrt(const FiftyReal& x) { return test::Fifty(boost::multiprecision::sqrt(x.value)); }
    CALL friend FiftyReal absolute(const FiftyReal& x) { return x.value < 0 ? -x : x; }
    CALL friend FiftyReal select(bool mask, const FiftyReal& yes, const FiftyReal& no) { return mask ? yes : no; }
    CALL friend bool within(const FiftyReal& x, const FiftyReal& low, const FiftyReal& high) {
        return low <= x && x <= high;
    }
    CALL friend Rotation<FiftyReal> rotation(const FiftyReal& angle) {
        return {test::Fifty(boost::multiprecision::cos(angle.value)),
                test::Fifty(boost::multiprecision::sin(angle.value))};
    }
    CALL friend Rotation<FiftyReal> rotation_of_turns(const FiftyReal& turns) {
        return rotation(FiftyReal(boost::math::constants::two_pi<test::Fifty>()) * turns);
    }
    CALL friend FiftyReal wrapped(const FiftyReal& angle) {
        const Rotation<FiftyReal> turned = rotation(angle);
        return test::Fifty(boost::multiprecision::atan2(turned.sine.value, turned.cosine.value));
    }
};

/// A product needs no exponent of its own where the type has room for it.
template <>
class ScaledProduct<FiftyReal> {
public:
    CALL ScaledProduct() {}
    CALL explicit ScaledProduct(const FiftyReal& number) : product_(number) {}
    CALL void multiply(const FiftyReal& number) { product_ = product_ * number; }
    CALL void multiply(const ScaledProduct& by) { product_ = product_ * by.product_; }
    CALL FiftyReal log() const { return test::Fifty(boost::multiprecision::log(product_.value)); }

private:
    FiftyReal product_ = 1;
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
#undef CALL

namespace credence::test::ill_conditioned_long_test {

using Eigen::MatrixXd;

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr int features = 3;
constexpr int scenarios = 500;  ///< of each estimator

/// Draws in doubles for any scalar.
template <class Real>
struct NoiseOf {
    const AnyNoise& doubles;

    Vector2<Real> normal(Source source, int pose, int index) const {
        const Vector2<double> draw = doubles.normal(source, pose, index);
        return {Real(draw.x), Real(draw.y)};
    }
    Real uniform(Source source, int pose, int index) const { return Real(doubles.uniform(source, pose, index)); }
};

template <class Matrix, class Real, int capacity>
Matrix matrix_of(const Belief<Real, capacity>& belief, int n) {
    return Matrix::NullaryExpr(n, n, [&](Eigen::Index i, Eigen::Index j) {
        const Real& entry = belief.covariance.at(static_cast<int>(i), static_cast<int>(j));
        if constexpr (std::is_same_v<Real, double>)
            return entry;
        else
            return entry.value;
    });
}

/// One trial on the fixed path, step by step, as run_trial has it.
template <class Of, class Real, template <class, class> class Estimating>
struct Trial {
    using Matrix = std::conditional_t<std::is_same_v<Real, double>, MatrixXd, FiftyMatrix>;
    const ProblemView& view;
    NoiseOf<Real> noise;
    Of layout{features};
    CommonWorkspace<Of, Real, Estimating<Of, Real>> work;
    StepEvaluation<Of, Real> evaluation;
    Real error[Of::capacity];
    std::vector<bool> seen;
    Matrix predicted;  ///< P^-

    Trial(const ProblemView& of, const AnyNoise& doubles) : view(of), noise{doubles} {
        WorldDraws<Of, Real> draws(layout);
        draws.draw(noise, 0);
        start_truth(work.truth, view.world, layout, draws, noise);
        look_first(work.truth, view.sensor, layout.features(), draws.template of_features<Source::measurement>(),
                   work.sightings);
        start_belief(work.belief, view.filter, layout, work.sightings);
        work.estimator.start(layout, work.belief, work.truth);
    }

    void step(int k) {
        WorldDraws<Of, Real> draws(layout);
        const Command<Real> command = command_from<Real>(view.control.fixed[k - 1]);
        draws.draw(noise, k);
        move_features(work.truth, view.world, layout, k, draws);
        move_robot(work.truth, view.world, command, draws);
        work.estimator.predict(work.belief, view.filter, layout, command, work.truth, k);
        look(work.truth, view.sensor, layout, k, draws.template of_features<Source::measurement>(), noise,
             work.sightings);
        const auto linearised = work.estimator.linearised(work.belief, layout, work.truth);
        gate_sightings(work.belief, view.filter, layout, linearised, work.sightings);
        seen.assign(features, false);
        for (std::size_t j = 0; j < features; ++j) seen[j] = work.sightings[j].seen;
        predicted = P();
        const auto edge = [&](int e) {
            return measure_edge(work.truth, view.sensor, view.filter.edges[e], k, e, noise);
        };
        work.estimator.update(work.belief, view.filter, layout, work.sightings, edge, linearised, work.update);
        estimation_error(work.belief, work.truth, layout, error);
        evaluate_groups(work.belief, layout, error, work.elimination, evaluation);
    }

    Matrix P() const { return matrix_of<Matrix>(work.belief, layout.size()); }
};

struct Range {
    int first, last, group;
};

/// The groups, as ranges of components.
template <class Of>
std::vector<Range> groups_of() {
    const int n = Of::pose_size + 2 * features;
    std::vector<Range> groups{{0, n, Of::group_all}, {0, Of::pose_size, Of::group_pose},
                              {Of::pose_size, n, Of::group_features}};
    if (Of::has_heading) {
        groups.push_back({Of::heading, 1, Of::group_heading});
        groups.push_back({Of::position, Of::pose_size, Of::group_position});
    }
    for (int j = 0; j < features; ++j) groups.push_back({Of::feature(j), Of::feature(j) + 2, Of::group_feature(j)});
    return groups;
}

/// Scenarios whose noises are of any size between what doubles hardly tell and the distances of the world.
DeformableSettings drawn_scenario(std::mt19937_64& random, Process process) {
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto power = [&](double low, double high) { return to_text(std::pow(10, between(low, high))); };
    const auto one_of = [&](std::vector<const char*> list) { return list[random() % list.size()]; };
    std::string positions;
    for (int j = 0; j < features; ++j) {
        const double range = std::pow(10, between(-0.3, 1.5)), angle = between(-M_PI, M_PI);
        positions += (j > 0 ? ", " : "") + to_text(range * std::cos(angle)) + " " + to_text(range * std::sin(angle));
    }
    Settings settings{{"scenario.poses", "4"}, {"features.path", one_of({"static", "circle"})},
                      {"features.positions", positions}, {"sensor.range_min", "0"}, {"sensor.range_max", "inf"},
                      {"sensor.sigma", power(-10, -1)}, {"noise.odometry", power(-8, 0)},
                      {"noise.walk", power(-8, -0.5)}, {"noise.deformation", power(-8, -0.5)},
                      {"noise.initial_position", one_of({"0", "1e-3", "10"})},
                      {"edges.graph", one_of({"none", "chain", "all"})}, {"truth.deformation", "walk"},
                      {"truth.edge_noise", "independent"}, {"filter.gate", one_of({"1", "0.99", "0.9"})}};
    if (process == Process::heading) {
        settings.emplace_back("noise.heading", power(-8, 0));
        settings.emplace_back("noise.initial_heading", one_of({"0", "1e-3", "0.3"}));
    } else {
        settings.emplace_back("model.process", "translation");
    }
    return scenario_with(settings);
}

/// Runs `count` scenarios with one estimator. Of each step three things are bounded [docs/theory/statistics.md,
/// Conditioning]: what the rounding of P and e makes of NEES (rounding_bound), what each update so far has lost of P
/// (the rows times n epsilon times the largest factor by which it reduces a variance), and the spacing of the state's
/// numbers beside its smallest standard deviation. Where they add up to less than a tenth of the margin, the number
/// must be as exact.
template <Process process, template <class, class> class Estimating>
void compare_with_fifty_digits(int count) {
    using Of = Layout<process, features>;
    using Slow = Layout<process, any_count>;  // rolled loops: no compiler unrolls 50 digits in reasonable time
    const double enough = rounding_share * 0.05;
    const auto stored = std::make_unique<Belief<FiftyReal, Slow::capacity>>();
    const auto work = std::make_unique<Elimination<FiftyReal, Slow::capacity>>();
    std::mt19937_64 random(7);
    int known = 0, unknown = 0, failed = 0, rejected = 0, apart = 0;
    for (int i = 0; i < count; ++i) {
        const DeformableSettings scenario = drawn_scenario(random, process);
        const Problem problem(scenario);
        const AnyNoise noise = keyed_noise(scenario, 3, static_cast<std::uint64_t>(i));
        const auto ours = std::make_unique<Trial<Of, double, Estimating>>(problem.view(), noise);
        const auto exact = std::make_unique<Trial<Slow, FiftyReal, Estimating>>(problem.view(), noise);
        double lost = 0, most = 0;  ///< of P; of NEES
        for (int k = 1; k < scenario.poses; ++k) {
            CAPTURE(i, k);
            ours->step(k);
            exact->step(k);
            if (ours->seen != exact->seen) {
                // The sightings are gated about a prediction that rounding has changed, or that is wrong by thousands
                // of sigma and a number of its last digits.
                CHECK((lost > enough || most > 1e6));
                ++apart;
                break;
            }
            rejected += static_cast<int>(std::count(exact->seen.begin(), exact->seen.end(), false));
            const MatrixXd P = ours->P();
            const int n = static_cast<int>(P.rows());
            const FiftyMatrix exact_P = exact->P();
            // |L^-1 P^- L'^-1|, P = L L'
            const double reduced = 1 + relative_error(exact->predicted.template cast<double>(), exact_P);
            lost += (2 * features + 2 * problem.view().filter.edge_count) * n * epsilon * reduced;
            double reach = 1;
            for (int c = 0; c < n; ++c) reach = std::max(reach, std::abs(ours->work.belief.mean[c]));
            const double bound = lost + 8 * epsilon * reach * std::sqrt(largest_of_inverse(exact_P));
            if (!ours->evaluation.positive_definite) {
                CHECK(bound + rounding_bound(exact_P.template cast<double>(), epsilon) > enough);
                ++failed;
                break;
            }
            FiftyReal error[Slow::capacity];
            for (int c = 0; c < n; ++c) {
                error[c] = ours->error[c];
                for (int d = c; d < n; ++d) stored->covariance.entry[c][d] = P(c, d);
            }
            StepEvaluation<Slow, FiftyReal> of_stored;
            evaluate_groups(*stored, exact->layout, error, *work, of_stored);
            for (const Range& range : groups_of<Of>()) {
                const int size = range.last - range.first;
                const double rounding = rounding_bound(P.block(range.first, range.first, size, size), epsilon);
                const double nees = ours->evaluation.nees[range.group],
                             nees_of_stored = static_cast<double>(of_stored.nees[range.group]),
                             nees_exact = static_cast<double>(exact->evaluation.nees[range.group]);
                CAPTURE(range.group, nees, nees_of_stored, nees_exact, rounding, bound);
                // e'P^-1e alone, of the P and e that there are. Of one component it is (e/sqrt(P))^2: three roundings.
                if (rounding < enough) CHECK(std::abs(nees / nees_of_stored - 1) <= 3 * rounding);
                most = std::max(most, nees_exact);
                // A filter that is lost by 1,000 sigma is wrong anyhow, and its linearisation enlarges what is rounded.
                if (nees_exact > 1e6 || rounding + bound > enough) {
                    ++unknown;
                    continue;
                }
                CHECK(std::abs(nees / nees_exact - 1) <= enough);
                ++known;
            }
        }
    }
    CAPTURE(known, unknown, failed, rejected, apart);
    CHECK(known > 10 * count);
    CHECK(unknown > count);
    CHECK(failed > count / 100);
    CHECK(rejected > count / 100);
    CHECK(apart <= count / 100);
}

}  // namespace

TEST_CASE("fifty digits: NEES, the gate and failures of ill-conditioned trials, ekf") {
    compare_with_fifty_digits<Process::heading, KalmanFilter>(scenarios);
}

TEST_CASE("fifty digits: NEES, the gate and failures of ill-conditioned trials, iekf") {
    compare_with_fifty_digits<Process::heading, IteratedFilter>(scenarios);
}

TEST_CASE("fifty digits: NEES, the gate and failures of ill-conditioned trials, fej") {
    compare_with_fifty_digits<Process::heading, FirstEstimatesFilter>(scenarios);
}

TEST_CASE("fifty digits: NEES, the gate and failures of ill-conditioned trials, riekf") {
    compare_with_fifty_digits<Process::heading, RightInvariantFilter>(scenarios);
}

TEST_CASE("fifty digits: NEES, the gate and failures of ill-conditioned trials, ideal") {
    compare_with_fifty_digits<Process::heading, IdealFilter>(scenarios);
}

TEST_CASE("fifty digits: NEES, the gate and failures of ill-conditioned trials, kf") {
    compare_with_fifty_digits<Process::translation, KalmanFilter>(scenarios);
}

}  // namespace credence::test::ill_conditioned_long_test
