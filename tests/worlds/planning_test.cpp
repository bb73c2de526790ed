// The parts of planners against plain code: loops, Ericson's nearest point of a triangle, Eigen's rotations, and joint
// updates.

#include "catch.hpp"

#include <credence/filters.hpp>
#include <credence/planning.hpp>

#include <cmath>
#include <random>

namespace credence::test::planning_test {

namespace {

using Point = Eigen::Vector3d;

/// An octahedron, and a face more, of either orientation.
constexpr Mesh<9> mesh{{
    {0, 1, 2}, {0, 3, 2}, {0, 3, 4}, {0, 1, 4}, {5, 1, 2}, {5, 2, 3}, {5, 3, 4}, {5, 4, 1}, {0, 1, 6}}};

struct Random {
    explicit Random(unsigned seed) : random_(seed) {}
    template <class Matrix>
    Matrix matrix() {
        Matrix all;
        for (Eigen::Index i = 0; i < all.size(); ++i)
            for (int lane = 0; lane < lanes<typename Matrix::Scalar>; ++lane) set_lane(all(i), lane, normal_(random_));
        return all;
    }
    std::mt19937 random_;
    std::normal_distribution<double> normal_;
};

/// The numbers of one lane.
template <class Matrix>
auto of_lane(const Matrix& matrix, int lane) {
    return matrix.unaryExpr([lane](const auto& number) { return lane_of(number, lane); }).eval();
}

/// By barycentric coordinates of the place at which the line from a to b goes through the triangle's plane.
bool blocked_plainly(const Point& a, const Point& b, const Point* corners) {
    Eigen::Matrix3d A;
    A << b - a, corners[0] - corners[1], corners[0] - corners[2];
    const Eigen::Vector3d s = A.fullPivLu().solve(corners[0] - a);
    return s(0) > 0 && s(0) < 1 && s(1) > 0 && s(2) > 0 && s(1) + s(2) < 1;
}

/// [Ericson, Real-Time Collision Detection, 2005, 5.1.5]
Point nearest(const Point& p, const Point& a, const Point& b, const Point& c) {
    const Point ab = b - a, ac = c - a;
    const double d1 = ab.dot(p - a), d2 = ac.dot(p - a), d3 = ab.dot(p - b), d4 = ac.dot(p - b), d5 = ab.dot(p - c),
                 d6 = ac.dot(p - c);
    if (d1 <= 0 && d2 <= 0) return a;
    if (d3 >= 0 && d4 <= d3) return b;
    if (d6 >= 0 && d5 <= d6) return c;
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
    return a + vb / (va + vb + vc) * ab + vc / (va + vb + vc) * ac;
}

/// The draws of four trials.
double draw(int lane, int source, int pose, int index, int which) {
    std::seed_seq seeds{lane, source, pose, index, which};
    std::mt19937 random(seeds);
    return std::normal_distribution<double>()(random);
}
void draws(const LanePack&, int source, int pose, int index, double* out) {
    for (int which = 0; which < 2; ++which)
        for (int lane = 0; lane < 4; ++lane) out[4 * which + lane] = draw(lane, source, pose, index, which);
}

/// A state of a pose [p] and features [d], some of them seen after a control, in each lane.
template <class Real, int p, int d, int count>
struct Plan {
    static constexpr int n = p + d * count;
    Eigen::Matrix<double, n, n> P;
    Eigen::Matrix<Real, p, p> F;
    Eigen::Matrix<double, p, 1> Q;
    std::array<Eigen::Matrix<Real, d, p>, count> rows;
    std::array<Real, count> variances;
    std::array<Mask<Real>, count> seen;

