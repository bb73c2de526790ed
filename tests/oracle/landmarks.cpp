#include "landmarks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace credence::oracle {

namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr int theta = 0, r = 1, pose_size = 3;

Index place(std::size_t i) { return pose_size + 2 * static_cast<Index>(i); }

/// The true loop, in closed form: the corners of a polygon about its centre.
class Loop {
public:
    explicit Loop(const ExploreSettings& scenario)
        : s_(scenario),
          turn_(scenario.features.turn),
          radius_(scenario.features.step / 2 / std::sin(turn_ / 2)),
          centre_(-scenario.features.step / 2, radius_ * std::cos(turn_ / 2)) {}

    double turn() const { return turn_; }
    double heading(int k) const { return k * turn_; }
    Vector2d position(int k) const { return centre_ + radius_ * about(heading(k) + turn_ / 2 - std::numbers::pi / 2); }
    Vector2d move() const { return s_.features.step * about(turn_); }
    Vector2d landmark(int j) const {
        const Point& place = s_.features.positions[static_cast<std::size_t>(j)];
        return {place.x, place.y};
    }
    bool sees(int k, int j) const { return (landmark(j) - position(k)).norm() <= s_.sensor.range_max; }
    Vector2d measured(int k, int j, const Noise& noise) const {
        return rotation(heading(k)).transpose() * (landmark(j) - position(k)) +
               s_.sensor.sigma * noise.normal(Source::measurement, k, j);
    }

private:
    static Vector2d about(double angle) { return {std::cos(angle), std::sin(angle)}; }
    const ExploreSettings& s_;
    double turn_, radius_;
    Vector2d centre_;
};

/// One estimator on its way: mean and covariance of the Euclidean error, and what it remembers.
class Filter {
public:
    Filter(const ExploreSettings& scenario, Estimator estimator, const Noise& noise)
        : s_(scenario), loop_(scenario), estimator_(estimator), noise_(noise) {
        step_.estimate = {VectorXd::Zero(pose_size), MatrixXd::Zero(pose_size, pose_size)};
        see_new(0);
    }

    void go_to(int k) {
        predict(k);
        std::vector<std::size_t> seen;
        for (std::size_t i = 0; i < step_.landmarks.size(); ++i)
            if (loop_.sees(k, step_.landmarks[i])) seen.push_back(i);
        update(k, seen);
        see_new(k);
    }

    LandmarkStep step(int k) const {
        LandmarkStep now = step_;
        now.truth = truth(k);
        return now;
    }

private:
    VectorXd& x() { return step_.estimate.mean; }
    MatrixXd& P() { return step_.estimate.covariance; }

    VectorXd truth(int k) const {
        VectorXd all(place(step_.landmarks.size()));
        all[theta] = loop_.heading(k);
        all.segment<2>(r) = loop_.position(k);
        for (std::size_t i = 0; i < step_.landmarks.size(); ++i)
            all.segment<2>(place(i)) = loop_.landmark(step_.landmarks[i]);
        return all;
    }

    void predict(int k) {
        const double turn = loop_.turn() - s_.noise.heading * noise_.normal(Source::odometry_heading, k, 0)[0];
        const Vector2d move =
            loop_.move() - s_.noise.odometry * noise_.normal(Source::odometry_position, k, 0);
        const VectorXd before = x();
        x().segment<2>(r) += rotation(before[theta]) * move;
        x()[theta] += turn;
        Vector2d displacement = x().segment<2>(r) - before.segment<2>(r);
        if (estimator_ == Estimator::ideal) displacement = loop_.position(k) - loop_.position(k - 1);
        if (estimator_ == Estimator::fej) displacement = x().segment<2>(r) - predicted_position_;
        predicted_position_ = x().segment<2>(r);
        VectorXd q = VectorXd::Zero(x().size());
        q[theta] = s_.noise.heading * s_.noise.heading;
        q.segment<2>(r).setConstant(s_.noise.odometry * s_.noise.odometry);
        MatrixXd F = MatrixXd::Identity(x().size(), x().size());
        if (estimator_ == Estimator::riekf) {  // in its own chart F = I and the noise enters by T
            F = chart(x()).inverse() * chart(before);
        } else {
            F.block<2, 1>(r, theta) = quarter_turn() * displacement;
        }
        P() = F * P() * F.transpose() + MatrixXd(q.asDiagonal());
    }

    MatrixXd jacobian(const VectorXd& at, const std::vector<std::size_t>& seen) const {
        MatrixXd H = MatrixXd::Zero(2 * static_cast<Index>(seen.size()), at.size());
        const Matrix2d into_body = rotation(at[theta]).transpose();
        for (std::size_t i = 0; i < seen.size(); ++i) {
            const Index row = 2 * static_cast<Index>(i);
            if (estimator_ != Estimator::riekf)  // in its own chart nothing observes the heading
                H.block<2, 1>(row, theta) =
                    -into_body * quarter_turn() * (at.segment<2>(place(seen[i])) - at.segment<2>(r));
            H.block<2, 2>(row, r) = -into_body;
            H.block<2, 2>(row, place(seen[i])) = into_body;
        }
        return H;
    }

