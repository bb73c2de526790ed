// The errors of a record about their mean over the trials, step by step [docs/statistics.md, Attribution].

#include "record/read.hpp"
#include "record/totals.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

/// Sums over the trials at one step; of components that are not in the state they are 0.
struct StepSums {
    Eigen::MatrixXd weight;         ///< [n, n] of P^-1
    Eigen::VectorXd weighted, sum;  ///< [n] of P^-1 e, and of e
    double squares = 0, trials = 0; ///< of e' P^-1 e

    void add(const CheckedStep& step) {
        const Eigen::Index n = step.e.size();
        if (weight.size() == 0) {
            weight = Eigen::MatrixXd::Zero(n, n);
            weighted = sum = Eigen::VectorXd::Zero(n);
        }
        std::vector<int> here;
        for (int j = 0; j < n; ++j)
            if (step.has(j)) here.push_back(j);
        const Eigen::VectorXd e = step.e(here);
        const Eigen::MatrixXd inverse =
            covariance_of(step, here).llt().solve(Eigen::MatrixXd::Identity(e.size(), e.size()));
        const Eigen::VectorXd solved = inverse * e;
        weight(here, here) += inverse;
        weighted(here) += solved;
        sum(here) += e;
        squares += e.dot(solved);
        ++trials;
    }

    /// The mean that the errors are about.
    Eigen::VectorXd mean() const {
        std::vector<Eigen::Index> known;
        for (Eigen::Index j = 0; j < weighted.size(); ++j)
            if (weight(j, j) > 0) known.push_back(j);
        Eigen::VectorXd mean = Eigen::VectorXd::Zero(weighted.size());
        const Eigen::MatrixXd of_known = weight(known, known);
        const Eigen::VectorXd weighted_known = weighted(known), of_them = of_known.llt().solve(weighted_known);
        mean(known) = of_them;
        return mean;
    }
};

/// The share of NEES that errors have in common: of products of different trials, over that of all.
double share_of_mean(const std::vector<StepSums>& steps) {
    double together = 0, all = 0;
    for (const StepSums& step : steps) {
        if (step.trials < 2) continue;
        together += (step.weighted.dot(step.sum) - step.squares) / (step.trials * (step.trials - 1));
        all += step.squares / step.trials;
    }
    return together / all;
}

}  // namespace

bool has_step_means(const RecordShape& shape) {
    constexpr std::int64_t most = std::int64_t{1} << 24;
    return shape.has_errors && (shape.has_joint() || shape.has_variances) &&
           std::int64_t{shape.n} * shape.n * shape.steps <= most;
}

AboutMeans read_about_means(const RecordReader& reader, const std::string& name, const std::vector<char>& counted) {
    std::vector<StepSums> sums(static_cast<std::size_t>(reader.shape().steps));
    const auto is_counted = [&](const RecordStep& step) { return counted[static_cast<std::size_t>(step.trial)] != 0; };
    each_present_step(reader, [&](const RecordStep& step, const CheckedStep& checked) {
        if (is_counted(step)) sums[static_cast<std::size_t>(step.step)].add(checked);
    });
    std::vector<Eigen::VectorXd> means;
    for (const StepSums& step : sums) means.push_back(step.mean());

    RecordShape shape = reader.shape();
    shape.declared.clear();
    for (std::size_t trial = 0; trial < reader.shape().declared.size(); ++trial)
        if (counted[trial]) shape.declared.push_back(reader.shape().declared[trial]);
    shape.trials = std::count(counted.begin(), counted.end(), 1);
    shape.columns.clear();
    shape.times.clear();
    RecordTotals totals(shape, name, DivergedTrials::counted, Copies::count);
    std::vector<double> about(static_cast<std::size_t>(shape.n));
    std::int64_t last = -1, trial = -1;
    each_step(reader, [&](const RecordStep& given) {
        if (!is_counted(given)) return;
        if (given.trial != last) ++trial, last = given.trial;
        RecordStep step = given;
        step.trial = trial;
        const auto k = static_cast<std::size_t>(step.step);
        const double larger = std::sqrt(sums[k].trials / (sums[k].trials - 1));
        for (std::size_t j = 0; sums[k].trials > 1 && j < about.size(); ++j)
            about[j] = (step.error[j] - means[k](static_cast<Eigen::Index>(j))) * larger;
        if (sums[k].trials > 1) step.error = about.data();
        totals.add(step);
    });
    return {totals.finish().results, share_of_mean(sums)};
}

}  // namespace credence
