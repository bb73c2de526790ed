#pragma once
// A ship that hears another one's bearing, and nothing else, until it changes its own course: the same extended Kalman
// filter in Cartesian and in modified polar coordinates.
//
//   x = (r_x, r_y, v_x, v_y)  place and velocity of the target seen from the observer (m, m/s), the observer's own
//                             changes of velocity known; noise: an acceleration of the target over each step
//   y = (closing v.r/|r|^2, turning r x v/|r|^2, bearing, 1/|r|)   modified polar coordinates [Aidala, Hammel 1983]
//   z = bearing + v. As complex numbers, r = e^(i bearing)/y_4 and v = (closing + i turning) r.

#include <credence/filters.hpp>
#include <credence/own_world.hpp>

struct BearingsOnly {
    enum class Chart { polar, cartesian };
    struct Settings {
        double period = 10, range = 10000, target_speed = 5, own_speed = 5, acceleration = 1e-4;
        double sigma_range = 0.2, sigma_speed = 1, sigma_bearing = 0.005;
        int manoeuvre = 30;
        Chart chart = Chart::polar;
    };
    static constexpr const char* name = "bearings_only";
    static constexpr const char* sources[] = {"rates", "place", "acceleration", "sensor"};  // of Source in run
    static void keys(credence::OwnKeys<Settings>& keys) {
        keys.real("motion.period", &Settings::period, 1e-3, 1e4, "T, time between bearings (s)");
        keys.real("motion.range", &Settings::range, 1, 1e6, "first range on average, north (m)");
        keys.real("motion.target", &Settings::target_speed, 0, 1e3, "the target's speed on average, west (m/s)");
        keys.real("motion.observer", &Settings::own_speed, 0, 1e3, "the observer's speed, east and later west (m/s)");
        keys.integer("motion.manoeuvre", &Settings::manoeuvre, 1, 100000, "step at which the observer turns round");
        keys.real("noise.acceleration", &Settings::acceleration, 1e-9, 10, "sigma of the target's, each axis (m/s^2)");
        keys.real("start.range", &Settings::sigma_range, 1e-6, 1, "sigma of the first 1/range, as a share of it (1)");
        keys.real("start.speed", &Settings::sigma_speed, 1e-6, 1e3, "sigma of the rates times the range (m/s)");
        keys.real("sensor.bearing", &Settings::sigma_bearing, 1e-6, 1, "sigma of a bearing", "rad");
        keys.choice("filter.chart", &Settings::chart, {"polar", "cartesian"}, "in which both filters are judged");
    }
    static std::vector<credence::Component> components(const Settings& s) {
        if (s.chart == Chart::cartesian) return {{"r_x", "m"}, {"r_y", "m"}, {"v_x", "m/s"}, {"v_y", "m/s"}};
        return {{"closing", "1/s"}, {"turning", "rad/s"}, {"bearing", "rad"}, {"inverse_range", "1/m"}};
    }
    static std::vector<credence::ComponentGroup> groups(const Settings& s) {
        if (s.chart == Chart::cartesian) return {{"place", 0, 2}, {"velocity", 2, 2}};
        return {{"rates", 0, 2}, {"bearing", 2, 1}, {"inverse_range", 3, 1}};
    }
    static int innovation_rows(const Settings&) { return 1; }
    static std::vector<std::string> arms(const Settings&) { return {"cartesian", "polar"}; }
    static std::vector<credence::Column> columns(const Settings&) {
        return {{"range_error", "last estimated range - true range", "m"}};
    }

    template <class Real>
    using Vector = Eigen::Matrix<Real, 4, 1>;
    template <class Real>
    using Matrix = Eigen::Matrix<Real, 4, 4>;
    template <class Real>
    using Plane = Eigen::Matrix<Real, 2, 1>;
    /// Multiplication by the complex number z.
    template <class Real>
    static Eigen::Matrix<Real, 2, 2> times(const Plane<Real>& z) {
        Eigen::Matrix<Real, 2, 2> all;
        all << z(0), -z(1), z(1), z(0);
        return all;
    }
    template <class Real>
    static Vector<Real> polar(const Vector<Real>& x) {
        const Plane<Real> r = x.template head<2>(), v = x.template tail<2>();
        const Real square = r.squaredNorm();
        const Plane<Real> rates = times(r).transpose() * v / square;
        return {rates(0), rates(1), credence::atan2(r(1), r(0)), Real(1) / credence::sqrt(square)};
    }
    template <class Real>
    static Vector<Real> cartesian(const Vector<Real>& y) {
        const Plane<Real> r = Plane<Real>(credence::cos(y(2)), credence::sin(y(2))) / y(3);
        Vector<Real> x;
        x << r, times(r) * y.template head<2>();
        return x;
    }
    /// dy/dx: d(log r) = dr/r, d(rates) = (dv - rates dr)/r, as complex numbers.
    template <class Real>
    static Matrix<Real> polar_jacobian(const Vector<Real>& x) {
        const Vector<Real> y = polar(x);
        const Plane<Real> r = x.template head<2>();
        const Eigen::Matrix<Real, 2, 2> inverse = times(r).transpose() / r.squaredNorm();
        Matrix<Real> J = Matrix<Real>::Zero();
        J.template topLeftCorner<2, 2>() = -inverse * times<Real>(y.template head<2>());
        J.template topRightCorner<2, 2>() = inverse;
        J.template block<1, 2>(2, 0) = inverse.row(1);
        J.template block<1, 2>(3, 0) = -y(3) * inverse.row(0);
        return J;
    }
    /// dx/dy: dr = r (i dbearing - dy_4/y_4), dv = rates dr + r drates.
    template <class Real>
    static Matrix<Real> cartesian_jacobian(const Vector<Real>& y) {
        const Plane<Real> r = cartesian(y).template head<2>();
        Matrix<Real> J = Matrix<Real>::Zero();
        J.template topRightCorner<2, 2>() << -r(1), -r(0) / y(3), r(0), -r(1) / y(3);
        J.template bottomLeftCorner<2, 2>() = times(r);
        J.template bottomRightCorner<2, 2>() = times<Real>(y.template head<2>()) * J.template topRightCorner<2, 2>();
        return J;
    }