    VectorXd innovation(const VectorXd& at, int k, const std::vector<std::size_t>& seen) const {
        VectorXd nu(2 * static_cast<Index>(seen.size()));
        for (std::size_t i = 0; i < seen.size(); ++i)
            nu.segment<2>(2 * static_cast<Index>(i)) =
                loop_.measured(k, step_.landmarks[seen[i]], noise_) -
                rotation(at[theta]).transpose() * (at.segment<2>(place(seen[i])) - at.segment<2>(r));
        return nu;
    }

    void update(int k, const std::vector<std::size_t>& seen) {
        const VectorXd predicted = x();
        step_.nis = 0;
        step_.rows = 2 * static_cast<int>(seen.size());
        step_.last_move = VectorXd::Zero(predicted.size());
        if (seen.empty()) return;
        const bool invariant = estimator_ == Estimator::riekf;
        const MatrixXd T = invariant ? chart(predicted) : MatrixXd::Identity(predicted.size(), predicted.size());
        const MatrixXd prior = T * P() * T.transpose();
        VectorXd at = predicted;
        if (estimator_ == Estimator::ideal) at = truth(k);
        if (estimator_ == Estimator::fej)
            for (std::size_t i = 0; i < first_.size(); ++i) at.segment<2>(place(i)) = first_[i];
        MatrixXd H = jacobian(at, seen), S;
        const auto gain = [&] {
            S = H * prior * H.transpose();
            S.diagonal().array() += s_.sensor.sigma * s_.sensor.sigma;
            return MatrixXd(S.ldlt().solve(H * prior).transpose());
        };
        MatrixXd K = gain();
        const VectorXd nu = innovation(predicted, k, seen);
        step_.nis = nu.dot(S.ldlt().solve(nu));
        VectorXd delta = K * nu, before = delta;
        for (int pass = 1; estimator_ == Estimator::iekf && pass < 8; ++pass) {
            before = delta;
            H = jacobian(predicted + delta, seen);
            K = gain();
            delta = K * (innovation(predicted + delta, k, seen) + H * delta);
        }
        step_.last_move = delta - before;
        x() = invariant ? moved(predicted, delta) : VectorXd(predicted + delta);
        const MatrixXd back = invariant ? MatrixXd(chart(x()).inverse()) : T;
        P() = back * (prior - K * H * prior) * back.transpose();
    }

    void see_new(int k) {
        for (int j = 0; j < feature_count(s_); ++j) {
            const auto& known = step_.landmarks;
            if (std::find(known.begin(), known.end(), j) == known.end() && loop_.sees(k, j)) initialise(k, j);
        }
    }

    void initialise(int k, int j) {
        const Index n = x().size();
        const Vector2d position = x().segment<2>(r);
        const Vector2d landmark = position + rotation(x()[theta]) * loop_.measured(k, j, noise_);
        Vector2d lever = landmark - position;
        if (estimator_ == Estimator::ideal) lever = loop_.landmark(j) - loop_.position(k);
        if (estimator_ == Estimator::fej) lever = landmark - predicted_position_;
        MatrixXd grow = MatrixXd::Zero(n + 2, n);
        grow.topRows(n).setIdentity();
        grow.block<2, 2>(n, r).setIdentity();
        if (estimator_ != Estimator::riekf) grow.block<2, 1>(n, theta) = quarter_turn() * lever;
        const MatrixXd T = estimator_ == Estimator::riekf ? chart(x()) : MatrixXd(MatrixXd::Identity(n, n));
        MatrixXd grown = grow * T * P() * T.transpose() * grow.transpose();
        grown.bottomRightCorner<2, 2>().diagonal().array() += s_.sensor.sigma * s_.sensor.sigma;
        x().conservativeResize(n + 2);
        x().tail<2>() = landmark;
        if (estimator_ == Estimator::riekf) {
            const MatrixXd back = chart(x()).inverse();
            grown = back * grown * back.transpose();
        }
        P() = grown;
        step_.landmarks.push_back(j);
        first_.push_back(landmark);
    }

    const ExploreSettings& s_;
    Loop loop_;
    Estimator estimator_;
    const Noise& noise_;
    LandmarkStep step_;
    Vector2d predicted_position_ = Vector2d::Zero();
    std::vector<Vector2d> first_;  ///< first estimates of the landmarks
};

}  // namespace

std::vector<LandmarkStep> landmark_trial(const ExploreSettings& scenario, Estimator estimator, const Noise& noise) {
    Filter filter(scenario, estimator, noise);
    std::vector<LandmarkStep> steps{filter.step(0)};
    for (int k = 1; k < scenario.poses; ++k) {
        filter.go_to(k);
        steps.push_back(filter.step(k));
    }
    return steps;
}

}  // namespace credence::oracle
