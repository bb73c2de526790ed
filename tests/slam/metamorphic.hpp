#pragma once
// What the metamorphic tests of trials share: random scenarios, often badly conditioned, how far the image of a trial
// is from the trial, and how far rounding may take it.

#include "images.hpp"

#include "numeric/decompositions.hpp"

#include <optional>
#include <vector>

namespace credence::test {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The estimators of a process.
inline std::vector<Estimator> estimators_of(Process process) {
    if (process == Process::translation) return {Estimator::kf};
    return {Estimator::ekf, Estimator::ideal, Estimator::fej, Estimator::riekf, Estimator::iekf};
}

/// None where the keys that were drawn contradict each other.
inline std::optional<DeformableSettings> random_scenario(unsigned seed, const Settings& more = {}) {
    Settings settings = Lottery(seed).settings();
    settings.insert(settings.end(), more.begin(), more.end());
    if (seed % 2 == 0) settings.emplace_back("truth.edge_noise", "independent");
    if (seed % 3 == 0) settings.emplace_back("sensor.detection", "0.8");
    if (seed % 5 == 0) settings.emplace_back("truth.deformation", "walk");
    try {
        return scenario_with(settings);
    } catch (const InputError&) {
        return {};
    }
}

inline void raise(double& greatest, double difference) {
    greatest = std::isnan(difference) ? infinity : std::max(greatest, difference);
}

/// |a - b| as a share of `size`; 0 where both are the same, NaN included.
inline double share(double a, double b, double size) {
    return a == b || (std::isnan(a) && std::isnan(b)) ? 0 : std::abs(a - b) / size;
}

/// Greatest difference of the image's belief and truth at a pose from the image of the belief and the truth, in
/// standard deviations of the belief.
inline double state_difference(const RunStep& step, const RunStep& other, const MatrixXd& map) {
    const VectorXd mean = map * step.mean, truth = map * step.truth;
    const MatrixXd P = map * step.covariance * map.transpose();
    const VectorXd sigma = P.diagonal().cwiseSqrt();
    double greatest = 0;
    for (Eigen::Index i = 0; i < mean.size(); ++i) {
        raise(greatest, share(other.mean[i], mean[i], sigma[i]));
        raise(greatest, share(other.truth[i], truth[i], sigma[i]));
        for (Eigen::Index j = 0; j < mean.size(); ++j)
            raise(greatest, share(other.covariance(i, j), P(i, j), sigma[i] * sigma[j]));
    }
    return greatest;
}

/// Greatest difference of the series without a unit at pose k, as a share of 1 + the value; infinite where other
/// features are seen.
inline double series_difference(const Run& run, const Run& other, const Image& image, int k) {
    double greatest = 0;
    const auto compare = [&](const std::string& name, const std::string& before) {
        const double value = run.figure(before, k);
        raise(greatest, share(other.figure(name, k), value, 1 + std::abs(value)));
    };
    for (const char* name : {"nees", "nees_pose", "nees_features", "nis", "nis_features", "nis_edges", "nis_rows",
                             "unseen_features"})
        compare(name, name);
    const auto at = static_cast<std::size_t>(k);
    for (std::size_t j = 0; j < image.feature.size(); ++j) {
        const int before = image.feature[j];
        compare("nees_feature_" + std::to_string(j), "nees_feature_" + std::to_string(before));
        if (other.steps[at].seen[j] != run.steps[at].seen[static_cast<std::size_t>(before)]) greatest = infinity;
    }
    return greatest;
}

/// Greatest difference of a trial's image from the trial, over its poses.
inline double difference(const Run& run, const Run& other, const Image& image) {
    double greatest = state_difference(run.steps[0], other.steps[0], image.map);
    for (int k = 1; k < image.scenario.poses; ++k) {
        const auto at = static_cast<std::size_t>(k);
        raise(greatest, state_difference(run.steps[at], other.steps[at], image.map));
        raise(greatest, series_difference(run, other, image, k));
    }
    return greatest;
}

/// Whether a filter is ever a hundred standard deviations off. Where it linearises has then little to do with the
/// truth, and what rounding leaves is multiplied from pose to pose.
inline bool is_lost(const Run& run) { return !(run.series("nees").maxCoeff() < 1e4); }

/// What rounding may do to all of this. An update that leaves a share 1/loss of a variance leaves rounding errors of
/// loss epsilon in P, and NEES multiplies them by n over the smallest eigenvalue of the correlation matrix
/// [numeric/decompositions.hpp]; the errors are small differences of coordinates, which have `size` standard
/// deviations; and all poses before have added their share.
inline double rounding_of(const Run& run) {
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    double bound = 0, loss = 1, size = 1;
    for (std::size_t k = 1; k < run.steps.size(); ++k) {
        const RunStep& step = run.steps[k];
        const VectorXd prior = step.prior_covariance.diagonal(), left = step.covariance.diagonal();
        if (!(left.minCoeff() > 0)) return infinity;
        raise(bound,
              std::max(rounding_bound(step.prior_covariance, epsilon), rounding_bound(step.covariance, epsilon)));
        raise(loss, prior.cwiseQuotient(left).maxCoeff());
        raise(size, step.truth.cwiseQuotient(left.cwiseSqrt()).cwiseAbs().maxCoeff());
    }
    return bound * loss * size * static_cast<double>(run.steps.size());
}

}  // namespace credence::test