    template <class Real>
    static void run(const Settings& s, credence::OwnTrialOf<Real>& trial) {
        enum Source { rates, place, acceleration, sensor };
        const double T = s.period;
        const bool in_polar = trial.arm() == 1, judged_in_polar = s.chart == Chart::polar;
        Matrix<double> F = Matrix<double>::Identity();
        F.topRightCorner<2, 2>().diagonal().setConstant(T);
        Eigen::Matrix<double, 4, 2> G;
        G << T / 2 * Eigen::Matrix2d::Identity(), Eigen::Matrix2d::Identity();
        G *= s.acceleration * T;
        const Matrix<double> Q = G * G.transpose();
        const Eigen::Matrix<double, 1, 1> R(s.sigma_bearing * s.sigma_bearing);

        const double slow = s.sigma_speed / s.range;
        const Vector<double> sigma(slow, slow, s.sigma_bearing, s.sigma_range / s.range);
        Vector<Real> drawn, x_hat = Vector<double>(0, s.range, -s.target_speed - s.own_speed, 0).cast<Real>();
        drawn << trial.normal(rates, 0), trial.normal(place, 0);
        Vector<Real> y_hat = polar(x_hat), x = cartesian<Real>(y_hat + sigma.asDiagonal() * drawn);
        Matrix<Real> P = sigma.cwiseAbs2().cast<Real>().asDiagonal();
        if (!in_polar) P = credence::predicted_covariance(cartesian_jacobian(y_hat), P);
        for (int k = 1; k < trial.poses(); ++k) {
            const Vector<double> turned(0, 0, k == s.manoeuvre ? 2 * s.own_speed : 0, 0);
            x = F * x + G * trial.normal(acceleration, k) + turned;
            Matrix<Real> of_chart = F.cast<Real>();
            if (in_polar) of_chart = F * cartesian_jacobian(y_hat);
            x_hat = F * x_hat + turned;
            y_hat = polar(x_hat);
            Matrix<Real> to_chart = Matrix<Real>::Identity();
            if (in_polar) to_chart = polar_jacobian(x_hat);
            P = credence::predicted_covariance(to_chart * of_chart, P, credence::predicted_covariance(to_chart, Q));

            const Real z = polar(x)(2) + s.sigma_bearing * trial.normal(sensor, k)(0);
            const Eigen::Matrix<Real, 1, 1> innovation(credence::wrapped(z - y_hat(2)));
            Eigen::Matrix<Real, 1, 4> H = Eigen::Matrix<Real, 1, 4>::Unit(2);
            if (!in_polar) H = polar_jacobian(x_hat).row(2);
            const auto update = credence::kalman_update(P, innovation, H, R);
            P = update.P;
            x_hat = in_polar ? cartesian<Real>(y_hat + update.step) : Vector<Real>(x_hat + update.step);
            y_hat = in_polar ? Vector<Real>(y_hat + update.step) : polar(x_hat);

            Vector<Real> error = judged_in_polar ? Vector<Real>(y_hat - polar(x)) : Vector<Real>(x_hat - x);
            if (judged_in_polar) error(2) = credence::wrapped(error(2));
            Matrix<Real> judged = Matrix<Real>::Identity();
            if (judged_in_polar && !in_polar) judged = polar_jacobian(x_hat);
            if (!judged_in_polar && in_polar) judged = cartesian_jacobian(y_hat);
            trial.step(error, credence::predicted_covariance(judged, P), update.innovation, update.S);
        }
        trial.set(0, Real(1) / y_hat(3) - Real(1) / polar(x)(3));
    }
};

CREDENCE_WORLD(BearingsOnly);
