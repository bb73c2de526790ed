#pragma once
// The controllers of the world `polygon` [docs/polygon.md]: the authors' helix, the same one turned back half way, the
// greedy planner, which has the candidates of one trial in its lanes, as each sees and clears other things, and the two
// that go from one of the authors' goals to the next: `global` by the nearest candidate, `combined` by the cheapest of
// the tenth of them that are nearest.

#include "polygon_model.hpp"

#include <algorithm>
#include <utility>

struct PolygonPlanner : PolygonModel {
    enum Arm : std::size_t { fixed, back, greedy, global, combined };
    static std::vector<std::string> arms(const Settings& s) {
        if (s.arms == Arms::paths) return {"fixed", "return"};
        return {"fixed", "return", "greedy", "global", "combined"};
    }
    /// The goals of the published runs: the start's, and two from which all features can be seen.
    static Vector<double> goal_at(int place) {
        constexpr double goals[][3] = {{-0.5, 0, 0}, {3.5, -1, 3}, {0.5, 2, 3}};
        const auto& [x, y, z] = goals[place];
        return {x, y, z};
    }
    /// The goals on which the trials of a pack are, which they leave once they believe to be as near as 0.3.
    template <class Real>
    struct Goals {
        int place[credence::lanes<Real>]{};
        Vector<double> of(int lane, const Vector<double>& p) {
            int& at = place[lane];
            if ((goal_at(at) - p).norm() <= 0.3) at = (at + 1) % 3;
            return goal_at(at);
        }
    };

    template <class Real>
    struct Control {
        Vector<Real> turn, move;
        credence::Mask<Real> stuck;  ///< no candidate was admissible, and the robot means to stay where it is
    };
    /// What is chosen from: turn (roll, pitch, yaw), the roll that is tested, the move, and the move that is priced.
    using Candidates = credence::Candidates<10>;

    static Candidates all_candidates(const Settings& s) {
        using credence::pi;
        const std::vector<double> tilts{-pi / 6, 0, pi / 6}, yaws{-pi / 4, -pi / 8, 0, pi / 8, pi / 4};
        const std::vector<double> dx{-0.2, -0.1, 0, 0.1, 0.2}, dz{-0.5, 0, 0.5};
        const credence::Candidates<5> grid(std::array{tilts, tilts, yaws, dx, dz});
        Candidates all;
        for (int i = 0; i < grid.count(); ++i) {
            const Vector<double> turn = grid[i].head<3>();
            const Square<double> r = turned(turn, false).R;
            const Vector<double> move = r * Vector<double>(grid[i](3), 0, grid[i](4));
            const auto place = static_cast<std::size_t>(std::ranges::find(tilts, turn(0)) - tilts.begin());
            Candidates::Control control;
            control << turn, has(s, &Settings::roll) ? yaws[place] : turn(0), move,
                has(s, &Settings::motion) ? Vector<double>(r * move) : move;
            all.add(control);
        }
        return all;
    }

    static Vector<double> helix_turn() { return {0, 0, credence::pi / 12}; }
    static Vector<double> helix_move() { return {0.1, -credence::sqrt(3.0) / 4, 0.075}; }
    /// To where the noiseless helix was as long before its turning point as pose k is behind it.
    template <class Real>
    static Control<Real> turned_back(const State<Real>& x, const credence::EulerRotation<Real>& at, int k) {
        constexpr int turning = 53;
        Vector<double> angles = Vector<double>::Zero(), p = angles;
        for (int i = 0; i < std::max(0, 2 * turning - k); ++i) {
            p += turned(angles, false).R * helix_move();
            angles += helix_turn();
        }
        return {wrapped(Vector<Real>(angles - x.template head<3>())),
                at.R.transpose() * (p - x.template segment<3>(3)), x(0) != x(0)};
    }