    Plan(Random& random, unsigned sights) {
        const auto A = random.matrix<Eigen::Matrix<double, n, n>>();
        P = A * A.transpose() + Eigen::Matrix<double, n, n>::Identity();
        F = random.matrix<Eigen::Matrix<Real, p, p>>();
        Q = random.matrix<Eigen::Matrix<double, p, 1>>().cwiseAbs();
        for (std::size_t j = 0; j < count; ++j) {
            rows[j] = random.matrix<Eigen::Matrix<Real, d, p>>();
            variances[j] = 0.1 + abs(random.matrix<Eigen::Matrix<Real, 1, 1>>()(0));
            seen[j] = mask_of_bits<Real>(sights >> (lanes<Real> * j));
        }
    }
    /// The trace in one lane: the prediction, and an update after the other with whole matrices.
    double trace(int lane) const {
        Eigen::Matrix<double, n, n> all = P, whole = Eigen::Matrix<double, n, n>::Identity();
        whole.template topLeftCorner<p, p>() = of_lane(F, lane);
        all = whole * P * whole.transpose();
        all.diagonal().template head<p>() += Q;
        for (std::size_t j = 0; j < count; ++j) {
            if (!(lane_bits(seen[j]) >> lane & 1)) continue;
            Eigen::Matrix<double, d, n> H = Eigen::Matrix<double, d, n>::Zero();
            H.template leftCols<p>() = of_lane(rows[j], lane);
            H.template middleCols<d>(p + d * static_cast<int>(j)).setIdentity();
            const Eigen::Matrix<double, d, d> R = Eigen::Matrix<double, d, d>::Identity() * lane_of(variances[j], lane);
            all = kalman_update(all, Eigen::Matrix<double, d, 1>::Zero().eval(), H, R).P;
        }
        return all.trace();
    }
};

template <class Real, int p, int d, int count>
void check_foresight(unsigned seed) {
    Random random(seed);
    const Plan<Real, p, d, count> plan(random, seed * 2654435761u);
    const Foresight<double, p, d, count> foresight(plan.P, plan.P * plan.P);
    const Real given = foresight.trace(plan.F, plan.Q, plan.rows.data(), plan.variances.data(), plan.seen.data());
    for (int lane = 0; lane < lanes<Real>; ++lane)
        CHECK(lane_of(given, lane) == Approx(plan.trace(lane)).epsilon(1e-10));  // condition numbers are below 1e4
    const Foresight<Real, p, d, count> of_trials(plan.P.template cast<Real>(), (plan.P * plan.P).template cast<Real>());
    const Real again = of_trials.trace(plan.F, plan.Q, plan.rows.data(), plan.variances.data(), plan.seen.data());
    for (int lane = 0; lane < lanes<Real>; ++lane)
        CHECK(lane_of(again, lane) == Approx(lane_of(given, lane)).epsilon(1e-12));
}

}  // namespace

TEST_CASE("planning: candidates are listed with the last axis fastest, and each lane has its own") {
    Candidates<2> all(std::array{std::vector{1.0, 2.0}, std::vector{3.0, 4.0, 5.0}});
    all.add({7, 8});
    REQUIRE(all.count() == 7);
    const double expected[][2] = {{1, 3}, {1, 4}, {1, 5}, {2, 3}, {2, 4}, {2, 5}, {7, 8}};
    for (int i = 0; i < 7; ++i) CHECK(all[i] == Eigen::Vector2d(expected[i][0], expected[i][1]));
    Lane<2> index = 6;
    set_lane(index, 0, 4);
    CHECK(of_lane(all.of_lanes(index), 0) == all[4]);
    CHECK(of_lane(all.of_lanes(index), 1) == all[6]);
}

TEST_CASE("planning: the least cost wins, of equal ones the last that is allowed, and none where none is") {
    std::mt19937 random(3);
    for (int sample = 0; sample < 500; ++sample) {
        const int count = sample % 20;
        double costs[20][4];
        unsigned allowed[20];
        for (int i = 0; i < count; ++i) {
            for (double& cost : costs[i]) cost = random() % 8 == 0 ? std::nan("") : static_cast<double>(random() % 6);
            allowed[i] = random() % 16 & random() % 16;
        }
        const auto best = least(
            count, [&](int i) { return mask_of_bits<Lane<4>>(allowed[i]); },
            [&](int i) { return load<Lane<4>>(costs[i]); });
        for (int lane = 0; lane < 4; ++lane) {
            int expected = -1;
            std::vector<int> list;
            for (int i = 0; i < count; ++i) {
                if (!(allowed[i] >> lane & 1)) continue;
                list.push_back(i);
                const double cost = costs[i][lane];
                if (!std::isnan(cost) && (expected < 0 || cost <= costs[expected][lane])) expected = i;
            }
            CHECK(lane_of(best.index, lane) == expected);
            CHECK((lane_bits(best.found()) >> lane & 1) == (expected >= 0));
            std::ranges::shuffle(list, random);
            const auto cost = [&](const auto& index) {
                auto all = index;
                for (int l = 0; l < lanes<std::remove_cvref_t<decltype(index)>>; ++l)
                    set_lane(all, l, costs[static_cast<int>(lane_of(index, l))][lane]);
                return all;
            };
            CHECK(least_of_one<double>(list, cost).index == expected);
            const auto nearly = [&](double index) { return cost(index) * (1 + 1e-14 * index); };
            CHECK(least_of_one<double>(list, nearly, 1e-12).index == expected);
            CHECK(least_of_one<Lane<4>>(list, cost).index == expected);
        }
    }
}

TEST_CASE("planning: a mesh hides what is behind its triangles, and is as near as its nearest point") {
    Random random(4);
    CHECK(mesh.edge_count == 14);
    int hidden = 0, free = 0;
    for (int sample = 0; sample < 400; ++sample) {
        const auto points = random.matrix<Eigen::Matrix<double, 3, 7>>();
        const auto from = random.matrix<Vector3<Lane<4>>>(), to = random.matrix<Vector3<Lane<4>>>();
        const MeshView<Lane<4>, 9> view(mesh, points, from);
        const int corner = sample % 8 - 1;
        const auto blocked = view.blocked(to, corner);
        const auto to_corner = view.blocked(points.col(3).cast<Lane<4>>(), 3);
        const Lane<4> distance = MeshFaces<double, 9>(mesh, points).clearance(to);
        for (int lane = 0; lane < 4; ++lane) {
            const Point a = of_lane(from, lane), b = of_lane(to, lane);
            bool expected = false, corner_expected = false;
            double least_distance = 1e9;
            for (const auto& triangle : mesh.triangles) {
                const Point corners[] = {points.col(triangle[0]), points.col(triangle[1]), points.col(triangle[2])};
                const auto has = [&](int i) { return std::ranges::find(triangle, i) != std::end(triangle); };
                expected = expected || (!has(corner) && blocked_plainly(a, b, corners));
                corner_expected = corner_expected || (!has(3) && blocked_plainly(a, points.col(3), corners));
                least_distance = std::min(least_distance, (b - nearest(b, corners[0], corners[1], corners[2])).norm());
            }
            CHECK((lane_bits(blocked) >> lane & 1) == expected);
            CHECK((lane_bits(to_corner) >> lane & 1) == corner_expected);
            CHECK(lane_of(distance, lane) == Approx(least_distance).epsilon(1e-9));  // triangles may be thin
            const MeshView<double, 9> alone(mesh, points, a);
            CHECK(alone.blocked(b, corner) == expected);
            CHECK(MeshFaces<double, 9>(mesh, points).clearance(b) == Approx(lane_of(distance, lane)).epsilon(1e-9));
            ++(expected ? hidden : free);
        }
    }
    CHECK(std::min(hidden, free) > 300);
}

TEST_CASE("planning: a rotation of Euler angles is Eigen's, with its derivatives") {
    Random random(5);
    for (int sample = 0; sample < 50; ++sample) {
        const Point angles = random.matrix<Point>();
        const EulerRotation<double> given(angles);
        const Eigen::Matrix3d R = (Eigen::AngleAxisd(angles(2), Point::UnitZ()) *
                                   Eigen::AngleAxisd(angles(1), Point::UnitY()) *
                                   Eigen::AngleAxisd(angles(0), Point::UnitX())).toRotationMatrix();
        CHECK((given.R - R).norm() < 1e-14);
        const auto flat = [](const Point& at) -> Eigen::Matrix<double, 9, 1> {
            return EulerRotation<double>(at).R.reshaped();
        };
        Eigen::Matrix<double, 9, 3> J;
        for (int k = 0; k < 3; ++k) J.col(k) = given.derivative[static_cast<std::size_t>(k)].reshaped();
        CHECK(jacobian_mismatch(flat, angles, J) < 1e-8);
    }
}

TEST_CASE("planning: a truncated draw is the first of its draws that is within the limit, in every lane") {
    LanePack pack;
    const std::string world = "test";
    pack.world = &world;
    pack.normal = draws;
    const OwnTrialOf<Lane<4>> trial(pack);
    int repeated = 0;
    for (int index = 0; index < 200; ++index) {
        const auto given = truncated_normal(trial, 1, 2, 3, index, 1000);
        for (int lane = 0; lane < 4; ++lane)
            for (int which = 0; which < 2; ++which) {
                int key = index;
                while (std::abs(draw(lane, 2, 3, key, which)) > 1) key += 1000, ++repeated;
                CHECK(lane_of(given(which), lane) == draw(lane, 2, 3, key, which));
            }
    }
    CHECK(repeated > 500);
}

TEST_CASE("planning: updates in place, one after the other, are the joint update of what was seen") {
    constexpr int n = 8;
    using Real = Lane<4>;
    Random random(6);
    for (int sample = 0; sample < 30; ++sample) {
        const auto A = random.matrix<Eigen::Matrix<Real, n, n>>();
        const Eigen::Matrix<Real, n, n> before = A * A.transpose() + Eigen::Matrix<double, n, n>::Identity();
        Eigen::Matrix<Real, n, n> P = before;
        Eigen::Matrix<Real, n, 1> step = Eigen::Matrix<Real, n, 1>::Zero();
        const int places[][3] = {{0, 3, 5}, {7, 1, 2}};
        const auto nu = random.matrix<Eigen::Matrix<Real, 4, 1>>();
        const auto H = random.matrix<Eigen::Matrix<Real, 4, 3>>();
        const unsigned seen[] = {0b0101, 0b0011};
        Real nis = 0;
        for (int i = 0; i < 2; ++i) {
            const auto mask = mask_of_bits<Real>(seen[i]);
            const auto given = update_in_place(P, step, places[i], H.middleRows<2>(2 * i),
                                               Eigen::Matrix<Real, 2, 1>(nu.segment<2>(2 * i)), Real(0.5 + i), mask);
            nis += select(mask, Real(given.nu.dot(solve(given.S, given.nu))), Real(0));
        }
        P.triangularView<Eigen::StrictlyUpper>() = P.transpose();
        for (int lane = 0; lane < 4; ++lane) {
            Eigen::Matrix<double, 4, n> whole = Eigen::Matrix<double, 4, n>::Zero();
            Eigen::Vector4d innovation = Eigen::Vector4d::Zero(), variances(0.5, 0.5, 1.5, 1.5);
            for (int r = 0; r < 4; ++r) {
                if (!(seen[r / 2] >> lane & 1)) continue;  // rows of 0 measure nothing
                innovation(r) = lane_of(nu(r), lane);
                for (int c = 0; c < 3; ++c) whole(r, places[r / 2][c]) = lane_of(H(r, c), lane);
            }
            const Eigen::Matrix4d R = variances.asDiagonal();
            const auto joint = kalman_update(of_lane(before, lane), innovation, whole, R);
            CHECK((of_lane(P, lane) - joint.P).norm() < 1e-10);  // condition numbers are below 1e4
            CHECK((of_lane(step, lane) - joint.step).norm() < 1e-10);
            CHECK(lane_of(nis, lane) == Approx(innovation.dot(solve(joint.S, innovation))).epsilon(1e-9));
        }
    }
}

TEST_CASE("planning: the trace that is foreseen is that of a prediction and an update of whole matrices") {
    for (unsigned seed = 1; seed <= 30; ++seed) {
        check_foresight<Lane<4>, 6, 3, 3>(seed);
        check_foresight<double, 3, 2, 4>(seed);
    }
}

}  // namespace credence::test::planning_test
