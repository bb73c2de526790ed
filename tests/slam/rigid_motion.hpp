#pragma once
// A world that is turned and shifted, and the robot with it: what becomes of the features' known motions, of draws, of
// truth and of belief.

#include "continued.hpp"

namespace credence::test {

/// Points p -> R p + s; a heading gains the angle.
struct RigidMotion {
    double angle;
    Vector2<double> shift;
    Rotation<double> turn = rotation(angle);

    Vector2<double> direction(const Vector2<double>& v) const { return rotate(turn, v); }
    Vector2<double> place(const Vector2<double>& p) const { return direction(p) + shift; }
};

inline RigidMotion random_motion(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> angle(-3, 3), shift(-30, 30);
    return {angle(random), {shift(random), shift(random)}};
}

inline std::vector<Point> turned(const RigidMotion& motion, const Point* points, int count) {
    std::vector<Point> turned;
    for (int i = 0; i < count; ++i) {
        const Vector2<double> point = motion.direction(broadcast<double>(points[i]));
        turned.push_back({point.x, point.y});
    }
    return turned;
}

/// A problem whose features move and sway in the turned directions.
struct TurnedProblem {
    std::vector<Point> translation, sway, increment;
    ProblemView view;

    TurnedProblem(const ProblemView& of, const RigidMotion& motion)
        : translation(turned(motion, of.world.translation, of.poses - 1)),
          sway(turned(motion, of.world.sway, of.poses * of.features)),
          increment(turned(motion, of.filter.sway_increment, of.poses * of.features)), view(of) {
        view.world.translation = view.filter.translation = translation.data();
        view.world.sway = sway.data();
        view.filter.sway_increment = increment.data();
    }
};

inline AnyNoise turned(const RigidMotion& motion, Process process, const AnyNoise& noise) {
    return {[=](Source source, int pose, int index) {
                const Vector2<double> draw = noise.normal(source, pose, index);
                const bool body = source == Source::measurement && process == Process::heading;
                return body || source == Source::odometry_heading ? draw : motion.direction(draw);
            },
            noise.uniform_draw};
}

/// The linear part of the motion of a state [n, n].
template <class Layout>
MatrixXd turn_of_state(const RigidMotion& motion, const Layout& layout) {
    MatrixXd turn = MatrixXd::Identity(layout.size(), layout.size());
    for (int point = Layout::position; point < layout.size(); point += 2)
        turn.block<2, 2>(point, point) << motion.turn.cosine, -motion.turn.sine, motion.turn.sine, motion.turn.cosine;
    return turn;
}

/// What the motion adds to a turned state [n].
template <class Layout>
VectorXd shift_of_state(const RigidMotion& motion, const Layout& layout) {
    VectorXd shift(static_cast<Eigen::Index>(layout.size()));
    if constexpr (Layout::has_heading) shift[0] = motion.angle;
    for (int point = Layout::position; point < layout.size(); point += 2)
        shift.segment<2>(point) << motion.shift.x, motion.shift.y;
    return shift;
}

/// Moves a trial's truth and belief, and lets its estimator start anew there.
template <class Layout, class Estimating>
void move(const RigidMotion& motion, const Layout& layout, CommonWorkspace<Layout, double, Estimating>& work) {
    auto& truth = work.truth;
    if constexpr (Layout::has_heading)
        truth.rotation = rotation(truth.heading = truth.heading + motion.angle);
    else
        truth.odometry_bias = motion.direction(truth.odometry_bias);
    truth.position = motion.place(truth.position);
    for (int j = 0; j < layout.features(); ++j) {
        truth.centre[j] = motion.place(truth.centre[j]);
        truth.feature[j] = motion.place(truth.feature[j]);
    }
    const MatrixXd turn = turn_of_state(motion, layout), P = dense(work.belief, layout.size());
    work.belief = belief_of<Layout>(turn * mean_of(work.belief, layout.size()) + shift_of_state(motion, layout),
                                    turn * P * turn.transpose());
    work.estimator.start(layout, work.belief, truth);
}

/// The later poses of a trial in a turned and shifted world, taken back to where they are in the other.
template <class Layout>
Continued taken_back(const RigidMotion& motion, const Layout& layout, Continued trial) {
    const MatrixXd back = turn_of_state(motion, layout).transpose();
    const VectorXd shift = shift_of_state(motion, layout);
    for (std::size_t k = 1; k < trial.run.steps.size(); ++k) {
        RunStep& step = trial.run.steps[k];
        for (VectorXd* x : {&step.truth, &step.mean, &step.prior_mean}) *x = back * (*x - shift);
        for (MatrixXd* P : {&step.covariance, &step.prior_covariance}) *P = back * *P * back.transpose();
        if (!Layout::has_heading) trial.innovation[k] *= back.topLeftCorner<2, 2>().transpose();
    }
    return trial;
}

}  // namespace credence::test
