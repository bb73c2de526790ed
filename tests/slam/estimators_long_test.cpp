// The estimators beside the Kalman filter: against their papers' own forms, against each other where they must
// be the same, and what each makes of a heading that nothing observes.

#include "slam/estimators/estimators.hpp"

#include "catch.hpp"
#include "filter_samples.hpp"
#include "oracle/estimators.hpp"

namespace credence::test::estimators_long_test {

namespace {

const std::vector<Estimator> others{Estimator::ideal, Estimator::fej, Estimator::riekf, Estimator::iekf};

using AnyHeading = Layout<Process::heading, any_count>;

/// Greatest differences over a trial, over the norm of the second.
double mean_difference(const Run& a, const std::vector<oracle::Estimate>& b) {
    double greatest = 0;
    for (std::size_t k = 0; k < a.steps.size(); ++k)
        greatest = std::max(greatest, (a.steps[k].mean - b[k].mean).norm() / (1 + b[k].mean.norm()));
    return greatest;
}

double covariance_difference(const Run& a, const std::vector<oracle::Estimate>& b) {
    double greatest = 0;
    for (std::size_t k = 0; k < a.steps.size(); ++k)
        greatest = std::max(greatest, (a.steps[k].covariance - b[k].covariance).norm() / b[k].covariance.norm());
    return greatest;
}

std::vector<oracle::Estimate> as_estimates(const Run& run) {
    std::vector<oracle::Estimate> all;
    for (const RunStep& step : run.steps) all.push_back({step.mean, step.covariance});
    return all;
}

Settings loud(const std::string& path, const std::string& sigma) {
    Settings settings = matched_world();
    settings.insert(settings.end(), {{"model.process", "heading"}, {"features.path", path}, {"noise.heading", sigma}});
    return settings;
}

}  // namespace

TEST_CASE("estimators: each is its paper's filter, with dense matrices and the joint update") {
    for (const Estimator estimator : others)
        for (const Settings& settings :
             {loud("straight", "0.1"), loud("circle", "0.03"),
              Settings{{"features.path", "circle"}, {"noise.heading", "0.05"}},
              Settings{
                  {"noise.walk", "0"}, {"noise.deformation", "0"}, {"edges.graph", "none"}, {"noise.heading", "0.05"}}})
            for (const std::uint64_t trial : {0u, 1u, 2u}) {
                CAPTURE(estimator, trial, described(settings));
                const DeformableSettings scenario = scenario_with(settings);
                const Run run = run_arm(scenario, {Controller::fixed, estimator}, keyed_noise(scenario, 3, trial));
                const auto expected = oracle::estimates(scenario, estimator, run);
                // Two routes to one update: rounding of 1e-16, times the condition of S (1e4), over 19 poses.
                CHECK(mean_difference(run, expected) < 1e-9);
                CHECK(covariance_difference(run, expected) < 1e-9);
            }
}

TEST_CASE("estimators: with a heading that is known they are all the same filter") {
    DeformableSettings scenario = scenario_with(loud("circle", "0.01"));
    scenario.noise.heading = 0;  // refused in a scenario: P is singular, which means and covariances do not mind
    const Run ekf = run_arm(scenario, Controller::fixed, keyed_noise(scenario, 1, 5), Form::any_number);
    for (const Estimator estimator : others) {
        CAPTURE(estimator);
        const Run run = run_arm(scenario, {Controller::fixed, estimator}, keyed_noise(scenario, 1, 5));
        // The iterated one conditions eight times, each time with rounding.
        CHECK(mean_difference(run, as_estimates(ekf)) < (estimator == Estimator::iekf ? 1e-13 : 1e-14));
        CHECK(covariance_difference(run, as_estimates(ekf)) < 1e-13);
    }
}

TEST_CASE("estimators: they differ where the heading is not known") {
    const DeformableSettings scenario = scenario_with(loud("straight", "0.05"));
    const Run ekf = run_arm(scenario, Controller::fixed, keyed_noise(scenario, 1, 5), Form::any_number);
    for (const Estimator estimator : others) {
        CAPTURE(estimator);
        CHECK(mean_difference(run_arm(scenario, {Controller::fixed, estimator}, keyed_noise(scenario, 1, 5)),
                              as_estimates(ekf)) > 1e-4);
    }
}

TEST_CASE("estimators: the iterated filter with one pass is the extended Kalman filter, bit for bit") {
    with_samples<Layout<Process::heading, 3>>(
        "heading", {}, [](const Problem& problem, const Sample& sample, auto layout) {
            using ThisLayout = decltype(layout);
            constexpr int capacity = ThisLayout::capacity;
            auto one = belief_of<ThisLayout>(sample.x, sample.P), other = one;
            const Sighting<double> sightings[]{{true, {0.3, 0.2}, 0.1}, {false, {1, 2}, 0.1}, {true, {-1, 0.5}, 0.2}};
            const auto edge = [](int e) { return Vector2<double>{0.1 * e, -0.3}; };
            Update<double, capacity> update;
            FilterOfPasses<ThisLayout, double, 1> iterated;
            update_belief(one, problem.view().filter, layout, sightings, edge, AtMean<ThisLayout, double>(one.mean),
                          update);
            iterated.update(other, problem.view().filter, layout, sightings, edge,
                            AtMean<ThisLayout, double>(other.mean), update);
            CHECK(same_bits(MatrixXd(mean_of(one, sample.x.size())), MatrixXd(mean_of(other, sample.x.size()))));
            CHECK(same_bits(dense(one, sample.x.size()), dense(other, sample.x.size())));
        });
}

TEST_CASE("estimators: rows are the measurement's derivatives where the estimator linearises") {
    with_samples<AnyHeading>("heading", {}, [](const Problem&, const Sample& sample, auto layout) {
        const VectorXd x = sample.x, delta = 0.1 * sample.P.col(0).head(x.size());
        const Sighting<double> sighting{true, {0.7, -0.4}, 0.1};
        const auto h = [&](const VectorXd& at, int j) -> Eigen::Vector2d {
            return oracle::rotation(at[0]).transpose() * (at.segment<2>(3 + 2 * j) - at.segment<2>(1));
        };
        const auto check = [&](const auto& linearised, const VectorXd& at) {
            for (int j = 0; j < 3; ++j) {
                const auto [rows, innovation] = linearised(j, sighting);
                const Vector2<double> body = rotate_back(linearised.frame, innovation);
                for (int i = 0; i < x.size(); ++i) {
                    const VectorXd step = 1e-5 * VectorXd::Unit(x.size(), i);
                    const Eigen::Vector2d slope = (h(at + step, j) - h(at - step, j)) / 2e-5;
                    const Vector2<double> row =
                        rotate_back(linearised.frame, rows([&](int s) { return s == i ? 1.0 : 0.0; }));
                    CHECK(std::hypot(slope[0] - row.x, slope[1] - row.y) < 1e-8);  // 1e-10 of cut-off and rounding each
                }
                // To first order about the point, the innovation is about the mean x: z - h(at) + H (at - x).
                VectorXd off = at - x;
                const Vector2<double> along = rotate_back(linearised.frame, rows([&](int s) { return off[s]; }));
                const Eigen::Vector2d about_point = Eigen::Vector2d(sighting.z.x, sighting.z.y) - h(at, j) +
                                                    Eigen::Vector2d(along.x, along.y);
                const Eigen::Vector2d about_mean = Eigen::Vector2d(sighting.z.x, sighting.z.y) - h(x, j);
                const Eigen::Vector2d own(body.x, body.y);
                CHECK(std::min((own - about_point).norm(), (own - about_mean).norm()) < 1e-13);
            }
        };
        check(AtMean<AnyHeading, double>(x.data()), x);
        check(AtIterate<AnyHeading, double>(x.data(), delta.data()), x + delta);
        Truth<double, AnyHeading::feature_capacity> truth;
        const VectorXd other = x + 2 * delta;
        truth.heading = other[0];
        truth.rotation = rotation(other[0]);
        truth.position = point_at(other.data(), 1);
        for (int j = 0; j < 3; ++j) truth.feature[j] = point_at(other.data(), layout.feature(j));
        check(AtTruth<AnyHeading, double>(x.data(), truth), other);
        std::vector<Vector2<double>> first;
        VectorXd at = x;
        for (int j = 0; j < 3; ++j) {
            first.push_back(truth.feature[j]);
            at.segment<2>(layout.feature(j)) << truth.feature[j].x, truth.feature[j].y;
        }
        check(AtFirstEstimates<AnyHeading, double>(x.data(), first.data()), at);
    });
}

namespace {

/// Carries the turn of everything about the origin, which nothing observes, through an estimator's own F, and returns
/// the most that its own rows say of it: 0 for a filter that does not believe to learn what it cannot
/// [docs/estimators.md, A heading that nothing observes]. Static features on a loop; estimates wander about the truth
/// as a filter's would.
template <template <class, class> class Type>
double learned_of_the_turn(unsigned seed) {
    DeformableSettings scenario = scenario_with({{"features.path", "static"},
                                                 {"control.path", "circle"},
                                                 {"scenario.poses", "121"},
                                                 {"edges.graph", "none"},
                                                 {"features.turn", "0.1"},
                                                 {"features.step", "1"}});
    const Problem problem(scenario);
    FilterParameters filter = problem.view().filter;
    filter.variance_heading = filter.variance_odometry = filter.variance_feature = 0;  // P carries N N' alone
    const AnyHeading layout(3);
    const int n = layout.size();
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Truth<double, AnyHeading::feature_capacity> truth;
    truth.rotation = rotation(truth.heading);
    Belief<double, AnyHeading::capacity> belief{};
    for (int j = 0; j < 3; ++j) truth.feature[j] = {3 + normal(random), 5 + normal(random)};
    VectorXd N = VectorXd::Unit(n, 0);
    Type<AnyHeading, double> estimator;
    for (int j = 0; j < 3; ++j) {
        belief.mean[layout.feature(j)] = truth.feature[j].x + 0.1 * normal(random);
        belief.mean[layout.feature(j) + 1] = truth.feature[j].y + 0.1 * normal(random);
        // A feature turns about the origin as its filter sees it: from the estimate that it starts with, or the truth.
        const Vector2<double> p = std::is_same_v<Type<AnyHeading, double>, IdealFilter<AnyHeading, double>>
                                      ? truth.feature[j] : point_at(belief.mean, layout.feature(j));
        N.segment<2>(layout.feature(j)) << -p.y, p.x;
    }
    for (int i = 0; i < n; ++i)
        for (int j = i; j < n; ++j) belief.covariance.entry[i][j] = N[i] * N[j];
    estimator.start(layout, belief, truth);
    double most = 0;
    for (int k = 1; k < scenario.poses; ++k) {
        const Command<double> command = command_from<double>(problem.view().control.fixed[k - 1]);
        truth.position = truth.position + rotate(truth.rotation, command.move) +
                         Vector2<double>{0.1 * normal(random), 0.1 * normal(random)};
        truth.heading += command.turn + 0.05 * normal(random);
        truth.rotation = rotation(truth.heading);
        estimator.predict(belief, filter, layout, command, truth, k);
        const auto linearised = estimator.linearised(belief, layout, truth);
        for (int j = 0; j < 3; ++j) {
            const auto rows = linearised(j, Sighting<double>{true, {}, 1}).rows;
            const Vector2<double> seen = rows([&](int i) { return belief.covariance.at(0, i); });  // N_theta is 1
            most = std::max(most, std::hypot(seen.x, seen.y));
        }
        for (int i = 0; i < n; ++i) belief.mean[i] += 0.05 * normal(random);  // an update's corrections
    }
    return most;
}

}  // namespace

TEST_CASE("estimators: who believes to observe the turn of everything, and who does not") {
    for (const unsigned seed : {1u, 2u, 3u}) {
        // 120 steps of rounding at positions of about 10.
        CHECK(learned_of_the_turn<IdealFilter>(seed) < 1e-12);
        CHECK(learned_of_the_turn<FirstEstimatesFilter>(seed) < 1e-12);
        // By how much the others err: some lengths, as far as their estimates wandered.
        CHECK(learned_of_the_turn<KalmanFilter>(seed) > 0.1);
        CHECK(learned_of_the_turn<IteratedFilter>(seed) > 0.1);
    }
}

}  // namespace credence::test::estimators_long_test
