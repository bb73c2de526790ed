#pragma once
// An aircraft that turns at a nearly constant rate, seen by a radar with a coarse bearing: an extended and an unscented
// Kalman filter.
//
//   x = (p_x, p_y, v_x, v_y, rate); a step of T: p += T V(rate T) v, v = R(rate T) v, V the mean of R over the step
//   noise: an acceleration over the step, each axis, and a change of the rate  [Bar-Shalom, Li, Kirubarajan 2001, 11.7]
//   z = (|p|, atan2(p_y, p_x)) + v
// Where range sigma_bearing^2 / sigma_range is above about 0.4, a bearing's error curves the place's distribution by
// more than the range's error hides [Lerro, Bar-Shalom 1993].

#include "range_bearing.hpp"

#include <credence/own_world.hpp>

struct CoordinatedTurn {
    struct Settings {
        double period = 1, rate = 0.05, acceleration = 0.1, sigma_rate = 0.002;
        double place = 2000, speed = 100, first_place = 200, first_speed = 10, first_rate = 0.02;
        double sigma_range = 5, sigma_bearing = 0.05;
        double acceleration_factor = 1, rate_factor = 1, range_factor = 1, bearing_factor = 1;
    };
    static constexpr const char* name = "coordinated_turn";
    static constexpr const char* sources[] = {"start", "acceleration", "rate", "sensor"};  // of Source in run
    static void keys(credence::OwnKeys<Settings>& keys) {
        keys.real("motion.period", &Settings::period, 1e-3, 1e3, "T, time between steps (s)");
        keys.real("motion.rate", &Settings::rate, -3, 3, "of the first turn, on average (rad/s)");
        keys.real("noise.acceleration", &Settings::acceleration, 1e-6, 1e3, "sigma, each axis (m/s^2)");
        keys.real("noise.rate", &Settings::sigma_rate, 1e-9, 1, "sigma of the rate's change in a step (rad/s)");
        keys.real("start.range", &Settings::place, 1, 1e6, "from the radar, on average (m)");
        keys.real("start.speed", &Settings::speed, 0, 1e4, "across the line of sight, on average (m/s)");
        keys.real("start.sigma_place", &Settings::first_place, 1e-3, 1e6, "each axis (m)");
        keys.real("start.sigma_speed", &Settings::first_speed, 1e-3, 1e4, "each axis (m/s)");
        keys.real("start.sigma_rate", &Settings::first_rate, 1e-9, 1, "of the first turn (rad/s)");
        keys.real("sensor.range", &Settings::sigma_range, 1e-6, 1e4, "sigma of a range (m)");
        keys.real("sensor.bearing", &Settings::sigma_bearing, 1e-6, 1, "sigma of a bearing (rad)");
        keys.real("filter.acceleration", &Settings::acceleration_factor, 1e-6, 1e6,
                  "factor on the believed noise.acceleration");
        keys.real("filter.rate", &Settings::rate_factor, 1e-6, 1e6, "factor on the believed noise.rate");
        keys.real("filter.range", &Settings::range_factor, 1e-6, 1e6, "factor on the believed sensor.range");
        keys.real("filter.bearing", &Settings::bearing_factor, 1e-6, 1e6, "factor on the believed sensor.bearing");
    }
    static std::vector<credence::Component> components(const Settings&) {
        return {{"p_x", "m"}, {"p_y", "m"}, {"v_x", "m/s"}, {"v_y", "m/s"}, {"rate", "rad/s"}};
    }
    static std::vector<credence::ComponentGroup> groups(const Settings&) {
        return {{"position", 0, 2}, {"velocity", 2, 2}, {"rate", 4, 1}};
    }
    static int innovation_rows(const Settings&) { return 2; }
    static std::vector<std::string> arms(const Settings&) { return {"ekf", "ukf"}; }

    template <class Real>
    using Vector = Eigen::Matrix<Real, 5, 1>;
    template <class Real>
    using Matrix = Eigen::Matrix<Real, 5, 5>;
    template <class Real>
    using Plane = Eigen::Matrix<Real, 2, 1>;

