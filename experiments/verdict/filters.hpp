#pragma once
// Filters whose errors are drawn directly, right ones and wrong ones, for the rates of the verdict. Every draw is keyed
// by seed, trial, step and component, so that a study is the same for any order of trials and any number of threads.

#include <credence/columns.hpp>
#include <credence/detail/draws.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <vector>

namespace credence::rates {

/// What a draw is for.
enum class Purpose { error, scale, process, measurement, innovation };

/// The draws of one trial of one study.
class Draws {
public:
    Draws(std::uint64_t seed, std::int64_t trial);
    double normal(Purpose purpose, int step, int index) const;
    double uniform(int step, int index) const;

private:
    KeyedDraws<double> keyed_;
};

/// The shape of errors of covariance 1. Scales are drawn once a trial, a step, or for each component of each step.
enum class Tails {
    normal,
    t5_trial,
    t5_step,
    t5_component,
    t5_component_trial,   ///< one scale a component, for all steps of a trial
    laplace,              ///< each component of each step
    contaminated_steps,   ///< 5 % of steps are three times as large
    contaminated_trials,
    outlying_steps,       ///< 1 % of steps are five times as large
    rarely_diverged,      ///< 0.3 % of trials are eight times as large, and the others have covariance 1
    diverged,             ///< 1 % are ten times as large, likewise
};

/// One trial, a column for each step.
struct Trial {
    Eigen::MatrixXd error;       ///< [n, steps]
    Eigen::MatrixXd innovation;  ///< [m, steps], its covariance is 1; m = 0 without innovations
};

/// A filter: what it says of its errors, and the errors it makes.
struct Filter {
    std::vector<ComponentGroup> groups;         ///< the whole state first
    std::vector<Eigen::MatrixXd> covariance;    ///< [steps], each [n, n]
    int rows = 0;                               ///< of an innovation
    std::function<Trial(const Draws&)> trial;
};

/// Errors that are an autoregressive path over the steps, with the covariance 1 and a correlation of successive steps.
struct Path {
    int n = 4, steps = 10;
    double correlation = 0.8;
    Tails tails = Tails::normal;
};

Filter right(const Path& path);
/// Its P is so many times the right one.
Filter scaled(const Path& path, double factor);
/// It does not know that its first and its last component, of different groups, are correlated.
Filter dropped(const Path& path, double correlation);
/// Its P of the second group is so many times the right one.
Filter wrong_group(const Path& path, double factor);
/// Along one direction of the state, which no component is near, the variance is so many times what it says.
Filter wrong_direction(const Path& path, double variance);
/// The first component is off by so many sigmas.
Filter biased(const Path& path, double sigmas);
/// Its errors are right; its innovations of two rows have this correlation from step to step.
Filter with_innovations(const Path& path, double correlation);

/// A Kalman filter that tracks a point of nearly constant velocity in the plane by its position: x, y, vx, vy over ten
/// steps of 1 s, noise of 1 in each measurement and of 0.1 in the acceleration.
struct Tracker {
    double covariance = 1;  ///< factor on the P that it says
    double position = 1;    ///< a further factor on the position's
    double bias = 0;        ///< of x, in sigmas
};

Filter tracker(const Tracker& settings);

}  // namespace credence::rates