    /// The choice of one trial: x [n], P and P P [n, n] of doubles, P after all that no candidate changes.
    template <class Real>
    static credence::Least<double> planned(const Settings& s, std::size_t arm, const Vector<double>& goal,
                                           const Candidates& candidates, const State<double>& x,
                                           const Covariance<double>& P, const Covariance<double>& square,
                                           const Points<double>& increment) {
        using namespace credence;
        const Points<double> now = x.tail<n - 6>().reshaped(3, features), then = now + increment;
        const Vector<double> angles = x.head<3>(), p = x.segment<3>(3);
        const bool flawed = has(s, &Settings::jacobian);
        const double constant = has(s, &Settings::sigma) ? 0.05 : 0.03;
        const auto at = turned(angles, flawed);
        const auto in_lanes = turned(Vector<Real>(angles.cast<Real>()), flawed);
        const MeshFaces<double, 24> near_now(mesh, now), near_then(mesh, then);
        const auto after = [&](const auto& control, int move) {
            return Vector<Real>(at.R * control.template segment<3>(move) + p);
        };

        std::vector<int> list;
        for (int i = 0; i < candidates.count(); ++i)
            if (std::abs(angles(1) + candidates[i](1)) <= limit && std::abs(angles(0) + candidates[i](3)) <= limit)
                list.push_back(i);
        // What the candidates see, and with it the order in which they are computed: lanes that see the same cost less.
        std::vector<std::pair<unsigned, int>> seen;
        each_pack<Real>(list, [&](const Real& index, int used) {
            const auto control = candidates.of_lanes(index);
            const Vector<Real> place = after(control, 4);
            const auto free = both(near_now.clearance(place) > Real(free_distance),
                                   near_then.clearance(place) > Real(free_distance));
            if (!any(free)) return;
            const Vector<Real> turn = control.template head<3>() + angles;
            const Look<Real> look(s, constant, then, after(control, 7), turned(turn, false).R.col(0));
            for (int lane = 0; lane < used; ++lane) {
                if (!(lane_bits(free) >> lane & 1)) continue;
                unsigned bits = 0;
                for (std::size_t j = 0; j < features; ++j) bits |= (lane_bits(look.seen[j]) >> lane & 1) << j;
                seen.emplace_back(bits, static_cast<int>(lane_of(index, lane)));
            }
        });
        if (arm == global || arm == combined) {
            const auto off = [&](const auto& one) {
                return (at.R * candidates[one.second].template segment<3>(4) + p - goal).norm();
            };
            std::ranges::stable_sort(seen, {}, off);
            if (arm == global) {
                Least<double> nearest;
                for (const auto& one : seen)
                    if (off(one) <= off(seen.front()) * (1 + 1e-12)) nearest.take(true, 0, one.second);
                return nearest;
            }
            seen.resize(seen.size() / 10);
        }
        std::ranges::sort(seen);
        std::vector<unsigned> sights(static_cast<std::size_t>(candidates.count()));
        list.clear();
        for (const auto& [bits, index] : seen) {
            sights[static_cast<std::size_t>(index)] = bits;
            list.push_back(index);
        }

        const Foresight<double, 6, 3, features> foresight(P, square);
        return least_of_one<Real>(list, [&](const Real& index) {
            const auto control = candidates.of_lanes(index);
            const Vector<Real> place = after(control, 7), turn = control.template head<3>() + angles;
            const auto rotation = turned(turn, flawed);
            std::array<Eigen::Matrix<Real, 3, 6>, features> rows;
            std::array<Mask<Real>, features> mask;
            std::array<Real, features> variances;
            for (std::size_t j = 0; j < features; ++j) {
                Real sees;
                for (int lane = 0; lane < lanes<Real>; ++lane)
                    set_lane(sees, lane, sights[static_cast<std::size_t>(lane_of(index, lane))] >> j & 1);
                mask[j] = sees > Real(0);
                if (!any(mask[j])) continue;
                const Vector<Real> delta = then.col(static_cast<Eigen::Index>(j)) - place;
                rows[j] << swing(rotation, delta), -Square<Real>::Identity();
                const Real sigma = sigma_of(s, credence::sqrt(Real(delta.squaredNorm())), constant);
                variances[j] = sigma * sigma;
            }
            Eigen::Matrix<Real, 6, 6> F = Eigen::Matrix<Real, 6, 6>::Identity();
            F.template bottomLeftCorner<3, 3>() = bend(in_lanes, control.template segment<3>(7));
            return foresight.trace(F, pose_noise(), rows.data(), variances.data(), mask.data());
        }, 1e-12);  // mended, a roll changes nothing where the move has no vertical part
    }

    /// What the arm does at pose k - 1. P is that after all that the control does not change.
    template <class Real>
    static Control<Real> chosen(const Settings& s, std::size_t arm, const Candidates& candidates, const State<Real>& x,
                                const Covariance<Real>& P, const Points<double>& increment,
                                const credence::EulerRotation<Real>& at, Goals<Real>& goals, int k) {
        if (arm == back && k > 53) return turned_back(x, at, k);
        if (arm < greedy) return {helix_turn().cast<Real>(), helix_move().cast<Real>(), x(0) != x(0)};
        using namespace credence;
        const Covariance<Real> square = product_sum(P, P, Covariance<double>::Zero());
        Eigen::Matrix<Real, 6, 1> control;
        Real stuck = 0;
        for (int lane = 0; lane < lanes<Real>; ++lane) {
            const auto of_lane = [lane](const Real& number) { return lane_of(number, lane); };
            const State<double> own = x.unaryExpr(of_lane);
            const Least<double> best =
                planned<Real>(s, arm, goals.of(lane, own.segment<3>(3)), candidates, own, P.unaryExpr(of_lane),
                              square.unaryExpr(of_lane), increment);
            Eigen::Matrix<double, 6, 1> taken = Eigen::Matrix<double, 6, 1>::Zero();
            if (best.found()) {
                const Candidates::Control& one = candidates[static_cast<int>(best.index)];
                taken << one.head<3>(), one.segment<3>(4);
            }
            for (int i = 0; i < 6; ++i) set_lane(control(i), lane, taken(i));
            set_lane(stuck, lane, best.found() ? 0 : 1);
        }
        return {control.template head<3>(), control.template tail<3>(), stuck > Real(0)};
    }
};
