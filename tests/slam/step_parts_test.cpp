// A step that is taken in N equal parts, each with 1/N of the variances and of the moves [docs/model.md, Truth,
// Filter].
//
// In the translation model F = I, so that N parts are exactly the step. In the heading model they are where turn and
// heading noise come with the last part: the robot moves by R(theta) v at the heading with which it leaves a pose, and
// the fresh noise of the heading moves nothing in its own step. Heading noise in every part is carried by the parts
// after it, which adds to P what is given below; a turn in every part leads elsewhere, along an arc. Where the
// deformation walks, the truth is split likewise. Jitter has no parts: each pose draws it anew with the whole
// sigma_def, while the filter, whose Q lets it accumulate, splits sigma_def^2 as well.

#include "catch.hpp"
#include "filter_samples.hpp"

#include "slam/estimators/estimator.hpp"

#include <cmath>

namespace credence::test::step_parts_test {

namespace {

constexpr int features = 3, part_counts[]{2, 3, 8};
const Command<double> whole_command{0.4, {1.5, -0.6}};

Point scaled(double share, const Point& p) { return {share * p.x, share * p.y}; }

/// The first step of a problem in N parts, which are the steps to poses 1 to N.
struct Parts {
    int count;
    double heading;  ///< share of the heading noise and of the turn that comes with each part but the last
    std::vector<Point> translation, increment, sway;
    FilterParameters filter;
    WorldParameters world;

    Parts(const ProblemView& view, int parts, double heading_share)
        : count(parts), heading(heading_share), filter(view.filter), world(view.world) {
        const double share = 1.0 / parts;
        for (int i = 0; i <= parts; ++i) {
            translation.push_back(scaled(share, filter.translation[0]));
            for (int j = 0; j < features; ++j) {
                increment.push_back(scaled(share, filter.sway_increment_at(1, j)));
                sway.push_back(scaled(i * share, world.sway_at(1, j)));  // that of pose 0 is 0
            }
        }
        filter.translation = world.translation = translation.data();
        filter.sway_increment = increment.data();
        world.sway = sway.data();
        for (double* variance : {&filter.variance_odometry, &filter.variance_feature}) *variance *= share;
        for (double* sigma : {&world.sigma_odometry, &world.sigma_walk}) *sigma *= std::sqrt(share);
        if (world.deformation == Deformation::walk) world.sigma_deformation *= std::sqrt(share);
    }

