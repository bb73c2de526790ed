#pragma once
// A robot in the plane that knows its odometry and sees beacons: an extended, an iterated, an unscented, an invariant
// and an iterated invariant Kalman filter. It is switched on at a known place, with a heading that is hardly known.
//
//   X = (heading, x, y) in SE(2); X_k = X_{k-1} exp(u + w), u = (turn, speed, 0) a step, w ~ N(0, diag(sigma^2))
//   z = (|q|, atan2(q_y, q_x)) + v, q = R'(b - t) a beacon b in the robot's frame, every `every` steps one beacon
// The first three have errors (heading, t) - truth; the invariant ones have xi = log(X^ X^-1), in which the motion is
// linear [Barrau, Bonnabel 2017; Long, Wolfe, Mashner, Chirikjian 2012].

#include "range_bearing.hpp"

#include <credence/own_world.hpp>

struct Robot {
    struct Settings {
        double speed = 1, turn = 0.05, sigma_turn = 0.01, sigma_move = 0.05, sigma_heading = 0.3, sigma_place = 0.1;
        double sigma_range = 0.2, sigma_bearing = 0.02;
        int every = 10;
        std::vector<double> x{15, -10, 0}, y{0, 20, 40};
    };
    static constexpr const char* name = "robot";
    static constexpr const char* sources[] = {"start", "move", "sensor"};  // of Source in run
    static void keys(credence::OwnKeys<Settings>& keys) {
        keys.real("motion.speed", &Settings::speed, 0, 100, "way of a step (m)");
        keys.real("motion.turn", &Settings::turn, -3, 3, "turn of a step (rad)");
        keys.real("noise.turn", &Settings::sigma_turn, 1e-6, 1, "sigma of a step's turn (rad)");
        keys.real("noise.move", &Settings::sigma_move, 1e-6, 10, "sigma of a step's way, each axis (m)");
        keys.real("start.heading", &Settings::sigma_heading, 1e-6, 3, "sigma of the first heading (rad)");
        keys.real("start.place", &Settings::sigma_place, 1e-6, 100, "sigma of the first place, each axis (m)");
        keys.real("sensor.range", &Settings::sigma_range, 1e-6, 100, "sigma of a range (m)");
        keys.real("sensor.bearing", &Settings::sigma_bearing, 1e-6, 1, "sigma of a bearing (rad)");
        keys.integer("sensor.every", &Settings::every, 1, 1000, "steps from one beacon to the next");
        keys.reals("beacons.x", &Settings::x, -1e4, 1e4, "of each beacon (m)");
        keys.reals("beacons.y", &Settings::y, -1e4, 1e4, "of each beacon (m)");
    }
    static void validate(const Settings& s) {
        if (s.x.size() != s.y.size())
            throw credence::InputError("cannot place beacons", "their x and y differ in number",
                                       "Give as many of both");
    }
    static std::vector<credence::Component> components(const Settings&) {
        return {{"heading", "rad"}, {"x", "m"}, {"y", "m"}};
    }
    static std::vector<credence::ComponentGroup> groups(const Settings&) { return {{"place", 1, 2}}; }
    static int innovation_rows(const Settings&) { return 2; }
    static std::vector<std::string> arms(const Settings&) { return {"ekf", "iterated", "ukf", "invariant", "both"}; }

    template <class Real>
    using Vector = Eigen::Matrix<Real, 3, 1>;
    template <class Real>
    using Matrix = Eigen::Matrix<Real, 3, 3>;
    template <class Real>
    using Plane = Eigen::Matrix<Real, 2, 1>;
    template <class Real>
    using Pose = credence::SE2<Real>;

