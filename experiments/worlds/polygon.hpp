#pragma once
// The document's successor in three dimensions: a robot with six degrees of freedom sees 14 features of a breathing
// polyhedron, which hides some of them, and plans its way by the trace of its covariance [docs/polygon.md].
//
//   x = (roll, pitch, yaw, p, f_0 ... f_13), n = 48; R body to world; pose: angles += turn + noise, p += R move + noise
//   sightings R'(f_j - p) + v of what is in range, ahead and not hidden; differences f_b - f_a + v of all pairs, always
// As published the system has seven flaws, each with a key; mended, the planner's candidates and costs are the same.
//
// Sightings are multiplied by R^, as their noise is the same along all axes. The differences are measured before the
// prediction of the pose, which they do not touch, as 13 contrasts of each axis: f_1 + ... + f_c - c f_{c+1}, scaled.

#include "polygon_planner.hpp"

struct Polygon : PolygonPlanner {
    static constexpr const char* name = "polygon";
    static constexpr const char* sources[] = {"robot", "walk", "breath", "sight", "edges"};  // of Source in run
    static std::vector<credence::Component> components(const Settings&) {
        std::vector<credence::Component> all{{"roll", "rad"}, {"pitch", "rad"}, {"yaw", "rad"}};
        for (const char* axis : {"x", "y", "z"}) all.push_back({std::string("p_") + axis, "cm"});
        for (int j = 0; j < features; ++j)
            for (const char* axis : {"x", "y", "z"}) all.push_back({"f" + std::to_string(j) + "_" + axis, "cm"});
        return all;
    }
    static std::vector<credence::ComponentGroup> groups(const Settings&) {
        return {{"pose", 0, 6}, {"rotation", 0, 3}, {"position", 3, 3}, {"features", 6, n - 6}};
    }
    static int innovation_rows(const Settings&) { return rows; }
    static std::vector<credence::Column> columns(const Settings&) {
        using enum credence::ColumnType;
        return {{"unseen", "features out of sight, summed over the steps", "1", integer, 0},
                {"seen_last", "features in sight at the last step", "1", integer, 0},
                {"stuck", "steps without an admissible candidate", "1", integer, 0},
                {"clearance", "least distance of the robot from the mesh", "cm", real, 0},
                {"rolled", "steps with a roll beyond 30 degrees", "1", integer, 0},
                {"position_error", "norm of the position's error, mean over the steps", "cm", real, 0},
                {"rotation_error", "angle between estimate and truth, mean over the steps", "rad", real, 0},
                {"feature_error", "RMS of the features' errors, mean over the steps", "cm", real, 0}};
    }

    /// `count` draws of one source at pose k.
    template <int count, class Real>
    static Eigen::Matrix<Real, count, 1> draws(const Settings& s, const credence::OwnTrialOf<Real>& trial, int source,
                                               int k) {
        const bool truncated = has(s, &Settings::tails);
        Eigen::Matrix<Real, count + count % 2, 1> all;
        for (int i = 0; 2 * i < count; ++i)
            all.template segment<2>(2 * i) = truncated ? credence::truncated_normal(trial, 2, source, k, i, 256)
                                                       : trial.normal(source, k, i);
        return all.template head<count>();
    }
    /// The noise of the edges about each feature: m_j = (sum over a < j of v_aj - sum over b > j of v_jb) / 14.
    template <class Real>
    static Points<Real> edge_noise(const Settings& s, const credence::OwnTrialOf<Real>& trial, int source, int k) {
        const auto all = draws<3 * features * contrasts / 2>(s, trial, source, has(s, &Settings::edges) ? 0 : k);
        Points<Real> sums = Points<Real>::Zero();
        for (int a = 0, pair = 0; a < features; ++a)
            for (int b = a + 1; b < features; ++b, ++pair) {
                sums.col(b) += all.template segment<3>(3 * pair);
                sums.col(a) -= all.template segment<3>(3 * pair);
            }
        return sums * (sigma_edge / features);
    }

