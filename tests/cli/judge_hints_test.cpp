// What `judge` says beside a verdict: the other chart, a start that is known exactly, groups that no trial has, what
// looks wrong and is not shown, and what rounding forbids.

#include <cmath>

#include "program.hpp"
#include "record_support.hpp"

namespace credence::test::judge_hints_test {

using Catch::Contains;

namespace {

Json judged(const Workplace& here, const std::string& options = "") {
    return Json::parse(here.credence("judge r.h5 --quiet --format json " + options).out)[0];
}

/// Poses in the plane, far from the origin, whose errors of the world's frame are drawn from `covariance`.
void write_poses(const std::string& path, const std::string& chart) {
    constexpr int trials = 400, steps = 5;
    std::mt19937_64 random(2);
    std::normal_distribution<double> normal;
    const Eigen::Vector3d sigma(0.2, 0.3, 0.02);
    std::vector<double> truth, estimate, covariance;
    for (int i = 0; i < trials * steps; ++i) {
        const double angle = 2 * normal(random), x = 20 + normal(random), y = -30 + normal(random);
        const Eigen::Vector3d e(sigma[0] * normal(random), sigma[1] * normal(random), sigma[2] * normal(random));
        // Exp of e, applied from the left: about the origin of the world.
        const double s = std::sin(e[2]) / e[2], c = (1 - std::cos(e[2])) / e[2];
        const Eigen::Vector2d moved = Eigen::Rotation2Dd(e[2]) * Eigen::Vector2d(x, y) +
                                      Eigen::Vector2d(s * e[0] - c * e[1], c * e[0] + s * e[1]);
        truth.insert(truth.end(), {x, y, angle});
        estimate.insert(estimate.end(), {moved.x(), moved.y(), angle + e[2]});
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) covariance.push_back(a == b ? sigma[a] * sigma[a] : 0);
    }
    write_file(path, [&](const Handle& root) {
        write_values(root, "truth", {trials, steps, 3}, truth);
        write_values(root, "estimate", {trials, steps, 3}, estimate);
        write_values(root, "covariance", {trials, steps, 3, 3}, covariance);
        hdf5::write_text(root, "manifold", "SE2");
        hdf5::write_text(root, "chart", chart);
        hdf5::write_text(root, "groups", "position 0:2");
    });
}

}  // namespace

TEST_CASE("judge: where errors are too large on a manifold, NEES of the other chart is beside the record's own") {
    const Workplace here;
    write_poses(here.path("r.h5"), "local");
    const Json wrong = judged(here);
    CHECK(wrong["verdict"] == "optimistic");
    REQUIRE(wrong["other_charts"].size() == 4);
    CHECK(wrong["other_charts"][0]["chart"] == "global");
    CHECK(wrong["other_charts"][0]["group"] == "all");
    CHECK(wrong["other_charts"][0]["nees_ratio"].get<double>() == Approx(1).margin(0.05));  // 2,000 steps: 4 sigma
    const std::string hint = wrong["hints"].back();
    CHECK_THAT(hint, Contains("in the chart `local`, ") && Contains("in the chart `plain`: ") &&
                         Contains("does the covariance belong to the error in `global`?"));
    write_poses(here.path("r.h5"), "global");
    const Json right = judged(here);
    CHECK(right["groups"][0]["nees_ratio"] ==
          wrong["other_charts"][0]["nees_ratio"]);  // the same numbers, to the last bit
    CHECK(right["verdict"] == "undecided");
    CHECK_FALSE(right.contains("other_charts"));  // not tried where nothing is too large
    CHECK(right["hints"].empty());
}

TEST_CASE("judge: a position in the world beside a heading is told from Log") {
    const Workplace here;
    constexpr int trials = 200, steps = 10;
    std::vector<double> truth, estimate, covariance;
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    const double sigma[3] = {0.1, 2, 0.3};
    for (int i = 0; i < trials * steps; ++i) {
        for (const double x : {20 * normal(random), 20 * normal(random), 2 * normal(random)}) truth.push_back(x);
        for (int a = 0; a < 3; ++a) estimate.push_back(truth[truth.size() - 3 + a] + sigma[a] * normal(random));
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) covariance.push_back(a == b ? sigma[a] * sigma[a] : 0);
    }
    const auto write = [&](const std::string& manifold) {
        write_file(here.path("r.h5"), [&](const Handle& root) {
            write_values(root, "truth", {trials, steps, 3}, truth);
            write_values(root, "estimate", {trials, steps, 3}, estimate);
            write_values(root, "covariance", {trials, steps, 3, 3}, covariance);
            hdf5::write_text(root, "manifold", manifold);
            hdf5::write_text(root, "chart", "local");
        });
        return judged(here);
    };
    const Json pose = write("SE2"), apart = write("R2 x SO2");
    CHECK_THAT(pose["hints"].back().get<std::string>(), Contains("error in `plain` (position in the world, heading"));
    REQUIRE(pose["other_charts"].size() == 2);
    CHECK(pose["other_charts"][1]["chart"] == "plain");
    CHECK(pose["other_charts"][1]["nees_ratio"] == apart["groups"][0]["nees_ratio"]);  // to the last bit
    CHECK_FALSE(apart.contains("other_charts"));
}

