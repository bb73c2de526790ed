#pragma once
// Inertial navigation with GPS: an inertial unit at 100 Hz with biases that walk, a position each second, 15
// states. A vehicle on a circle starts at a known place and speed, and hardly knows its heading.
//
//   R' = R exp((w - b_g - n_g) T), a = R (f - b_a - n_a) + g, v' = v + a T, p' = p + v T + a T^2/2; z = p + noise
//   error:     R = R^ exp(phi), v = v^ + dv, p = p^ + dp: the error-state filter  [Sola 2017, 5]
//   invariant: (R, v, p) = (R^, v^, p^) exp(phi, rho_v, rho_p) in SE_2(3), biases beside it [Barrau, Bonnabel 2017]

#include <credence/filters.hpp>
#include <credence/own_world.hpp>

struct Ins {
    struct Settings {
        int rate = 100;
        double speed = 10, radius = 50, sigma_gps = 1, gyro = 2e-3, accelerometer = 0.02, walk = 5e-3;
        double tilt = 0.02, heading = 0.5, gyro_bias = 2e-3, accelerometer_bias = 0.05;
    };
    static constexpr const char* name = "ins";
    static constexpr const char* sources[] = {"start", "imu", "walk", "gps"};  // of Source in run
    static void keys(credence::OwnKeys<Settings>& keys) {
        keys.integer("sensor.rate", &Settings::rate, 1, 10000, "inertial samples in a second");
        keys.real("sensor.gps", &Settings::sigma_gps, 1e-6, 1e3, "sigma of a position, each axis (m)");
        keys.real("sensor.gyro", &Settings::gyro, 1e-12, 1, "sigma of a sample, each axis (rad/s)");
        keys.real("sensor.accelerometer", &Settings::accelerometer, 1e-12, 10, "sigma of a sample, each axis (m/s^2)");
        keys.real("sensor.walk", &Settings::walk, 1e-9, 1, "sigma of a bias's step, as a share of a sample's (1)");
        keys.real("motion.speed", &Settings::speed, 0, 1e3, "on the circle (m/s)");
        keys.real("motion.radius", &Settings::radius, 1, 1e6, "of the circle (m)");
        keys.real("start.tilt", &Settings::tilt, 1e-6, 1, "sigma of roll and of pitch (rad)");
        keys.real("start.heading", &Settings::heading, 1e-6, 3, "sigma (rad)");
        keys.real("start.gyro_bias", &Settings::gyro_bias, 1e-12, 1, "sigma, each axis (rad/s)");
        keys.real("start.accelerometer_bias", &Settings::accelerometer_bias, 1e-12, 10, "sigma, each axis (m/s^2)");
    }
    static std::vector<credence::Component> components(const Settings&) {
        return {{"phi_x", "rad"}, {"phi_y", "rad"}, {"phi_z", "rad"}, {"v_x", "m/s"}, {"v_y", "m/s"}, {"v_z", "m/s"},
                {"p_x", "m"}, {"p_y", "m"}, {"p_z", "m"}, {"b_gx", "rad/s"}, {"b_gy", "rad/s"}, {"b_gz", "rad/s"},
                {"b_ax", "m/s^2"}, {"b_ay", "m/s^2"}, {"b_az", "m/s^2"}};
    }
    static std::vector<credence::ComponentGroup> groups(const Settings&) {
        return {{"attitude", 0, 3}, {"velocity", 3, 3}, {"position", 6, 3}, {"biases", 9, 6}};
    }
    static int innovation_rows(const Settings&) { return 3; }
    static std::vector<std::string> arms(const Settings&) { return {"error", "invariant"}; }

    template <class Real>
    using Vector = Eigen::Matrix<Real, 3, 1>;
    template <class Real>
    using Turn = Eigen::Matrix<Real, 3, 3>;
    template <class Real>
    using Matrix = Eigen::Matrix<Real, 15, 15>;
    template <class Real>
    using Pose = credence::SE23<Real>;

    template <class Real>
    using Six = Eigen::Matrix<Real, 6, 1>;
    static Vector<double> gravity() { return {0, 0, -9.81}; }

