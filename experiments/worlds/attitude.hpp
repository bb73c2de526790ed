#pragma once
// The attitude of a satellite or a phone, by gyroscopes with a bias and two known directions that it sees: the
// multiplicative extended Kalman filter with its error on either side, and with the reset of its covariance.
//
//   R_k = R_{k-1} exp(rate T), b a random walk; gyroscopes measure rate + b + n; directions d_i are seen as R'd_i + v
//   local:  R = R^ exp(phi), phi in the body's frame  [Lefferts, Markley, Shuster 1982; Sola 2017]
//   global: R = exp(phi) R^, phi in the world's frame
//   reset:  local, and after an update by `step`, from whose result phi then counts, P <- J P J' with J = J_r(step)
//           [Mueller, Hehn, D'Andrea 2017; Markley 2003]; most programs leave that out

#include <credence/filters.hpp>
#include <credence/own_world.hpp>

struct Attitude {
    struct Settings {
        double period = 0.1, rate = 0.5, gyro = 0.01, walk = 1e-4, direction = 0.05;
        double sigma_attitude = 0.3, sigma_bias = 0.05;
        double gyro_factor = 1, walk_factor = 1, direction_factor = 1;
    };
    static constexpr const char* name = "attitude";
    static constexpr const char* sources[] = {"start", "gyro", "walk", "direction"};  // of Source in run
    static void keys(credence::OwnKeys<Settings>& keys) {
        keys.real("motion.period", &Settings::period, 1e-4, 10, "T, time between samples (s)");
        keys.real("motion.rate", &Settings::rate, 0, 10, "largest rate about each axis (rad/s)");
        keys.real("sensor.gyro", &Settings::gyro, 1e-9, 1, "sigma of a rate, each axis (rad/s)");
        keys.real("sensor.walk", &Settings::walk, 1e-12, 1, "sigma of the bias's step, each axis (rad/s)");
        keys.real("sensor.direction", &Settings::direction, 1e-6, 1, "sigma of a direction, each axis (1)");
        keys.real("start.attitude", &Settings::sigma_attitude, 1e-6, 3, "sigma of the first attitude, each axis",
                  "rad");
        keys.real("start.bias", &Settings::sigma_bias, 1e-9, 1, "sigma of the first bias, each axis (rad/s)");
        keys.real("filter.gyro", &Settings::gyro_factor, 1e-6, 1e6, "factor on the believed sensor.gyro");
        keys.real("filter.walk", &Settings::walk_factor, 1e-6, 1e6, "factor on the believed sensor.walk");
        keys.real("filter.direction", &Settings::direction_factor, 1e-6, 1e6, "factor on the believed directions");
    }
    static std::vector<credence::Component> components(const Settings&) {
        return {{"phi_x", "rad"}, {"phi_y", "rad"}, {"phi_z", "rad"},
                {"b_x", "rad/s"}, {"b_y", "rad/s"}, {"b_z", "rad/s"}};
    }
    static std::vector<credence::ComponentGroup> groups(const Settings&) {
        return {{"attitude", 0, 3}, {"bias", 3, 3}};
    }
    static int innovation_rows(const Settings&) { return 6; }
    static std::vector<std::string> arms(const Settings&) { return {"local", "reset", "global"}; }

    template <class Real>
    using Vector = Eigen::Matrix<Real, 3, 1>;
    template <class Real>
    using Matrix = Eigen::Matrix<Real, 6, 6>;
    template <class Real>
    using Turn = credence::SO3<Real>;

    template <class Real>
    static Turn<Real> moved(bool global, const Turn<Real>& R, const Vector<Real>& phi) {
        return global ? Turn<Real>::exp(phi) * R : R * Turn<Real>::exp(phi);
    }
    /// Of (phi, b) after a step of `angle`, which ends in R: the noise of the gyroscopes enters as b does.
    template <class Real>
    static Matrix<Real> motion_jacobian(bool global, const Turn<Real>& R, const Vector<Real>& angle, double T) {
        const typename Turn<Real>::Matrix by_bias = -T * credence::right_jacobian<Turn<Real>>(angle);
        Matrix<Real> F = Matrix<Real>::Identity();
        if (!global) F.template topLeftCorner<3, 3>() = Turn<Real>::exp(angle).matrix.transpose();
        F.template topRightCorner<3, 3>() = by_bias;
        if (global) F.template topRightCorner<3, 3>() = R.matrix * by_bias;
        return F;
    }
    /// Of R'd: R'd^ or (R'd)^.
    template <class Real>
    static Eigen::Matrix<Real, 3, 6> direction_jacobian(bool global, const Turn<Real>& R, const Vector<double>& d) {
        const Eigen::Matrix<Real, 3, 3> back = R.matrix.transpose();
        Eigen::Matrix<Real, 3, 6> H = Eigen::Matrix<Real, 3, 6>::Zero();
        if (global)
            H.template leftCols<3>() = back * credence::cross_matrix(d);
        else
            H.template leftCols<3>() = credence::cross_matrix((back * d).eval());
        return H;
    }