    /// X [+] step in the filter's chart, and its inverse.
    template <class Real>
    static Pose<Real> moved(bool invariant, const Pose<Real>& X, const Vector<Real>& step) {
        if (invariant) return Pose<Real>::exp(step) * X;
        return {credence::SO2<Real>::exp(step(0)) * X.rotation, X.vectors + step.template tail<2>()};
    }
    template <class Real>
    static Vector<Real> difference(bool invariant, const Pose<Real>& X, const Pose<Real>& Y) {
        const Vector<Real> xi = (X * Y.inverse()).log();
        return invariant ? xi : Vector<Real>(xi(0), X.vectors(0) - Y.vectors(0), X.vectors(1) - Y.vectors(1));
    }
    /// The robot's odometry moves estimate and covariance.
    template <class Real>
    static void predict(std::size_t arm, Pose<Real>& X, Matrix<Real>& P, const Pose<Real>& u, const Matrix<double>& Q) {
        const Pose<Real> middle = X * u;
        Matrix<Real> F = Matrix<Real>::Identity(), G = middle.adjoint();
        if (arm < 3) {
            G.template bottomLeftCorner<2, 1>().setZero();
            F.template bottomLeftCorner<2, 1>() = -credence::SO2<Real>::crossed(middle.vectors - X.vectors);
        }
        const Matrix<Real> noise = credence::predicted_covariance(G, Q);
        if (arm == 2) {
            const auto predicted = credence::unscented_transform(P, {}, [&](const Vector<Real>& step) {
                return difference(false, moved(false, X, step) * u, middle);
            });
            X = moved(false, middle, predicted.mean);
            P = predicted.covariance + noise;
        } else {
            X = middle;
            P = credence::predicted_covariance(F, P, noise);
        }
    }
    /// A beacon in the robot's frame.
    template <class Real>
    static Plane<Real> beside(const Pose<Real>& X, const Plane<double>& beacon) {
        return X.rotation.matrix.transpose() * (beacon.cast<Real>() - X.vectors);
    }
    /// The measurement's Jacobian: dq/dstep is -R'[J (b - t), I], or -R'[J b, I] in the invariant chart.
    template <class Real>
    static Eigen::Matrix<Real, 2, 3> jacobian(bool invariant, const Pose<Real>& X, const Plane<double>& beacon) {
        const Plane<Real> b = beacon.cast<Real>(), about = invariant ? b : Plane<Real>(b - X.vectors);
        Eigen::Matrix<Real, 2, 3> moves;
        moves << credence::SO2<Real>::crossed(about), -Eigen::Matrix<Real, 2, 2>::Identity();
        return range_bearing::jacobian(beside(X, beacon)) * (X.rotation.matrix.transpose() * moves);
    }

    template <class Real>
    static void run(const Settings& s, credence::OwnTrialOf<Real>& trial) {
        enum Source { start, move, sensor };
        const std::size_t arm = trial.arm();
        const bool invariant = arm > 2;
        const Vector<double> u(s.turn, s.speed, 0), sigma_u(s.sigma_turn, s.sigma_move, s.sigma_move);
        const Vector<double> sigma_0(s.sigma_heading, s.sigma_place, s.sigma_place);
        Matrix<double> Q = credence::right_jacobian<Pose<double>>(u) * sigma_u.asDiagonal();
        Q *= Q.transpose().eval();
        const Plane<double> sigma(s.sigma_range, s.sigma_bearing);
        const Eigen::Matrix2d R = sigma.cwiseAbs2().asDiagonal();
        const range_bearing::Difference wrapped;
        const auto draw = [&](int source, int k) {
            const Plane<Real> two = trial.normal(source, k);
            return Vector<Real>(trial.normal(source, k, 1)(0), two(0), two(1));
        };

        Pose<Real> estimate, X = moved(false, estimate, Vector<Real>(sigma_0.asDiagonal() * draw(start, 0)));
        Matrix<Real> P = sigma_0.cwiseAbs2().cast<Real>().asDiagonal();
        for (int k = 1; k < trial.poses(); ++k) {
            X = X * Pose<Real>::exp(u + sigma_u.asDiagonal() * draw(move, k));
            predict(arm, estimate, P, Pose<Real>::exp(u.cast<Real>()), Q);

            const std::size_t turn = static_cast<std::size_t>(k / s.every) % s.x.size();
            const Plane<double> beacon(s.x[turn], s.y[turn]);
            const auto polar = [&](const Pose<Real>& pose) { return range_bearing::of<Real>(beside(pose, beacon)); };
            const Plane<Real> z = polar(X) + sigma.asDiagonal() * trial.normal(sensor, k);
            const auto linearise = [&](const Vector<Real>& step) {
                const Pose<Real> about = moved(invariant, estimate, step);
                Eigen::Matrix<Real, 2, 3> H = jacobian(invariant, about, beacon);
                if (invariant) H = H * Pose<Real>::left_jacobian(step);
                return credence::Linearised<Real, 3, 2>{wrapped(z, polar(about)), H};
            };
            const auto seen = [&](const Vector<Real>& step) { return polar(moved(false, estimate, step)); };
            credence::Updated<Real, 3, 2> update;
            if (arm == 2)
                update = unscented_update(P, credence::unscented_transform(P, {}, seen, wrapped), z, R, wrapped);
            else
                update = credence::iterated_update(P, R, arm == 1 || arm == 4 ? 5 : 1, linearise);
            const bool sees = k % s.every == 0;
            if (sees) {
                estimate = moved(invariant, estimate, update.step);
                P = update.P;
            }
            trial.step(difference(invariant, estimate, X), P, update.innovation, update.S, sees);
        }
    }
};

CREDENCE_WORLD(Robot);
