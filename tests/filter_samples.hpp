#pragma once
// Random beliefs of both process models, and the way between Eigen's matrices and the filter's.

#include "support.hpp"

#include "slam/trial/problem.hpp"

#include <random>

namespace credence::test {

using Eigen::MatrixXd;
using Eigen::VectorXd;

template <class Layout>
Belief<double, Layout::capacity> belief_of(const VectorXd& x, const MatrixXd& P) {
    Belief<double, Layout::capacity> belief{};
    for (int i = 0; i < x.size(); ++i) {
        belief.mean[i] = x[i];
        for (int j = i; j < x.size(); ++j) belief.covariance.entry[i][j] = P(i, j);
    }
    return belief;
}

template <class Belief>
MatrixXd dense(const Belief& belief, Eigen::Index n) {
    MatrixXd P(n, n);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) P(i, j) = belief.covariance.at(i, j);
    return P;
}

template <class Belief>
VectorXd mean_of(const Belief& belief, Eigen::Index n) {
    return Eigen::Map<const VectorXd>(belief.mean, n);
}

/// The sighting of one feature of three.
template <class Layout, class Truth, class Noise>
Sighting<double> look_at(const Truth& truth, const SensorParameters& sensor, int k, int j, const Noise& noise) {
    Sighting<double> sightings[3];
    const WorldDraws<Layout, double> draws = draws_at<Layout>(noise, k);
    look(truth, sensor, Layout(3), k, draws.template of_features<Source::measurement>(), noise, sightings);
    return sightings[j];
}

/// P_1 (x) I_2: the covariance of an even number of components, both axes alike.
inline MatrixXd on_both_axes(const MatrixXd& axis) {
    MatrixXd P = MatrixXd::Zero(2 * axis.rows(), 2 * axis.rows());
    for (Eigen::Index i = 0; i < P.rows(); ++i)
        for (Eigen::Index j = i % 2; j < P.rows(); j += 2) P(i, j) = axis(i / 2, j / 2);
    return P;
}

/// A random state near the reference study's and a random covariance with everything correlated, eigenvalues from 0.1
/// to about 10; without a heading (n even), as the translation model has it.
struct Sample {
    VectorXd x;
    MatrixXd P;
    Sample(int n, unsigned seed) : x(n), P(n, n) {
        std::mt19937 random(seed);
        std::normal_distribution<double> normal;
        MatrixXd A(n, n);
        for (int i = 0; i < n; ++i) {
            x[i] = normal(random);
            for (int j = 0; j < n; ++j) A(i, j) = 0.7 * normal(random);
        }
        P = A * A.transpose() + 0.1 * MatrixXd::Identity(n, n);
        if (n % 2 == 0) P = on_both_axes(MatrixXd(P.topLeftCorner(n / 2, n / 2)));
    }
};

/// Runs a test on samples of one process model: `test(problem, sample, layout)`.
template <class Layout, class Test>
void with_samples(const char* process, const Settings& more, const Test& test) {
    Settings settings{{"model.process", process}, {"features.path", "circle"}, {"features.sway_amplitude", "0.4"}};
    settings.insert(settings.end(), more.begin(), more.end());
    const Problem problem(scenario_with(settings));
    for (unsigned seed = 1; seed <= 20; ++seed) {
        test(problem, Sample(Layout(3).size(), seed), Layout(3));
    }
}

/// The same on both.
template <class Test>
void with_both(const Settings& more, const Test& test) {
    with_samples<Layout<Process::heading, 3>>("heading", more, test);
    with_samples<Layout<Process::translation, 3>>("translation", more, test);
}

}  // namespace credence::test