    template <class Real>
    static Vector<Real> moved(const Vector<Real>& x, double T) {
        const Eigen::Matrix<Real, 1, 1> angle(x(4) * T);
        const Plane<Real> v = x.template segment<2>(2);
        Vector<Real> next;
        next << x.template head<2>() + T * (credence::SO2<Real>::mean_rotation(angle) * v),
            credence::SO2<Real>::exp(angle).matrix * v, x(4);
        return next;
    }
    /// dV/dangle has the entries -angle (c_2 - c_3) and c_1 - c_2.
    template <class Real>
    static Matrix<Real> motion_jacobian(const Vector<Real>& x, double T) {
        const Real angle = x(4) * T;
        const Eigen::Matrix<Real, 1, 1> phi(angle);
        const credence::Stumpff<Real> c(angle * angle);
        const Plane<Real> v = x.template segment<2>(2), left(-v(1), v(0));
        const Eigen::Matrix<Real, 2, 2> turned = credence::SO2<Real>::exp(phi).matrix;
        Matrix<Real> F = Matrix<Real>::Identity();
        F.template block<2, 2>(0, 2) = T * credence::SO2<Real>::mean_rotation(phi);
        F.template block<2, 2>(2, 2) = turned;
        F.template block<2, 1>(0, 4) = T * T * ((c.c1 - c.c2) * left - angle * (c.c2 - c.c3) * v);
        F.template block<2, 1>(2, 4) = T * (turned * left);
        return F;
    }
    template <class Real>
    static void run(const Settings& s, credence::OwnTrialOf<Real>& trial) {
        enum Source { start, acceleration, rate, sensor };
        const double T = s.period;
        const bool unscented = trial.arm() == 1;
        const range_bearing::Difference wrapped;
        const auto polar = [](const Vector<Real>& x) { return range_bearing::of<Real>(x.template head<2>()); };
        Eigen::Matrix<double, 5, 3> G = Eigen::Matrix<double, 5, 3>::Zero();
        G.topLeftCorner<2, 2>().diagonal().setConstant(s.acceleration * T * T / 2);
        G.block<2, 2>(2, 0).diagonal().setConstant(s.acceleration * T);
        G(4, 2) = s.sigma_rate;
        Eigen::Matrix<double, 5, 3> believed = s.acceleration_factor * G;
        believed(4, 2) = s.rate_factor * s.sigma_rate;
        const Matrix<double> Q = believed * believed.transpose();
        const Plane<double> sigma(s.sigma_range, s.sigma_bearing);
        const Plane<double> believed_sigma(s.range_factor * s.sigma_range, s.bearing_factor * s.sigma_bearing);
        const Eigen::Matrix2d R = believed_sigma.cwiseAbs2().asDiagonal();

        Vector<double> sigma_0, x_0;
        sigma_0 << s.first_place, s.first_place, s.first_speed, s.first_speed, s.first_rate;
        x_0 << s.place, 0, 0, s.speed, s.rate;
        Vector<Real> estimate = x_0.cast<Real>(), first;
        first << trial.normal(start, 0), trial.normal(start, 0, 1), trial.normal(start, 0, 2)(0);
        Vector<Real> x = estimate + sigma_0.asDiagonal() * first;
        Matrix<Real> P = sigma_0.cwiseAbs2().cast<Real>().asDiagonal();
        for (int k = 1; k < trial.poses(); ++k) {
            Eigen::Matrix<Real, 3, 1> w;
            w << trial.normal(acceleration, k), trial.normal(rate, k)(0);
            x = moved(x, T) + G * w;
            const Plane<Real> z = polar(x) + sigma.asDiagonal() * trial.normal(sensor, k);

            credence::Updated<Real, 5, 2> update;
            if (unscented) {
                const auto predicted = credence::unscented_transform(
                    P, {}, [&](const Vector<Real>& step) { return moved<Real>(estimate + step, T); });
                estimate = predicted.mean;
                P = predicted.covariance + Q;
                const auto seen = credence::unscented_transform(
                    P, {}, [&](const Vector<Real>& step) { return polar(estimate + step); }, wrapped);
                update = credence::unscented_update(P, seen, z, R, wrapped);
            } else {
                P = credence::predicted_covariance(motion_jacobian(estimate, T), P, Q);
                estimate = moved(estimate, T);
                Eigen::Matrix<Real, 2, 5> H = Eigen::Matrix<Real, 2, 5>::Zero();
                H.template leftCols<2>() = range_bearing::jacobian<Real>(estimate.template head<2>());
                update = credence::kalman_update(P, wrapped(z, polar(estimate)), H, R);
            }
            estimate += update.step;
            P = update.P;
            trial.step(estimate - x, P, update.innovation, update.S);
        }
    }
};

CREDENCE_WORLD(CoordinatedTurn);
