// The loop among landmarks [docs/estimators.md]: its truth, first sight, and every estimator in it against dense
// matrices on a state that grows.

#include "landmark_run.hpp"

#include "catch.hpp"
#include "oracle/landmarks.hpp"
#include "worlds/values.hpp"

#include <credence/ini.hpp>

namespace credence::test::landmarks_long_test {

namespace {

/// Rows of the state that theta, r and these landmarks have.
std::vector<int> rows_of(const std::vector<int>& landmarks) {
    std::vector<int> rows{0, 1, 2};
    for (const int j : landmarks) rows.insert(rows.end(), {3 + 2 * j, 4 + 2 * j});
    return rows;
}

}  // namespace

TEST_CASE("landmarks: every estimator is its paper's filter on a state that grows") {
    for (const ExploreSettings& scenario : {classical(70), other()})
        for (const Estimator estimator : all_estimators)
            for (const std::uint64_t trial : {0u, 1u}) {
                CAPTURE(estimator, trial, feature_count(scenario));
                const LandmarkRun run = run_landmarks(scenario, estimator, noise_of(trial));
                const auto expected = oracle::landmark_trial(scenario, estimator, for_oracle(noise_of(trial)));
                REQUIRE(run.steps.size() == expected.size());
                double truth = 0, mean = 0, covariance = 0, nis = 0, nees = 0;
                for (std::size_t k = 0; k < expected.size(); ++k) {
                    const auto& [landmarks, true_state, estimate, step_nis, rows, last_move] = expected[k];
                    const std::vector<int> places = rows_of(landmarks);
                    truth = std::max(truth, (run.steps[k].truth(places) - true_state).norm());
                    mean = std::max(mean, (run.steps[k].mean(places) - estimate.mean).norm());
                    covariance =
                        std::max(covariance, (run.steps[k].covariance(places, places) - estimate.covariance).norm() /
                                                 estimate.covariance.norm());
                    if (k == 0) continue;
                    const int step = static_cast<int>(k);
                    nis = std::max(nis, relative(run.figure(scenario, "nis", step), step_nis));
                    CHECK(run.figure(scenario, "nis_rows", step) == rows);
                    const VectorXd error = (estimate.mean - true_state).head<3>();
                    nees = std::max(nees,
                                    relative(run.figure(scenario, "nees_pose", step),
                                             error.dot(estimate.covariance.topLeftCorner<3, 3>().ldlt().solve(error))));
                }
                // The loop by sums or in closed form: rounding at lengths of 20. Two routes to one update: rounding of
                // 1e-16, times the condition of S (1e3), over 70 poses.
                CHECK(truth < 1e-12);
                CHECK(mean < 1e-10);
                CHECK(covariance < 1e-10);
                CHECK(nis < 1e-8);
                CHECK(nees < 1e-8);
            }
}

TEST_CASE("landmarks: the scenario of the study is the classical loop") {
    const Scenario study = read_scenario(CREDENCE_SOURCE "/experiments/estimators/landmarks.ini"),
                   expected = scenario_of(classical(601));
    REQUIRE(study.settings.size() == expected.settings.size());
    for (std::size_t i = 0; i < expected.settings.size(); ++i) {
        const auto& [key, value, later] = expected.settings[i];
        CAPTURE(key);
        if (key == "scenario.title") continue;
        if (key != "features.positions") {
            CHECK(study.settings[i].value == value);
            continue;
        }
        const std::vector<Point> written = parse_points(key, study.settings[i].value, 20),
                                 exact = parse_points(key, value, 20);
        REQUIRE(written.size() == exact.size());
        for (std::size_t j = 0; j < exact.size(); ++j) {  // written to four decimals
            CHECK(written[j].x == Approx(exact[j].x).margin(0.6e-4));
            CHECK(written[j].y == Approx(exact[j].y).margin(0.6e-4));
        }
    }
}

TEST_CASE("landmarks: where one is first seen, and what is believed of it before") {
    ExploreSettings scenario = other();
    scenario.poses = 12;  // not once around
    const LandmarkRun run = run_landmarks(scenario, Estimator::ekf, noise_of(3));
    int never = 0, at_start = 0;
    for (int j = 0; j < feature_count(scenario); ++j) {
        const int first = run.first_pose[static_cast<std::size_t>(j)], f = 3 + 2 * j;
        const auto last_unseen = static_cast<std::size_t>(std::min(first, scenario.poses) - 1);
        CAPTURE(j, first);
        never += first == scenario.poses;
        at_start += first == 0;
        if (first == 0) continue;
        for (const std::size_t k : {std::size_t{0}, last_unseen}) {
            MatrixXd expected = MatrixXd::Zero(2, run.steps[k].mean.size());
            expected.block<2, 2>(0, f).diagonal().setConstant(9);  // prior 3, squared
            CHECK(run.steps[k].covariance.middleRows<2>(f) == expected);
            CHECK(run.steps[k].mean.segment<2>(f) == run.steps[0].mean.segment<2>(f));
        }
        CHECK((run.steps[0].mean - run.steps[0].truth).segment<2>(f).norm() > 0);
        if (first == scenario.poses) continue;
        CHECK(run.steps[static_cast<std::size_t>(first)].covariance(f, f) < 5);  // known now, poorly so far
    }
    CHECK(at_start >= 1);
    CHECK(never >= 1);
    CHECK(never + at_start < feature_count(scenario));
}

TEST_CASE("landmarks: nothing is left of what was believed before first sight") {
    ExploreSettings near = classical(66), far = near;
    near.prior = 0.5;
    far.prior = 1000;
    for (const Estimator estimator : all_estimators) {
        CAPTURE(estimator);
        const LandmarkRun a = run_landmarks(near, estimator, noise_of(0)),
                          b = run_landmarks(far, estimator, noise_of(0));
        const int seen_all = *std::max_element(a.first_pose.begin(), a.first_pose.end());
        REQUIRE(seen_all < 61);
        for (std::size_t k = static_cast<std::size_t>(seen_all); k < a.steps.size(); ++k) {
            CHECK(same_bits(MatrixXd(a.steps[k].mean), MatrixXd(b.steps[k].mean)));
            CHECK(a.steps[k].covariance == b.steps[k].covariance);  // but for the sign of zeros
        }
        CHECK(a.steps[1].covariance != b.steps[1].covariance);
    }
}

TEST_CASE("landmarks: series count rows, landmarks out of sight and first sights") {
    const ExploreSettings scenario = classical(30);
    const LandmarkRun run = run_landmarks(scenario, Estimator::ekf, noise_of(0));
    double unseen = 0;
    for (int k = 1; k < scenario.poses; ++k) {
        const Held& now = run.steps[static_cast<std::size_t>(k)];
        int seen = 0, known = 0;
        for (int j = 0; j < feature_count(scenario); ++j) {
            const bool sees =
                (now.truth.segment<2>(3 + 2 * j) - now.truth.segment<2>(1)).norm() <= scenario.sensor.range_max;
            seen += sees;
            known += sees && run.first_pose[static_cast<std::size_t>(j)] < k;
        }
        CHECK(run.figure(scenario, "nis_rows", k) == 2 * known);
        CHECK(run.figure(scenario, "unseen_features", k) == feature_count(scenario) - seen);
        unseen += feature_count(scenario) - seen;
    }
    CHECK(run.columns[column_unseen] == unseen);
    CHECK(run.columns[explore_column_count - 2] == 0);
}

TEST_CASE("landmarks: first sight moves a landmark with the pose as its derivatives say") {
    const ExploreLayout layout(3, 8);
    const Sample sample(layout.size(), 5);
    const Sighting<double> sighting{true, {1.2, -0.7}, 0.3};
    const auto landmark = [&](const VectorXd& x) -> Eigen::Vector2d {
        return x.segment<2>(1) + oracle::rotation(x[0]) * Eigen::Vector2d(1.2, -0.7);
    };
    FilterParameters filter;
    HeadingBelief belief = belief_of<ExploreLayout>(sample.x, sample.P);
    HeadingTruth truth;
    KalmanFilter<ExploreLayout, double>().initialise(belief, filter, layout, 1, sighting, truth);
    MatrixXd grow = MatrixXd::Identity(layout.size(), layout.size());
    grow.middleRows<2>(5).setZero();
    for (int i = 0; i < 3; ++i) {
        const VectorXd step = 1e-5 * VectorXd::Unit(layout.size(), i);
        grow.block<2, 1>(5, i) = (landmark(sample.x + step) - landmark(sample.x - step)) / 2e-5;
    }
    MatrixXd expected = grow * sample.P * grow.transpose();
    expected.block<2, 2>(5, 5).diagonal().array() += 0.09;
    CHECK((mean_of(belief, layout.size()).segment<2>(5) - landmark(sample.x)).norm() < 1e-15);
    // The derivatives' cut-off and rounding, 1e-10, times entries of P of about 10.
    CHECK((dense(belief, layout.size()) - expected).norm() < 1e-8);
}

namespace {

/// An estimator that carries beside its belief what a turn of everything about the origin does to it, by its own F, its
/// own first sights and, where it turns its covariance after the update, by that; and notes the most that its own rows
/// say of it [docs/estimators.md, Landmarks on a loop]: 0 for a filter that does not believe to learn what it cannot.
template <template <class, class> class Type>
struct Watched : Type<ExploreLayout, double> {
    using Base = Type<ExploreLayout, double>;
    static inline double most = 0;

