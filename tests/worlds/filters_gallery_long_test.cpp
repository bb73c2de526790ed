// The Jacobians of the gallery's filters are those of their models.

#include "catch.hpp"

#include "../../experiments/worlds/attitude.hpp"
#include "../../experiments/worlds/bearings_only.hpp"
#include "../../experiments/worlds/coordinated_turn.hpp"
#include "../../experiments/worlds/ins.hpp"
#include "../../experiments/worlds/robot.hpp"

#include <random>

namespace credence::test::filters_gallery_long_test {

namespace {

template <int n>
Eigen::Matrix<double, n, 1> drawn(std::mt19937& random) {
    std::normal_distribution<double> normal;
    Eigen::Matrix<double, n, 1> all;
    for (double& one : all.reshaped()) one = normal(random);
    return all;
}
template <int n>
const Eigen::Matrix<double, n, 1> nothing = Eigen::Matrix<double, n, 1>::Zero();

}  // namespace

TEST_CASE("gallery: the robot's Jacobians are those of its motion and its sensor, in both charts") {
    std::mt19937 random(1);
    for (int sample = 0; sample < 100; ++sample) {
        const SE2<double> X = SE2<double>::exp(drawn<3>(random)), u = SE2<double>::exp(0.3 * drawn<3>(random));
        const Eigen::Vector2d beacon = 20 * drawn<2>(random);
        for (const std::size_t arm : {std::size_t{0}, std::size_t{3}}) {
            const bool invariant = arm == 3;
            SE2<double> moved = X;
            Eigen::Matrix3d P = Eigen::Matrix3d::Identity();
            Robot::predict<double>(arm, moved, P, u, Eigen::Matrix3d::Zero());
            // Of an error e before the motion, the one after it is F e, and P = I becomes F F'.
            const Eigen::Matrix3d F = numerical_jacobian(
                [&](const Eigen::Vector3d& step) {
                    return Robot::difference(invariant, Robot::moved(invariant, X, step) * u, X * u);
                },
                nothing<3>);
            CHECK((F * F.transpose() - P).norm() < 1e-9);
            CHECK(jacobian_mismatch(
                      [&](const Eigen::Vector3d& step) {
                          return range_bearing::of<double>(Robot::beside(Robot::moved(invariant, X, step), beacon));
                      },
                      nothing<3>, Robot::jacobian(invariant, X, beacon)) < 1e-8);
        }
    }
}

TEST_CASE("gallery: the coordinated turn's Jacobian is that of its motion, straight on as well") {
    std::mt19937 random(2);
    for (int sample = 0; sample < 100; ++sample) {
        Eigen::Matrix<double, 5, 1> x = drawn<5>(random);
        if (sample % 10 == 0) x(4) = 0;
        CHECK(jacobian_mismatch([](const Eigen::Matrix<double, 5, 1>& at) { return CoordinatedTurn::moved(at, 0.7); },
                                x, CoordinatedTurn::motion_jacobian(x, 0.7)) < 1e-8);
    }
}

TEST_CASE("gallery: modified polar coordinates are Cartesian ones, and so are their Jacobians") {
    std::mt19937 random(3);
    for (int sample = 0; sample < 100; ++sample) {
        const Eigen::Vector4d x = drawn<4>(random) + Eigen::Vector4d(-5, 3, 0, 0), y = BearingsOnly::polar(x);
        CHECK((BearingsOnly::cartesian(y) - x).norm() < 1e-12);
        CHECK(jacobian_mismatch([](const Eigen::Vector4d& at) { return BearingsOnly::polar(at); }, x,
                                BearingsOnly::polar_jacobian(x)) < 1e-8);
        CHECK(jacobian_mismatch([](const Eigen::Vector4d& at) { return BearingsOnly::cartesian(at); }, y,
                                BearingsOnly::cartesian_jacobian(y), Eigen::Vector4d(1, 1, 1, y(3))) < 1e-8);
    }
}

TEST_CASE("gallery: the attitude's Jacobians are those of its motion and its directions, on either side") {
    std::mt19937 random(4);
    for (int sample = 0; sample < 100; ++sample) {
        const SO3<double> R = SO3<double>::exp(drawn<3>(random));
        const Eigen::Vector3d angle = 0.3 * drawn<3>(random), d = drawn<3>(random);
        for (const bool global : {false, true}) {
            const SO3<double> next = R * SO3<double>::exp(angle);
            const auto motion = [&](const Eigen::Matrix<double, 6, 1>& step) {
                const Eigen::Vector3d turned = angle - 0.2 * step.tail<3>();
                const SO3<double> there = Attitude::moved<double>(global, R, step.head<3>()) * SO3<double>::exp(turned);
                Eigen::Matrix<double, 6, 1> e;
                e << (global ? there * next.inverse() : next.inverse() * there).log(), step.tail<3>();
                return e;
            };
            CHECK(jacobian_mismatch(motion, nothing<6>, Attitude::motion_jacobian(global, next, angle, 0.2)) < 1e-8);
            const auto seen = [&](const Eigen::Matrix<double, 6, 1>& step) {
                return (Attitude::moved<double>(global, R, step.head<3>()).matrix.transpose() * d).eval();
            };
            CHECK(jacobian_mismatch(seen, nothing<6>, Attitude::direction_jacobian(global, R, d)) < 1e-8);
        }
    }
}

TEST_CASE("gallery: the inertial unit's Jacobian is that of its motion, with both errors") {
    std::mt19937 random(5);
    for (int sample = 0; sample < 100; ++sample) {
        const SE23<double> X = SE23<double>::exp(drawn<9>(random));
        const Eigen::Matrix<double, 6, 1> u = 3 * drawn<6>(random);
        for (const bool invariant : {false, true}) {
            const SE23<double> next = Ins::moved(X, u, 0.1);
            const auto motion = [&](const Eigen::Matrix<double, 15, 1>& step) {
                const SE23<double> there =
                    Ins::moved<double>(Ins::corrected<double>(invariant, X, step.head<9>()), u - step.tail<6>(), 0.1);
                Eigen::Matrix<double, 15, 1> e;
                e << Ins::difference(invariant, there, next), step.tail<6>();
                return e;
            };
            CHECK(jacobian_mismatch(motion, nothing<15>, Ins::motion_jacobian(invariant, X, u, 0.1)) < 1e-8);
        }
    }
}

}  // namespace credence::test::filters_gallery_long_test