    template <class Real>
    static void run(const Settings& s, credence::OwnTrialOf<Real>& trial) {
        enum Source { start, gyro, walk, direction };
        const double T = s.period;
        const bool global = trial.arm() == 2, resets = trial.arm() == 1;
        const double believed_gyro = s.gyro_factor * s.gyro, believed_walk = s.walk_factor * s.walk;
        const double believed_direction = s.direction_factor * s.direction;
        const double variance = believed_direction * believed_direction;
        const Vector<double> directions[] = {{0, 0, 1}, {0.6, 0, -0.8}};  // gravity, and a magnetic field
        const auto draw = [&](int source, int k, int index) {
            const Eigen::Matrix<Real, 2, 1> two = trial.normal(source, k, 2 * index);
            return Vector<Real>(two(0), two(1), trial.normal(source, k, 2 * index + 1)(0));
        };

        Turn<Real> estimate, R = Turn<Real>::exp(s.sigma_attitude * draw(start, 0, 0));
        Vector<Real> bias = Vector<Real>::Zero(), b = s.sigma_bias * draw(start, 0, 1);
        Eigen::Matrix<double, 6, 1> sigma, seen = Eigen::Matrix<double, 6, 1>::Constant(variance);
        sigma << s.sigma_attitude, s.sigma_attitude, s.sigma_attitude, s.sigma_bias, s.sigma_bias, s.sigma_bias;
        Matrix<Real> P = sigma.cwiseAbs2().cast<Real>().asDiagonal();
        const Matrix<double> noise = seen.asDiagonal();
        for (int k = 1; k < trial.poses(); ++k) {
            const double t = k * T;
            const Vector<double> turning(credence::sin(t), credence::cos(0.7 * t), credence::sin(0.3 * t + 1));
            const Vector<double> rate = s.rate * turning;
            const Vector<Real> measured = rate + b + s.gyro * draw(gyro, k, 0), angle = T * (measured - bias);
            R = R * Turn<Real>::exp((T * rate).cast<Real>());
            b += s.walk * draw(walk, k, 0);

            estimate = estimate * Turn<Real>::exp(angle);
            const Matrix<Real> F = motion_jacobian(global, estimate, angle, T);
            const Eigen::Matrix<Real, 3, 3> by_noise = believed_gyro * F.template topRightCorner<3, 3>();
            Matrix<Real> Q = Matrix<Real>::Identity() * Real(believed_walk * believed_walk);
            Q.template topLeftCorner<3, 3>() = by_noise * by_noise.transpose();
            P = credence::predicted_covariance(F, P, Q);

            Eigen::Matrix<Real, 6, 1> innovation;
            Eigen::Matrix<Real, 6, 6> H;
            for (int i = 0; i < 2; ++i) {
                const Vector<Real> z = R.matrix.transpose() * directions[i] + s.direction * draw(direction, k, i);
                innovation.template segment<3>(3 * i) = z - estimate.matrix.transpose() * directions[i];
                H.template middleRows<3>(3 * i) = direction_jacobian(global, estimate, directions[i]);
            }
            const auto update = credence::kalman_update(P, innovation, H, noise);
            const Vector<Real> step = update.step.template head<3>();
            estimate = moved(global, estimate, step);
            bias += update.step.template tail<3>();
            P = update.P;
            if (resets) {
                Matrix<Real> J = Matrix<Real>::Identity();
                J.template topLeftCorner<3, 3>() = credence::right_jacobian<Turn<Real>>(step);
                P = credence::predicted_covariance(J, P);
            }
            Eigen::Matrix<Real, 6, 1> error;
            error << (global ? estimate * R.inverse() : R.inverse() * estimate).log(), bias - b;
            trial.step(error, P, update.innovation, update.S);
        }
    }
};

CREDENCE_WORLD(Attitude);