    /// A sample u = (w, f) of the inertial unit, without its biases, moves attitude, velocity and position.
    template <class Real>
    static Pose<Real> moved(const Pose<Real>& X, const Six<Real>& u, double T) {
        const Vector<Real> a = X.rotation.matrix * u.template tail<3>() + gravity();
        Pose<Real> next{X.rotation * credence::SO3<Real>::exp(T * u.template head<3>()), X.vectors};
        next.vectors.col(0) += T * a;
        next.vectors.col(1) += T * X.vectors.col(0) + T * T / 2 * a;
        return next;
    }
    /// Of (phi, v, p, b_g, b_a) over that sample. The unit's noise enters as the biases do, in the last six columns.
    template <class Real>
    static Matrix<Real> motion_jacobian(bool invariant, const Pose<Real>& X, const Six<Real>& u, double T) {
        const Vector<Real> angle = T * u.template head<3>();
        const Turn<Real> back = credence::SO3<Real>::exp(-angle).matrix, I = back.Identity(), O = back.Zero();
        const Turn<Real> along = invariant ? back : I, pushed = invariant ? back : X.rotation.matrix;
        const Turn<Real> tilted = -pushed * credence::cross_matrix(u.template tail<3>());
        Matrix<Real> F = Matrix<Real>::Identity();
        F.template block<3, 9>(0, 0) << back, O, O;
        F.template block<3, 9>(3, 0) << T * tilted, along, O;
        F.template block<3, 9>(6, 0) << T * T / 2 * tilted, T * along, along;
        F.template block<3, 3>(0, 9) = -T * credence::right_jacobian<credence::SO3<Real>>(angle);
        F.template block<6, 3>(3, 12) << -T * pushed, -T * T / 2 * pushed;
        return F;
    }
    template <class Real>
    static Pose<Real> corrected(bool invariant, const Pose<Real>& X, const Eigen::Matrix<Real, 9, 1>& step) {
        if (invariant) return X * Pose<Real>::exp(step);
        Pose<Real> next{X.rotation * credence::SO3<Real>::exp(step.template head<3>()), X.vectors};
        for (int j = 0; j < 2; ++j) next.vectors.col(j) += step.template segment<3>(3 + 3 * j);
        return next;
    }
    /// The step from Y to X.
    template <class Real>
    static Eigen::Matrix<Real, 9, 1> difference(bool invariant, const Pose<Real>& X, const Pose<Real>& Y) {
        Eigen::Matrix<Real, 9, 1> e = (Y.inverse() * X).log();
        const auto apart = (X.vectors - Y.vectors).eval();
        for (int j = 0; j < 2 && !invariant; ++j) e.template segment<3>(3 + 3 * j) = apart.col(j);
        return e;
    }

    template <class Real>
    static void run(const Settings& s, credence::OwnTrialOf<Real>& trial) {
        enum Source { start, unit, walk, gps };
        const bool invariant = trial.arm() == 1;
        const double T = 1.0 / s.rate, turning = s.speed / s.radius, push = s.speed * turning;
        const auto draw = [&](int source, int k, int index) {
            Six<Real> six;
            for (int i = 0; i < 3; ++i) six.template segment<2>(2 * i) = trial.normal(source, k, 3 * index + i);
            return six;
        };
        Eigen::Matrix<double, 15, 1> sigma;
        sigma << s.tilt, s.tilt, s.heading, Six<double>::Constant(0.1), Vector<double>::Constant(s.gyro_bias),
            Vector<double>::Constant(s.accelerometer_bias);
        Six<double> noise;
        noise << Vector<double>::Constant(s.gyro), Vector<double>::Constant(s.accelerometer);
        const Vector<double> R = Vector<double>::Constant(s.sigma_gps * s.sigma_gps);
        Eigen::Matrix<Real, 15, 1> wrong, error;
        wrong << draw(start, 0, 0), draw(start, 0, 1), draw(start, 0, 2).template head<3>();
        wrong = sigma.asDiagonal() * wrong;
        Pose<Real> estimate;
        estimate.vectors(0, 0) = s.speed;
        Pose<Real> X = corrected<Real>(false, estimate, wrong.template head<9>());
        Six<Real> biases = Six<Real>::Zero(), b = wrong.template tail<6>();
        Matrix<Real> P = sigma.cwiseAbs2().cast<Real>().asDiagonal();
        for (int k = 1; k < trial.poses(); ++k) {
            for (int sample = 0; sample < s.rate; ++sample) {
                const double angle = turning * T * ((k - 1) * s.rate + sample);
                const Vector<double> a(-push * credence::sin(angle), push * credence::cos(angle), 0);
                Six<Real> u;
                u << Real(0), Real(0), Real(turning), X.rotation.matrix.transpose() * (a - gravity());
                const Six<Real> seen = u + b + noise.asDiagonal() * draw(unit, k, sample) - biases;
                X = moved(X, u, T);
                b += s.walk * noise.asDiagonal() * draw(walk, k, sample);
                const Matrix<Real> F = motion_jacobian(invariant, estimate, seen, T);
                const Eigen::Matrix<Real, 9, 6> G = F.template topRightCorner<9, 6>() * noise.asDiagonal();
                Matrix<Real> Q = Matrix<Real>::Zero();
                Q.template topLeftCorner<9, 9>() = credence::product_sum(G, G, Eigen::Matrix<double, 9, 9>::Zero());
                Q.template bottomRightCorner<6, 6>().diagonal() = (s.walk * noise).cwiseAbs2().cast<Real>();
                P = credence::predicted_covariance(F, P, Q);
                estimate = moved(estimate, seen, T);
            }
            const Vector<Real> z = X.vectors.col(1) + s.sigma_gps * draw(gps, k, 0).template head<3>();
            Eigen::Matrix<Real, 3, 15> H = Eigen::Matrix<Real, 3, 15>::Zero();
            H.template middleCols<3>(6) = invariant ? estimate.rotation.matrix : Turn<Real>::Identity().eval();
            const auto update = credence::sequential_update(P, z - estimate.vectors.col(1), H, R);
            estimate = corrected<Real>(invariant, estimate, update.step.template head<9>());
            biases += update.step.template tail<6>();
            P = update.P;
            error << difference(invariant, estimate, X), biases - b;
            trial.step(error, P, update.innovation, update.S);
        }
    }
};

CREDENCE_WORLD(Ins);
