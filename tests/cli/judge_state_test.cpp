// Metamorphic tests of `judge` on a tracker: the order in which a state is written, and the axes of its positions,
// change no verdict.

#include <cmath>
#include <map>

#include "program.hpp"
#include "record_support.hpp"

namespace credence::test::judge_state_test {

namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;
using Eigen::VectorXd;

constexpr int tracks = 1500, track_steps = 10;

/// Errors of a Kalman filter that tracks a point of nearly constant velocity by its position, and what it says of them:
/// x, y, vx, vy.
struct Tracks {
    std::vector<VectorXd> error;
    std::vector<Eigen::MatrixXd> covariance;

    Tracks() {
        std::mt19937_64 random(11);
        std::normal_distribution<double> normal;
        const auto drawn = [&](double sigma) { return sigma * normal(random); };
        Matrix4d F = Matrix4d::Identity(), Q = Matrix4d::Zero();
        F(0, 2) = F(1, 3) = 1;
        const double a = 0.3, r = 0.7;
        for (int i = 0; i < 2; ++i) {
            Q(i, i) = a * a / 4, Q(i, i + 2) = Q(i + 2, i) = a * a / 2, Q(i + 2, i + 2) = a * a;
        }
        for (int trial = 0; trial < tracks; ++trial) {
            Vector4d e(drawn(1), drawn(1), drawn(1), drawn(1));  // of a state whose truth stays away: all is linear
            Matrix4d P = Matrix4d::Identity();
            for (int k = 0; k < track_steps; ++k) {
                const double ax = drawn(a), ay = drawn(a);
                e = F * e - Vector4d(ax / 2, ay / 2, ax, ay);
                P = F * P * F.transpose() + Q;
                const Eigen::Matrix2d S = P.topLeftCorner<2, 2>() + r * r * Eigen::Matrix2d::Identity();
                const Eigen::Matrix<double, 4, 2> K = P.leftCols<2>() * S.inverse();
                e += K * (Eigen::Vector2d(drawn(r), drawn(r)) - e.head<2>());
                P = (P - K * S * K.transpose()).eval();
                error.push_back(e);
                covariance.push_back((P + P.transpose()) / 2);
            }
        }
    }

    /// The filter believes that positions and velocities are not correlated, and its velocity too much.
    void spoil() {
        for (Eigen::MatrixXd& P : covariance) {
            P.topRightCorner<2, 2>().setZero();
            P.bottomLeftCorner<2, 2>().setZero();
            P.bottomRightCorner<2, 2>() *= 0.8;
        }
    }

    Tracks in(const Matrix4d& A) const {
        Tracks other = *this;
        for (VectorXd& e : other.error) e = (A * e).eval();
        for (Eigen::MatrixXd& P : other.covariance) {
            P = (A * P * A.transpose()).eval();
            P = ((P + P.transpose()) / 2).eval();
        }
        return other;
    }

    void write(const std::string& path, const std::string& names, const std::string& groups) const {
        write_file(path, [&](const Handle& root) {
            write_values(root, "error", {tracks, track_steps, 4}, flat(error));
            write_values(root, "covariance", {tracks, track_steps, 4, 4}, flat(covariance));
            hdf5::write_text(root, "component_names", names);
            hdf5::write_text(root, "groups", groups);
        });
    }
};

/// What `judge` says of a record, the groups and the components by their names.
struct Said {
    std::string verdict;
    std::map<std::string, double> numbers;

    Said(const Workplace& here, const std::string& record) {
        const Json arm = Json::parse(here.credence("judge " + record + " --quiet --margin 10% --format json").out)[0];
        verdict = arm["verdict"];
        for (const Json& group : arm["groups"])
            numbers["NEES of " + group["group"].get<std::string>()] = group["nees_ratio"];
        for (const Json& bias : arm["bias"])
            numbers["bias of " + bias["component"].get<std::string>()] = bias["mean"][3];
        for (const Json& finding : arm["findings"]) add(finding);
        for (const char* end : {"largest", "smallest"})
            for (const Json& direction : arm["directions"][end]) add_direction(end, direction);
    }
    void add(const Json& finding) {
        // The name of a direction lists its components in their order.
        const std::string when = finding["about"] == "direction" ? "" : finding["when"].get<std::string>();
        numbers[finding["text"].get<std::string>().substr(0, 10) + finding["where"].get<std::string>() + when] =
            finding["value"];
    }
    void add_direction(const std::string& end, const Json& direction) {
        const std::string name = end + " direction of " + direction["group"].get<std::string>();
        numbers[name] = direction["ratio"];
        for (const auto& [component, weight] : direction["loadings"].items())
            numbers[name + ", " + component] =
                std::abs(weight.get<double>());  // of two equal ones either is the largest
    }
};

void check_same(const Said& one, const Said& other) {
    CHECK(one.verdict == other.verdict);
    REQUIRE(one.numbers.size() == other.numbers.size());
    for (const auto& [name, number] : one.numbers) {
        CAPTURE(name);
        REQUIRE(other.numbers.count(name) == 1);
        CHECK(std::abs(other.numbers.at(name) - number) < 1e-9);  // rounding in another order
    }
}

}  // namespace

TEST_CASE("judge: a state written as x, vx, y, vy, its groups as lists, has the numbers of x, y, vx, vy") {
    const Workplace here;
    Matrix4d order = Matrix4d::Zero();
    order(0, 0) = order(1, 2) = order(2, 1) = order(3, 3) = 1;
    Tracks tracker;
    for (const char* verdict : {"consistent", "mixed"}) {
        tracker.write(here.path("together.h5"), "x, y, vx, vy", "position 0:2, velocity 2:4, along 0 2");
        tracker.in(order).write(here.path("apart.h5"), "x, vx, y, vy", "position 0 2, velocity 1 3, along 0:2");
        const Said together(here, "together.h5"), apart(here, "apart.h5");
        CHECK(together.verdict == verdict);
        CHECK(together.numbers.size() >= 4 + 4 + 8);
        check_same(together, apart);
        tracker.spoil();
    }
}

TEST_CASE("judge: other axes of the positions change no verdict, and no NEES of what turns as a whole") {
    const Workplace here;
    const Eigen::Matrix2d turn = Eigen::Rotation2Dd(0.6).toRotationMatrix();
    Matrix4d all = Matrix4d::Zero();
    all.topLeftCorner<2, 2>() = all.bottomRightCorner<2, 2>() = turn;
    Tracks tracker;
    for (const char* verdict : {"consistent", "mixed"}) {
        tracker.write(here.path("before.h5"), "x, y, vx, vy", "position 0:2, velocity 2:4");
        tracker.in(all).write(here.path("turned.h5"), "x, y, vx, vy", "position 0:2, velocity 2:4");
        const Said before(here, "before.h5"), turned(here, "turned.h5");
        CHECK(before.verdict == verdict);
        CHECK(turned.verdict == verdict);
        for (const char* group : {"all", "position", "velocity"}) {
            const std::string name = std::string("NEES of ") + group;
            CHECK(std::abs(before.numbers.at(name) - turned.numbers.at(name)) < 1e-9);
        }
        tracker.spoil();
    }
}

}  // namespace credence::test::judge_state_test