    void start(const ExploreLayout& layout, const HeadingBelief& belief, const HeadingTruth& truth) {
        Base::start(layout, belief, truth);
        turn_ = VectorXd::Unit(layout.size(), 0);
    }
    void predict(HeadingBelief& belief, const FilterParameters& filter, const ExploreLayout& layout,
                 const Command<double>& command, const HeadingTruth& truth, int k) {
        FilterParameters quiet = filter;
        quiet.variance_heading = quiet.variance_odometry = 0;
        carry(belief, layout,
              [&](Base& own, HeadingBelief& turned) { own.predict(turned, quiet, layout, command, truth, k); });
        Base::predict(belief, filter, layout, command, truth, k);
    }
    template <class EdgeMeasurement, class Linearisation>
    void update(HeadingBelief& belief, const FilterParameters& filter, const ExploreLayout& layout,
                const Sighting<double>* sightings, const EdgeMeasurement& edge, const Linearisation& linearised,
                Update<double, ExploreLayout::capacity>& update) {
        for (int j = 0; j < layout.features(); ++j) {
            if (!sightings[j].seen) continue;
            const Vector2<double> said = linearised(j, sightings[j]).rows([&](int i) { return turn_[i]; });
            most = std::max(most, std::hypot(said.x, said.y));
        }
        const VectorXd before = mean_of(belief, layout.size());
        Base::update(belief, filter, layout, sightings, edge, linearised, update);
        if (!std::is_same_v<Base, RightInvariantFilter<ExploreLayout, double>>) return;
        const VectorXd shift = mean_of(belief, layout.size()) - before;
        carry(belief, layout,
              [&](Base&, HeadingBelief& turned) { turn_covariance(turned.covariance, layout, shift.data()); });
    }
    void initialise(HeadingBelief& belief, const FilterParameters& filter, const ExploreLayout& layout, int j,
                    const Sighting<double>& sighting, const HeadingTruth& truth) {
        Sighting<double> exact = sighting;
        exact.sigma = 0;
        carry(belief, layout,
              [&](Base& own, HeadingBelief& turned) { own.initialise(turned, filter, layout, j, exact, truth); });
        Base::initialise(belief, filter, layout, j, sighting, truth);
    }

private:
    /// Puts the covariance N N' through what a copy of the filter does: its first row is N again, as N_theta is 1.
    template <class Does>
    void carry(const HeadingBelief& belief, const ExploreLayout& layout, const Does& does) {
        HeadingBelief turned = belief_of<ExploreLayout>(mean_of(belief, layout.size()), turn_ * turn_.transpose());
        Base own = *this;
        does(own, turned);
        turn_ = dense(turned, layout.size()).col(0);
    }
    VectorXd turn_;
};

template <template <class, class> class Type>
double learned_of_the_turn(std::uint64_t trial) {
    Watched<Type>::most = 0;
    run_with<Watched<Type>>(classical(121), noise_of(trial));
    return Watched<Type>::most;
}

}  // namespace

TEST_CASE("landmarks: who believes to observe the turn of everything, and who does not") {
    // Two loops of rounding at lengths of 20.
    CHECK(learned_of_the_turn<IdealFilter>(0) < 1e-12);
    CHECK(learned_of_the_turn<FirstEstimatesFilter>(0) < 1e-12);
    CHECK(learned_of_the_turn<RightInvariantFilter>(0) < 1e-12);
    // By how much the others err: as far as their estimates wandered.
    CHECK(learned_of_the_turn<KalmanFilter>(0) > 1);
    CHECK(learned_of_the_turn<IteratedFilter>(0) > 1);
}

TEST_CASE("landmarks: an iterated update that has not come to rest is counted") {
    ExploreSettings scenario = classical(121);
    scenario.noise.heading = 0.2;  // so that there are some
    int unsettled = 0, settled = 0;
    for (const std::uint64_t trial : {0u, 1u, 2u, 3u}) {
        const LandmarkRun run = run_landmarks(scenario, Estimator::iekf, noise_of(trial));
        const auto expected = oracle::landmark_trial(scenario, Estimator::iekf, for_oracle(noise_of(trial)));
        for (std::size_t k = 1; k < expected.size(); ++k) {
            const VectorXd& moved = expected[k].last_move;  // landmarks of this pose's first sight come after these
            const VectorXd sigma = expected[k].estimate.covariance.diagonal().head(moved.size()).cwiseSqrt();
            const double most = moved.cwiseQuotient(sigma).cwiseAbs().maxCoeff();
            CAPTURE(trial, k, most);
            CHECK(run.figure(scenario, "unsettled_updates", static_cast<int>(k)) == (most > settled_share));
            (most > settled_share ? unsettled : settled)++;
        }
    }
    CHECK(unsettled >= 3);
    CHECK(settled >= 100);
    const LandmarkRun other = run_landmarks(scenario, Estimator::ekf, noise_of(0));
    for (int k = 1; k < scenario.poses; ++k) CHECK(other.figure(scenario, "unsettled_updates", k) == 0);
}

}  // namespace credence::test::landmarks_long_test
