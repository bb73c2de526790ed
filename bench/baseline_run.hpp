#pragma once
// A baseline's trial, poses in order: the truth, the filter on it, and the trial's columns.

#include "baseline_trial.hpp"

namespace credence::bench {

/// The true state, world frame.
struct World {
    double heading = 0;
    Eigen::Vector2d robot = Eigen::Vector2d::Zero();
    std::vector<Eigen::Vector2d> centre, feature;
};

template <class Style, Process process, class Noise>
class BaselineRun final : public Baseline {
public:
    using Model = Filter<Style, process>;

    BaselineRun(const ProblemView& problem, Controller controller)
        : problem_(problem),
          controller_(controller),
          model_(problem),
          x_(problem.state_size),
          P_(problem.state_size, problem.state_size) {
        truth_.centre.resize(static_cast<std::size_t>(problem.features));
        truth_.feature.resize(static_cast<std::size_t>(problem.features));
        seen_.reserve(static_cast<std::size_t>(problem.features));
    }

    void run(std::uint64_t root_seed, std::int64_t trial, double* columns) override {
        Noise noise(root_seed, trial);
        start(noise);
        int unseen = 0, rows = 0;
        double pose_error = squared_pose_error(), nees = 0, nis = 0;
        for (int k = 1; k < problem_.poses; ++k) {
            const Control control =
                controller_ == Controller::greedy ? model_.plan(x_, P_, k) : problem_.control.fixed[k - 1];
            move(control, k, noise);
            model_.predict(x_, P_, control, k);
            unseen += look(k, noise);
            rows += model_.rows(seen_);
            nis += model_.update(x_, P_, seen_, [&](const Edge& edge) -> Eigen::Vector2d {
                return at(truth_.feature, edge.to) - at(truth_.feature, edge.from);
            });
            nees += squared_error();
            pose_error += squared_pose_error();
        }
        columns[column_trace_P] = P_.trace();
        columns[column_unseen] = unseen;
        columns[column_pose_error] = pose_error;
        columns[column_nees_ratio] = nees / ((problem_.poses - 1) * problem_.state_size);
        columns[column_nis_ratio] = nis / rows;
    }

private:
    static Eigen::Vector2d& at(std::vector<Eigen::Vector2d>& points, int j) {
        return points[static_cast<std::size_t>(j)];
    }
    static Eigen::Vector2d vector(const Point& point) { return {point.x, point.y}; }

    /// p = c + o + sigma_def eps
    void deform(int j, int k, Noise& noise) {
        at(truth_.feature, j) = at(truth_.centre, j) + vector(problem_.world.sway_at(k, j)) +
                                problem_.world.sigma_deformation * noise.two(Source::deformation, k, j);
    }

    void start(Noise& noise) {
        truth_.heading = 0;
        truth_.robot.setZero();
        x_.setZero();
        P_.setZero();
        for (int j = 0; j < problem_.features; ++j) {
            at(truth_.centre, j) = vector(problem_.world.first_position[j]);
            deform(j, 0, noise);
            const double sigma = model_.sigma_at(at(truth_.feature, j).norm());
            const int f = Model::feature(j);
            x_.template segment<2>(f) = at(truth_.feature, j) + sigma * noise.two(Source::measurement, 0, j);
            P_.diagonal().template segment<2>(f).setConstant(model_.believed_variance(sigma));
        }
    }

    /// The truth from pose k - 1 to k.
    void move(const Control& control, int k, Noise& noise) {
        const WorldParameters& world = problem_.world;
        for (int j = 0; j < problem_.features; ++j) {
            at(truth_.centre, j) +=
                vector(world.translation[k - 1]) + world.sigma_walk * noise.two(Source::walk, k - 1, j);
            deform(j, k, noise);
        }
        Eigen::Vector2d step = vector(control.move);
        if constexpr (Model::has_heading) {
            step = Eigen::Rotation2Dd(truth_.heading) * step;
            truth_.heading += control.turn + world.sigma_heading * noise.one(Source::odometry_heading, k, 0);
        }
        truth_.robot += step + world.sigma_odometry * noise.two(Source::odometry_position, k, 0);
    }

    /// Collects what is seen at pose k; returns how many features are not. Those draw all the same.
    int look(int k, Noise& noise) {
        Eigen::Matrix2d Rt = Eigen::Matrix2d::Identity();
        if constexpr (Model::has_heading) Rt = Eigen::Rotation2Dd(-truth_.heading).toRotationMatrix();
        seen_.clear();
        for (int j = 0; j < problem_.features; ++j) {
            const Eigen::Vector2d difference = at(truth_.feature, j) - truth_.robot;
            const Eigen::Vector2d draw = noise.two(Source::measurement, k, j);
            const double q = difference.norm();
            if (!model_.in_range(q)) continue;
            const double sigma = model_.sigma_at(q);
            seen_.push_back({j, Rt * difference + sigma * draw, model_.believed_variance(sigma)});
        }
        return problem_.features - static_cast<int>(seen_.size());
    }

    double heading_error() const { return std::remainder(x_[0] - truth_.heading, 2 * EIGEN_PI); }

    double squared_pose_error() const {
        double sum = (x_.template segment<2>(Model::position) - truth_.robot).squaredNorm();
        if constexpr (Model::has_heading) sum += heading_error() * heading_error();
        return sum;
    }

    /// NEES of the whole state.
    double squared_error() const {
        typename Style::State error = x_;
        if constexpr (Model::has_heading) error[0] = heading_error();
        error.template segment<2>(Model::position) -= truth_.robot;
        for (int j = 0; j < problem_.features; ++j)
            error.template segment<2>(Model::feature(j)) -= truth_.feature[static_cast<std::size_t>(j)];
        return Style::squared_error(P_, error);
    }

    const ProblemView& problem_;
    Controller controller_;
    Model model_;
    World truth_;
    typename Style::State x_;
    typename Style::Covariance P_;
    std::vector<Seen> seen_;
};

template <class Style, Process process>
std::unique_ptr<Baseline> make_run(const ProblemView& problem, Controller controller, Draws draws) {
    if (draws == Draws::keyed) return std::make_unique<BaselineRun<Style, process, KeyedNoise>>(problem, controller);
    return std::make_unique<BaselineRun<Style, process, StandardNoise>>(problem, controller);
}

}  // namespace credence::bench
