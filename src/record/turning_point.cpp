// How far the truth would have to be off for NEES to be right [docs/statistics.md, Uncertain truth].

#include <algorithm>

#include "numeric/decompositions.hpp"
#include "record/read.hpp"

namespace credence {

namespace {

/// NEES/dimension by P + s^2 I: with P = L L', L^-1 L'^-1 = U diag(mu) U' and w = U' L^-1 e it is the mean of
/// w^2/(1 + s^2 mu).
struct NeesWithTruth {
    std::vector<double> squares, mu;  ///< [steps, d]

    double ratio(double s) const {
        double sum = 0;
        for (std::size_t i = 0; i < mu.size(); ++i) sum += squares[i] / (1 + s * s * mu[i]);
        return sum / static_cast<double>(mu.size());
    }

    /// The smallest s at which the ratio, which decreases, is at most this.
    double sigma_at(double most) const {
        if (!(ratio(0) > most)) return 0;
        double low = 0, high = 1;
        while (ratio(high) > most) high *= 2;
        for (int i = 0; i < 100; ++i) (ratio((low + high) / 2) > most ? low : high) = (low + high) / 2;
        return high;
    }
};

}  // namespace

/// Of at most 100,000 steps.
std::vector<double> truth_sigmas(const RecordReader& reader, const std::vector<int>& components,
                                 const std::vector<double>& nees) {
    const RecordShape& shape = reader.shape();
    const auto each = [&](const auto& use) {
        each_present_step(reader, [&](const RecordStep& step, const CheckedStep& checked) {
            if (std::ranges::all_of(components, [&](int j) { return checked.has(j); }))
                use(static_cast<std::size_t>(step.trial), Eigen::VectorXd(checked.e(components)),
                    covariance_of(checked, components));
        });
    };
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(std::ssize(components));
    std::vector<Eigen::VectorXd> errors(static_cast<std::size_t>(shape.trials), none), weights = errors;
    std::int64_t steps = 0, next = 0;
    each([&](std::size_t run, const Eigen::VectorXd& e, const Eigen::MatrixXd& P) {
        errors[run] += e.cwiseQuotient(P.diagonal());
        weights[run] += P.diagonal().cwiseInverse();
        ++steps;
    });
    NeesWithTruth with_truth;
    each([&](std::size_t run, Eigen::VectorXd e, const Eigen::MatrixXd& P) {
        const CholeskyFactor factor(P);
        if (next++ % (1 + steps / 100'000) != 0 || !factor.succeeded()) return;
        if (shape.trials < runs_that_tell) e -= errors[run].cwiseQuotient(weights[run]);
        const Eigen::MatrixXd inverse = factor.solve_lower(Eigen::MatrixXd::Identity(P.rows(), P.cols()));
        const Eigenpairs pairs = eigenpairs(inverse * inverse.transpose());
        const Eigen::VectorXd w = pairs.vectors.transpose() * (inverse * e);
        for (Eigen::Index i = 0; i < w.size(); ++i) with_truth.squares.push_back(w[i] * w[i]);
        with_truth.mu.insert(with_truth.mu.end(), pairs.values.begin(), pairs.values.end());
    });
    std::vector<double> sigmas;
    for (const double most : nees) sigmas.push_back(with_truth.sigma_at(most));
    return sigmas;
}

}  // namespace credence