    template <class Real>
    static void run(const Settings& s, credence::OwnTrialOf<Real>& trial) {
        using namespace credence;
        enum Source { robot, walk, breath_of, sight, edge };
        const Points<double> outward = rest(true);
        const Candidates candidates = all_candidates(s);
        Goals<Real> goals;
        Points<Real> walked = rest(false).cast<Real>(), f = walked + (breathed(0) * outward).cast<Real>();
        if (has(s, &Settings::breath)) f += sigma_breath * draws<n - 6>(s, trial, breath_of, 0).reshaped(3, features);
        Vector<Real> angles = Vector<Real>::Zero(), p = angles, unseen = angles, errors = angles;
        Real stuck = 0, rolled = 0, seen_last = 0, clearance = std::numeric_limits<double>::infinity();

        State<Real> x = State<Real>::Zero();
        Covariance<Real> P = Covariance<Real>::Zero();
        const auto first = draws<n - 6>(s, trial, sight, 0);
        for (int j = 0; j < features; ++j) {
            const Real each = sigma_of(s, credence::sqrt(Real(f.col(j).squaredNorm())), 0.03);
            x.template segment<3>(6 + 3 * j) = f.col(j) + each * first.template segment<3>(3 * j);
            P.diagonal().template segment<3>(6 + 3 * j).setConstant(each * each);
        }
        Eigen::Matrix<Real, rows, 1> innovation;
        Eigen::Matrix<Real, rows, rows> S = Eigen::Matrix<Real, rows, rows>::Identity();
        for (int k = 1; k < trial.poses(); ++k) {
            const Points<double> increment = (breathed(k) - breathed(k - 1)) * outward;
            walked += sigma_walk * draws<n - 6>(s, trial, walk, k - 1).reshaped(3, features);
            const Points<Real> jitter = sigma_breath * draws<n - 6>(s, trial, breath_of, k).reshaped(3, features);
            if (!has(s, &Settings::breath)) walked += jitter;
            f = walked + (breathed(k) * outward).cast<Real>();
            if (has(s, &Settings::breath)) f += jitter;

            // The features, and the edges between them.
            State<Real> step = State<Real>::Zero();
            P.diagonal().template tail<n - 6>().array() += sigma_walk * sigma_walk + sigma_breath * sigma_breath;
            const Points<Real> expected = x.template tail<n - 6>().reshaped(3, features) + increment.cast<Real>();
            const Points<Real> off = f - expected + edge_noise(s, trial, edge, k);
            for (int c = 1; c < features; ++c)
                for (int axis = 0; axis < 3; ++axis) {
                    Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, features> U(c + 1);
                    std::array<int, features> places;
                    Eigen::Matrix<Real, 1, 1> nu(Real(0));
                    for (int j = 0; j <= c; ++j) {
                        U(j) = (j < c ? 1 : -c) / std::sqrt(c * (c + 1.0));
                        places[static_cast<std::size_t>(j)] = 6 + 3 * j + axis;
                        nu(0) += U(j) * off(axis, j);
                    }
                    const auto given = update_in_place(P, step, places.data(), U, nu,
                                                       Real(sigma_edge * sigma_edge / features), all_lanes<Real>());
                    const int row = 3 * (features + c - 1) + axis;
                    innovation(row) = given.nu(0);
                    S(row, row) = given.S(0);
                }
            P.template triangularView<Eigen::StrictlyUpper>() = P.transpose();

            // The control, the robot, and its prediction.
            const Vector<Real> believed = x.template head<3>();
            const auto before = turned(believed, has(s, &Settings::jacobian));
            const Control<Real> control = chosen(s, trial.arm(), candidates, x, P, increment, before, goals,
                                                 k);
            stuck += select(control.stuck, Real(1), Real(0));
            const auto noise = draws<6>(s, trial, robot, k);
            p += turned(angles, false).R * control.move + sigma_move * noise.template tail<3>();
            angles = wrapped(Vector<Real>(angles + control.turn + sigma_angle * noise.template head<3>()));
            x.template head<3>() = wrapped(Vector<Real>(believed + control.turn));
            x.template segment<3>(3) += before.R * control.move;
            x.template tail<n - 6>() = expected.reshaped();
            const Square<Real> D = bend(before, control.move);
            step.template segment<3>(3) += (D * step.template head<3>()).eval();
            P.template middleRows<3>(3) += (D * P.template topRows<3>()).eval();
            P.template middleCols<3>(3) += (P.template leftCols<3>() * D.transpose()).eval();
            P.diagonal().template head<6>() += pose_noise();

            // What is seen.
            const Square<Real> R = turned(angles, false).R;
            const auto after = turned(Vector<Real>(x.template head<3>()), has(s, &Settings::jacobian));
            const Look<Real> look(s, 0.03, f, p, R.col(0));
            const auto drawn = draws<n - 6>(s, trial, sight, k);
            seen_last = 0;
            for (int j = 0; j < features; ++j) {
                const auto place = static_cast<std::size_t>(j);
                const Mask<Real> seen = look.seen[place];
                innovation.template segment<3>(3 * j).setConstant(std::numeric_limits<double>::quiet_NaN());
                seen_last += select(seen, Real(1), Real(0));
                if (!any(seen)) continue;
                const Vector<Real> delta = x.template segment<3>(6 + 3 * j) - x.template segment<3>(3);
                const Vector<Real> noisy = look.sigma[place] * drawn.template segment<3>(3 * j);
                const Vector<Real> z = R.transpose() * (f.col(j) - p) + noisy;
                Eigen::Matrix<Real, 3, 9> H;
                H << swing(after, delta), -Square<Real>::Identity(), Square<Real>::Identity();
                const int places[] = {0, 1, 2, 3, 4, 5, 6 + 3 * j, 7 + 3 * j, 8 + 3 * j};
                const auto given = update_in_place(P, step, places, H, Vector<Real>(after.R * z - delta),
                                                   Real(look.sigma[place] * look.sigma[place]), seen);
                innovation.template segment<3>(3 * j) =
                    select(seen, given.nu, innovation.template segment<3>(3 * j));
                S.template block<3, 3>(3 * j, 3 * j) = given.S;
            }
            x += step;
            x.template head<3>() = wrapped(Vector<Real>(x.template head<3>()));

            State<Real> error = x;
            error.template head<3>() = wrapped(Vector<Real>(x.template head<3>() - angles));
            error.template segment<3>(3) -= p;
            error.template tail<n - 6>() -= f.reshaped();
            trial.step(error, P, innovation, S);
            const Real cosine = 0.5 * (R.cwiseProduct(turned(Vector<Real>(x.template head<3>()), false).R).sum() - 1);
            const Real sine = credence::sqrt(max(Real(0), Real(1 - cosine * cosine)));
            errors += Vector<Real>(credence::sqrt(Real(error.template segment<3>(3).squaredNorm())),
                                   credence::atan2(sine, cosine),
                                   credence::sqrt(Real(error.template tail<n - 6>().squaredNorm() / features)));
            unseen(0) += features - seen_last;
            rolled += select(credence::abs(angles(0)) > Real(limit), Real(1), Real(0));
            clearance = min(clearance, MeshFaces<Real, 24>(mesh, f).clearance(p));
        }
        const Real steps = trial.poses() - 1;
        const Real all[] = {unseen(0), seen_last, stuck, clearance, rolled, errors(0) / steps, errors(1) / steps,
                            errors(2) / steps};
        for (std::size_t i = 0; i < std::size(all); ++i) trial.set(i, all[i]);
    }
};

CREDENCE_WORLD(Polygon);
