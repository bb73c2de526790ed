#pragma once
// A world of one's own: a target that moves with nearly constant velocity, seen by its position, and two filters for
// it.
//
//   x = [p_x, p_y, v_x, v_y]   p in m, v in m/s; T  time between steps (s)
//   x_k = F x_{k-1} + G a_k,   F = [I, T I; 0, I],  G = [T^2/2 I; T I],  a ~ N(0, acceleration^2 I)
//   z_k = p_k + sigma w_k,     every `seen` steps on average
// Kalman filter: [Bar-Shalom, Li, Kirubarajan 2001, 5.2, 6.3.2]

#include <credence/own_world.hpp>

struct Tracker {
    struct Settings {
        double period = 1;            ///< T (s)
        double acceleration = 0.2;    ///< of the target, each axis (m/s^2)
        double sigma = 2;             ///< of a measured position, each axis (m)
        double detection = 0.9;       ///< probability that a step has a measurement
    };

    static constexpr const char* name = "tracker";

    /// Of the draws, by their numbers in `run`.
    static constexpr const char* sources[] = {"initial_position", "initial_velocity", "acceleration", "measurement",
                                              "detection"};

    static void keys(credence::OwnKeys<Settings>& keys) {
        keys.real("target.period", &Settings::period, 1e-3, 1e3, "T, time between steps (s)");
        keys.real("target.acceleration", &Settings::acceleration, 1e-6, 1e3, "sigma of the acceleration (m/s^2)");
        keys.real("sensor.sigma", &Settings::sigma, 1e-6, 1e6, "sigma of a measured position (m)");
        keys.real("sensor.detection", &Settings::detection, 0, 1, "probability that a step has a measurement");
    }

    static std::vector<credence::Component> components(const Settings&) {
        return {{"p_x", "m"}, {"p_y", "m"}, {"v_x", "m/s"}, {"v_y", "m/s"}};
    }
    static std::vector<credence::ComponentGroup> groups(const Settings&) {
        return {{"position", 0, 2}, {"velocity", 2, 2}};
    }
    static int innovation_rows(const Settings&) { return 2; }

    /// `kf` knows the model; `calm` assumes a fifth of the true Q, a common mistake.
    static std::vector<std::string> arms(const Settings&) { return {"kf", "calm"}; }

    static std::vector<credence::Column> columns(const Settings&) {
        return {{"measurements", "steps with a measurement", "1", credence::ColumnType::integer, -1}};
    }

    template <class Real>
    static void run(const Settings& s, credence::OwnTrialOf<Real>& trial) {
        // Sources of draws: any numbers from 0 to 15, each used for one purpose only.
        enum Source { initial_position, initial_velocity, acceleration, measurement, detection };
        using Position = Eigen::Matrix<Real, 2, 1>;
        using State = Eigen::Matrix<Real, 4, 1>;
        const Model model(s);
        const double believed = trial.arm() == 0 ? 1 : 0.2;

        State x;
        x << 50 * trial.normal(initial_position, 0), 5 * trial.normal(initial_velocity, 0);
        State estimate = State::Zero();
        Eigen::Matrix<Real, 4, 4> P = State(2500, 2500, 25, 25).asDiagonal();
        credence::CountedCovariance<Real, 4, 5> counted;  // for `credence budget`
        counted.parts[initial_position].diagonal() << 2500, 2500, 0, 0;
        counted.parts[initial_velocity].diagonal() << 0, 0, 25, 25;
        Real measurements = 0;
        for (int k = 1; k < trial.poses(); ++k) {
            x = model.F * x + model.G * (s.acceleration * trial.normal(acceleration, k));

            estimate = model.F * estimate;
            P = model.F * P * model.F.transpose() + believed * model.Q;
            const Position z = x.template head<2>() + s.sigma * trial.normal(measurement, k);
            const Position innovation = z - estimate.template head<2>();
            const Eigen::Matrix<Real, 2, 2> S = P.template topLeftCorner<2, 2>() + model.R;
            // Where there is no measurement, a gain of 0 leaves the belief as it is.
            const auto seen = trial.uniform(detection, k) < s.detection;
            const Eigen::Matrix<Real, 4, 2> K = credence::select(seen, P.template leftCols<2>() * S.inverse(), 0);
            estimate += K * innovation;
            P -= K * S * K.transpose();
            if (trial.counting()) {
                counted.predict(model.F);
                counted.parts[acceleration] += believed * model.Q;
                counted.update(K, Eigen::Matrix<double, 2, 4>::Identity(), model.R, measurement);
                for (int source = 0; source < 5; ++source) trial.counts(source, counted.parts[source]);
            }
            trial.step(estimate - x, P, innovation, S, seen);
            measurements += credence::select(seen, Real(1), Real(0));
        }
        trial.set(0, measurements);
    }

private:
    struct Model {
        Eigen::Matrix4d F = Eigen::Matrix4d::Identity(), Q;
        Eigen::Matrix<double, 4, 2> G;
        Eigen::Matrix2d R;

        explicit Model(const Settings& s) {
            const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
            F.topRightCorner<2, 2>() = s.period * I;
            G << s.period * s.period / 2 * I, s.period * I;
            Q = s.acceleration * s.acceleration * G * G.transpose();
            R = s.sigma * s.sigma * I;
        }
    };
};

CREDENCE_WORLD(Tracker);
