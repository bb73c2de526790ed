#pragma once
// The model of the world `polygon` [docs/polygon.md]: settings, features and their mesh, rotations, what is seen.

#include <credence/own_world.hpp>
#include <credence/planning.hpp>

struct PolygonModel {
    enum class Variant { mended, published };
    enum class Switch { variant, mended, published };
    enum class Noise { constant, ranged };
    enum class Arms { all, paths };
    struct Settings {
        Variant variant = Variant::mended;
        Switch roll = Switch::variant, motion = Switch::variant, sigma = Switch::variant, jacobian = Switch::variant,
               breath = Switch::variant, tails = Switch::variant, edges = Switch::variant;
        Noise noise = Noise::constant;
        Arms arms = Arms::all;
    };
    static void keys(credence::OwnKeys<Settings>& keys) {
        const std::vector<std::string> switches{"variant", "mended", "published"};
        keys.choice("model.variant", &Settings::variant, {"mended", "published"}, "with the flaws, or without");
        keys.choice("flaw.roll", &Settings::roll, switches, "the limit of roll tests the yaw of the same place");
        keys.choice("flaw.motion", &Settings::motion, switches, "the planner prices a move that is turned twice");
        keys.choice("flaw.sigma", &Settings::sigma, switches, "the planner believes sigma 0.05, not 0.03 (constant)");
        keys.choice("flaw.jacobian", &Settings::jacobian, switches, "a rotation's derivative keeps 1 on its axis");
        keys.choice("flaw.breath", &Settings::breath, switches, "the features' jitter is drawn anew, not a walk");
        keys.choice("flaw.tails", &Settings::tails, switches, "draws beyond 2 sigma are drawn again");
        keys.choice("flaw.edges", &Settings::edges, switches, "the edges' noise is drawn once in a trial");
        keys.choice("sensor.noise", &Settings::noise, {"constant", "ranged"}, "of a sighting");
        keys.choice("arms.which", &Settings::arms, {"all", "paths"}, "with the planners, or without");
    }
    /// Whether the system has a flaw.
    static bool has(const Settings& s, Switch Settings::* flaw) {
        return s.*flaw == Switch::variant ? s.variant == Variant::published : s.*flaw == Switch::published;
    }
    static constexpr int features = 14, n = 6 + 3 * features, contrasts = features - 1;
    static constexpr int rows = 3 * (features + contrasts);

    template <class Real>
    using Vector = credence::Vector3<Real>;
    template <class Real>
    using Square = Eigen::Matrix<Real, 3, 3>;
    template <class Real>
    using State = Eigen::Matrix<Real, n, 1>;
    template <class Real>
    using Covariance = Eigen::Matrix<Real, n, n>;
    template <class Real>
    using Points = Eigen::Matrix<Real, 3, features>;
    static constexpr double sigma_angle = 0.01, sigma_move = 0.02, sigma_walk = 0.003, sigma_breath = 0.005;
    static constexpr double sigma_edge = 0.5, limit = credence::pi / 6, free_distance = 0.3;
    static Eigen::Matrix<double, 6, 1> pose_noise() {
        constexpr double angle = sigma_angle * sigma_angle, move = sigma_move * sigma_move;
        Eigen::Matrix<double, 6, 1> all;
        all << angle, angle, angle, move, move, move;
        return all;
    }
    static constexpr credence::View view{0.1, 3, 0};
    static constexpr credence::Mesh<24> mesh{{{0, 2, 1}, {2, 0, 3}, {2, 7, 1}, {7, 8, 13}, {7, 2, 8}, {8, 2, 3},
        {13, 9, 10}, {13, 8, 9}, {9, 3, 4}, {9, 8, 3}, {3, 0, 4}, {9, 4, 10}, {0, 6, 1}, {6, 0, 5}, {6, 7, 1},
        {7, 12, 13}, {7, 6, 12}, {12, 6, 5}, {13, 11, 10}, {13, 12, 11}, {11, 5, 4}, {11, 12, 5}, {5, 0, 4},
        {11, 4, 10}}};

    /// The features at rest, and the directions in which they breathe.
    static Points<double> rest(bool outward) {
        constexpr double ring[6][2] = {{0, -1}, {0.5, -0.5}, {0.5, 0.5}, {0, 1}, {-0.5, 0.5}, {-0.5, -0.5}};
        Points<double> all = Points<double>::Zero();
        for (int j = 1; j < features - 1; ++j) {
            const auto& [x, y] = ring[(j - 1) % 6];
            all.col(j) << x, y, outward ? 0 : j < 7 ? 1 : 3;
            if (outward) all.col(j).normalize();
        }
        all(2, features - 1) = outward ? 1 : 4;
        if (!outward) all.row(0).array() += 1.5;
        return all;
    }
    /// How far they are out at pose k.
    static double breathed(int k) {
        constexpr double amounts[] = {0.2, 0.4, 0.6, 0.6, 0.4, 0.2};
        return amounts[k % 6];
    }

    template <class Real>
    static credence::EulerRotation<Real> turned(const Vector<Real>& angles, bool flawed) {
        credence::EulerRotation<Real> all(angles);
        if (flawed) {
            all.derivative[0].col(0) += all.R.col(0);
            all.derivative[1] += all.z.col(1) * all.x.row(1);
            all.derivative[2].row(2) += all.R.row(2);
        }
        return all;
    }
    template <class Real>
    static Vector<Real> wrapped(const Vector<Real>& angles) {
        return {credence::wrapped(angles(0)), credence::wrapped(angles(1)), credence::wrapped(angles(2))};
    }
    /// dp/dangles of R move
    template <class Real, class Move>
    static Square<Real> bend(const credence::EulerRotation<Real>& at, const Move& move) {
        Square<Real> D;
        for (int k = 0; k < 3; ++k) D.col(k) = at.derivative[static_cast<std::size_t>(k)] * move;
        return D;
    }
    /// The columns of a sighting's Jacobian for the angles, multiplied by R.
    template <class Real>
    static Square<Real> swing(const credence::EulerRotation<Real>& at, const Vector<Real>& delta) {
        Square<Real> all;
        for (int k = 0; k < 3; ++k)
            all.col(k) = at.R * (at.derivative[static_cast<std::size_t>(k)].transpose() * delta);
        return all;
    }
    template <class Real>
    static Real sigma_of(const Settings& s, const Real& distance, double constant) {
        if (s.noise == Noise::constant) return Real(constant);
        return 0.01 + 0.08 / 2.9 * credence::max(Real(0), Real(distance - 0.1));
    }

    /// What is seen from p along the first column of R, and the sigma of each sighting.
    template <class Real>
    struct Look {
        std::array<credence::Mask<Real>, features> seen;
        std::array<Real, features> sigma;

        template <class Scalar>
        Look(const Settings& s, double constant, const Points<Scalar>& f, const Vector<Real>& p,
             const Vector<Real>& x) {
            using namespace credence;
            const MeshView<Real, 24> from(mesh, f, p);
            for (int j = 0; j < features; ++j) {
                const Vector<Real> target = f.col(j).template cast<Real>(), delta = target - p;
                const Real distance = credence::sqrt(Real(delta.squaredNorm()));
                const auto place = static_cast<std::size_t>(j);
                sigma[place] = sigma_of(s, distance, constant);
                seen[place] = in_view(view, Real(x.dot(delta)), distance);
                if (any(seen[place])) seen[place] = both(seen[place], negated(from.blocked(target, j)));
            }
        }
    };
};