TEST_CASE("judge: where errors are too large in either chart, the chart is not blamed") {
    const Workplace here;
    write_poses(here.path("r.h5"), "global");
    const Handle root(H5Fopen(here.path("r.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, "", "");
    scale(root, "covariance", 0.5);
    const Json both = judged(here);
    CHECK(both["verdict"] == "optimistic");
    CHECK(both["other_charts"][0]["chart"] == "local");
    CHECK_THAT(both["hints"].back().get<std::string>(), Contains("the chart is not what is wrong"));
}

TEST_CASE("judge: errors of the right size and wrong directions are asked for their frame, unless they are exchanged") {
    const Workplace here;
    const auto write = [&](double turn) {  // a quarter of a turn beside what P says
        DrawnRecord drawn(300, 8, 2);
        std::mt19937_64 random(6);
        std::normal_distribution<double> normal;
        const Eigen::Matrix2d R = Eigen::Rotation2Dd(turn).toRotationMatrix();
        for (std::size_t i = 0; i < drawn.error.size(); ++i) {
            const double a = normal(random), b = normal(random);
            drawn.error[i] = R * Eigen::Vector2d(a, 2 * b);
            drawn.covariance[i] = R * Eigen::Vector2d(4, 1).asDiagonal() * R.transpose();
        }
        write_file(here.path("r.h5"), [&](const Handle& root) { write_drawn(root, drawn); });
        return judged(here);
    };
    const Json exchanged = write(0);
    CHECK(exchanged["verdict"] == "mixed");
    REQUIRE(exchanged["hints"].size() == 1);
    CHECK_THAT(exchanged["hints"][0].get<std::string>(), Contains("are as large as P says of x1"));
    CHECK(exchanged["mix_up"] == true);
    const Json turned = write(0.8);
    CHECK(turned["verdict"] == "mixed");
    REQUIRE(turned["hints"].size() == 1);
    CHECK_THAT(turned["hints"][0].get<std::string>(), Contains("in the chart and frame and of the step of P"));
    CHECK(turned["mix_up"] == false);
    CHECK_FALSE(turned.contains("other_charts"));
}

TEST_CASE("judge: errors of an angle that were not wrapped are named") {
    const Workplace here;
    const auto write = [&](double turn) {
        DrawnRecord drawn(200, 8, 3);
        for (Eigen::VectorXd& error : drawn.error) error *= 0.2;  // no right angle is off by half a turn
        for (Eigen::MatrixXd& covariance : drawn.covariance) covariance *= 0.04;
        for (int trial = 0; trial < drawn.trials; trial += 20) drawn.error[drawn.at(trial, 4)](2) += turn;
        write_file(here.path("r.h5"), [&](const Handle& root) {
            write_drawn(root, drawn);
            hdf5::write_text(root, "component_names", "x, y, heading");
            hdf5::write_text(root, "component_units", "m, m, rad");
        });
        return judged(here);
    };
    const Json unwrapped = write(6.283);
    REQUIRE_FALSE(unwrapped["hints"].empty());
    CHECK_THAT(unwrapped["hints"][0].get<std::string>(),
               Contains("errors of heading reach") && Contains("were angles wrapped to half a turn?"));
    CHECK(write(0)["hints"].empty());
}

TEST_CASE("judge: a start that is known exactly fails every trial, and the hint says what to do") {
    const Workplace here;
    const auto write = [&](bool at_start) {
        DrawnRecord drawn(40, 4, 3);
        for (int trial = 0; trial < drawn.trials; ++trial) {
            Eigen::MatrixXd& P = drawn.covariance[drawn.at(trial, at_start ? 0 : 2)];
            P.row(2).setZero();
            P.col(2).setZero();
        }
        write_file(here.path("r.h5"), [&](const Handle& root) { write_drawn(root, drawn); });
        return judged(here);
    };
    const Json known = write(true);
    CHECK(known["verdict"] == "failed");
    REQUIRE(known["hints"].size() == 1);
    CHECK_THAT(known["hints"][0].get<std::string>(),
               Contains("cannot be inverted at the first step") && Contains("P0 = 0"));
    CHECK(write(false)["hints"].empty());
}

TEST_CASE("judge: a component that no trial has is named, and keeps the others from nothing") {
    const Workplace here;
    const auto write = [&](bool hidden) {
        DrawnRecord drawn(1500, 20, 4);
        for (int trial = 0; trial < drawn.trials; ++trial)
            for (int step = 0; hidden && step < drawn.steps; ++step) drawn.hide(trial, step, 3);
        write_file(here.path("r.h5"), [&](const Handle& root) {
            write_drawn(root, drawn);
            hdf5::write_text(root, "groups", "pose 0:3, landmark 2:4");
        });
        return judged(here);
    };
    const Json without = write(true), with = write(false);
    CHECK(with["verdict"] == "consistent");
    CHECK(without["verdict"] == "consistent");
    CHECK_THAT(without["not_judged"][0].get<std::string>(),
               Contains("No trial has all components of landmark at a step"));
    CHECK_FALSE(with.contains("not_judged"));
}

TEST_CASE("judge: of components that no trial has together, the reason says why there are no directions") {
    const Workplace here;
    DrawnRecord drawn(400, 20, 3);
    for (int trial = 0; trial < drawn.trials; ++trial)
        for (int step = 0; step < drawn.steps; ++step) drawn.hide(trial, step, trial % 2 == 0 ? 1 : 2);
    write_file(here.path("r.h5"), [&](const Handle& root) { write_drawn(root, drawn); });
    const Json apart = judged(here);
    CHECK(apart["verdict"] == "undecided");
    CHECK_THAT(
        apart["reason"].get<std::string>(),
        Contains(
            "directions need 20 trials in which every two components are in the state together, and there are 0"));
}

TEST_CASE("judge: what looks wrong and is not shown comes with the number of trials that would show it") {
    const Workplace here;
    const auto write = [&](double factor) {
        DrawnRecord drawn(300, 10, 3);
        for (Eigen::VectorXd& error : drawn.error) error *= std::sqrt(factor);
        write_file(here.path("r.h5"), [&](const Handle& root) { write_drawn(root, drawn); });
        return judged(here);
    };
    const Json small = write(0.91);
    CHECK(small["verdict"] == "undecided");
    REQUIRE_FALSE(small["suspicions"].empty());
    const Json& first = small["suspicions"][0];
    CHECK(first["what"] == "pessimistic");
    CHECK(first["about"] == "size");
    CHECK(first["where"] == "all");
    CHECK(first["trials"].get<double>() > 300);
    CHECK(first["trials_range"][0].get<double>() < first["trials"].get<double>());
    CHECK(first["trials_range"][1].get<double>() > first["trials"].get<double>());
    CHECK_THAT(small["reason"].get<std::string>(),
               Contains("and not shown to be too small: ") && Contains(" trials would show it if it stays ("));
    CHECK(judged(here, "--margin 15%")["suspicions"].empty());  // nothing looks wrong
    CHECK(write(0.6)["verdict"] == "pessimistic");
    CHECK(judged(here)["suspicions"].empty());  // it is shown
}

TEST_CASE("judge: covariances in singles are judged to the accuracy of their type, in doubles to that of theirs") {
    const Workplace here;
    const auto write = [&](auto type, double correlation) {
        DrawnRecord drawn(2500, 8, 2);
        Eigen::Matrix2d P;
        P << 1, correlation, correlation, 1;
        const Eigen::Matrix2d L = P.llt().matrixL();
        std::mt19937_64 random(5);
        std::normal_distribution<double> normal;
        for (Eigen::VectorXd& error : drawn.error) {
            const double a = normal(random), b = normal(random);
            error = L * Eigen::Vector2d(a, b);
        }
        for (Eigen::MatrixXd& covariance : drawn.covariance) covariance = P;
        write_file(here.path("r.h5"), [&](const Handle& root) {
            write_values(root, "error", extents_of(drawn, {2}), flat(drawn.error));
            write_values<decltype(type)>(root, "covariance", extents_of(drawn, {2, 2}), flat(drawn.covariance));
        });
        return judged(here);
    };
    // The smallest eigenvalue is 1 - correlation: 2 * 2^-23 / 1e-5 is 2 %, more than a tenth of the margin.
    CHECK(write(0.0, 1 - 1e-5)["verdict"] == "consistent");
    const Json coarse = write(0.0f, 1 - 1e-5);
    CHECK(coarse["verdict"] == "undecided");
    CHECK_THAT(coarse["reason"].get<std::string>(),
               Contains("conditioning: NEES of all is left out, because rounding alone may change it by 2.4 %") &&
                   Contains("cannot be distinguished from a singular one in 1 direction"));
    CHECK(write(0.0f, 1 - 1e-3)["verdict"] == "consistent");
}

TEST_CASE("judge: innovations whose covariance cannot be inverted are left out, and counted") {
    const Workplace here;
    DrawnRecord drawn(60, 6, 2, 2);
    for (int trial = 0; trial < 10; ++trial) {
        Eigen::MatrixXd& S = drawn.innovation_covariance[drawn.at(trial, 1)];
        S << 1, 1 - 2e-14, 1 - 2e-14, 1;
        drawn.innovation[drawn.at(trial, 1)] = Eigen::Vector2d(1e-3, -1e-3);
    }
    write_file(here.path("r.h5"), [&](const Handle& root) { write_drawn(root, drawn); });
    INFO(here.credence("judge r.h5 --quiet").err);
    const Json arm = judged(here);
    CHECK(arm["failed_trials"] == 0);
    CHECK_THAT(arm["not_judged"][0].get<std::string>(), Contains("innovations of 10 steps are left out"));
    CHECK(arm["nis"][0]["degrees"] == 2 * (60 * 6 - 10));
    CHECK(arm["nis"][0]["ratio"].get<double>() < 2);  // theirs would be 1e8
}

}  // namespace credence::test::judge_hints_test