    double heading_share(int part) const { return part < count ? heading : 1 - (count - 1) * heading; }
    FilterParameters filter_of(int part) const {
        FilterParameters of = filter;
        of.variance_heading *= heading_share(part);
        return of;
    }
    WorldParameters world_of(int part) const {
        WorldParameters of = world;
        of.sigma_heading *= std::sqrt(heading_share(part));
        return of;
    }
    Command<double> command(int part, const Command<double>& whole) const {
        return {heading_share(part) * whole.turn, scaled(1.0 / count, whole.move)};
    }
};

/// The sample's belief after a step in parts.
template <class Layout>
Belief<double, Layout::capacity> predicted(const Parts& parts, const Sample& sample, const Command<double>& command) {
    auto belief = belief_of<Layout>(sample.x, sample.P);
    KalmanFilter<Layout, double> filter;
    for (int part = 1; part <= parts.count; ++part)
        filter.predict(belief, parts.filter_of(part), Layout(features), parts.command(part, command), {}, part);
    return belief;
}

/// The part of P that is made by heading noises of variance q/N in N parts, beside q itself: that of part i is carried
/// along the remaining (N - i)/N of the displacement, a = J R(theta) v.
MatrixXd carried_noise(const Vector2<double>& a, double q, int parts) {
    const double N = parts, moved = q * (N - 1) / (2 * N), squared = q * (N - 1) * (2 * N - 1) / (6 * N * N);
    MatrixXd carried = MatrixXd::Zero(9, 9);
    const Eigen::Vector2d lever(a.x, a.y);
    carried.block<2, 1>(1, 0) = moved * lever;
    carried.block<1, 2>(0, 1) = moved * lever.transpose();
    carried.block<2, 2>(1, 1) = squared * lever * lever.transpose();
    return carried;
}

/// Sums of numbers below 100, each rounded up to 8 times.
constexpr double rounding = 8 * 100 * std::numeric_limits<double>::epsilon();

/// The parts of a prediction give the belief of the whole, its P with `more`.
template <class Layout>
void check_prediction(const Parts& parts, const Sample& sample, const Command<double>& command, const MatrixXd& more,
                      const ProblemView& view) {
    const Eigen::Index n = sample.x.size();
    const auto whole = predicted<Layout>(Parts(view, 1, 0), sample, command);
    const auto belief = predicted<Layout>(parts, sample, command);
    CAPTURE(parts.count);
    CHECK((mean_of(belief, n) - mean_of(whole, n)).norm() < rounding);
    CHECK((dense(belief, n) - dense(whole, n) - more).norm() < rounding);
}

/// The draws of a step that add up to those of its parts, poses 1 to N.
AnyNoise summed(const AnyNoise& noise, Deformation deformation, int parts) {
    return {[=](Source source, int pose, int index) {
                const bool jitter = source == Source::deformation && deformation == Deformation::jitter;
                if (jitter || source == Source::odometry_heading) return noise.normal(source, parts, index);
                Vector2<double> sum{};
                for (int i = 0; i < parts; ++i) sum = sum + noise.normal(source, pose + i, index);
                return scaled(1 / std::sqrt(static_cast<double>(parts)), sum);
            },
            noise.uniform_draw};
}

/// The truth after a step in parts [3 + 2M].
template <class Layout>
VectorXd moved(const Parts& parts, const AnyNoise& noise) {
    const Layout layout(features);
    Truth<double, Layout::feature_capacity> truth;
    start_truth(truth, parts.world, layout, draws_at<Layout>(silent_noise(), 0), silent_noise());
    for (int part = 1; part <= parts.count; ++part) {
        const auto draws = draws_at<Layout>(noise, part);
        move_robot(truth, parts.world_of(part), parts.command(part, whole_command), draws);
        move_features(truth, parts.world_of(part), layout, part, draws);
    }
    VectorXd state(3 + 2 * features);
    state.head<3>() << truth.heading, truth.position.x, truth.position.y;
    for (int j = 0; j < features; ++j) state.segment<2>(3 + 2 * j) << truth.feature[j].x, truth.feature[j].y;
    return state;
}

template <class Layout>
void check_truth(const DeformableSettings& scenario) {
    const Problem problem(scenario);
    const ProblemView& view = problem.view();
    for (const int count : part_counts)
        for (std::uint64_t trial = 0; trial < 20; ++trial) {
            const AnyNoise noise = keyed_noise(scenario, 4, trial);
            const VectorXd parts = moved<Layout>(Parts(view, count, 0), noise);
            const AnyNoise sum = summed(noise, view.world.deformation, count);
            CHECK((parts - moved<Layout>(Parts(view, 1, 0), sum)).norm() < rounding);
        }
}

}  // namespace

TEST_CASE("step parts: a prediction is the sum of its parts, turn and heading noise with the last of them") {
    with_both({{"noise.heading", "0.3"}}, [](const Problem& problem, const Sample& sample, auto layout) {
        for (const int count : part_counts)
            check_prediction<decltype(layout)>(Parts(problem.view(), count, 0), sample, whole_command,
                                               MatrixXd::Zero(layout.size(), layout.size()), problem.view());
    });
}

TEST_CASE("step parts: heading noise in every part is carried by the parts after it") {
    using Heading = Layout<Process::heading, 3>;
    const Settings settings{{"noise.heading", "0.3"}};
    with_samples<Heading>("heading", settings, [](const Problem& problem, const Sample& sample, Heading) {
        const Command<double> straight{0, whole_command.move};
        const Vector2<double> u = rotate(rotation(sample.x[0]), straight.move);
        for (const int count : part_counts)
            check_prediction<Heading>(Parts(problem.view(), count, 1.0 / count), sample, straight,
                                      carried_noise({-u.y, u.x}, problem.view().filter.variance_heading, count),
                                      problem.view());
    });
}

TEST_CASE("step parts: a true step is the sum of its parts, jitter as it is after the last of them") {
    for (const char* deformation : {"walk", "jitter"}) {
        const Settings settings{{"truth.deformation", deformation}, {"features.path", "circle"},
                                {"features.sway_amplitude", "0.4"}, {"noise.heading", "0.3"}};
        check_truth<Layout<Process::heading, features>>(scenario_with(settings));
        Settings translation{{"model.process", "translation"}};
        translation.insert(translation.end(), settings.begin(), settings.end());
        check_truth<Layout<Process::translation, features>>(scenario_with(translation));
    }
}

}  // namespace credence::test::step_parts_test
