#pragma once
// The studies of tests/reference/verdict.json. Their trials are functions of keyed draws, here as in make_verdict.py;
// errors are standardised already: P has a unit diagonal.

#include <Eigen/Dense>
#include <credence/detail/draws.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "statistics/moments/trial_moments.hpp"

namespace credence::test {

inline const nlohmann::json& verdict_cases() {
    static const auto cases = nlohmann::json::parse(std::ifstream(CREDENCE_SOURCE "/tests/reference/verdict.json"));
    return cases;
}

/// One study that is drawn.
class VerdictCase {
public:
    explicit VerdictCase(const nlohmann::json& settings)
        : one_(settings), n_(one_.at("n")), steps_(one_.at("steps")), trials_(one_.at("trials")) {}

    std::vector<std::vector<int>> groups() const { return one_.at("groups"); }

    TrialMoments moments() const {
        TrialMoments moments{n_, static_cast<int>(groups().size()), {}, {}};
        for (std::int64_t i = 0; static_cast<int>(moments.trials()) < trials_; ++i)
            if (!one_.at("gaps") || i % 7 != 5) fill(moments.append(i), draw(i));
        return moments;
    }

private:
    struct Trial {
        std::vector<Eigen::VectorXd> e;  ///< by step
        std::vector<Eigen::MatrixXd> P;
    };

    static Eigen::MatrixXd correlation(double r, int n) {
        Eigen::MatrixXd matrix(n, n);
        for (int a = 0; a < n; ++a)
            for (int b = 0; b < n; ++b) matrix(a, b) = std::pow(r, std::abs(a - b));
        return matrix;
    }

    double scale(const KeyedDraws<double>& draws) const {
        if (one_.at("tails") == "t5") {
            double q = 0;
            for (int j = 0; j < 5; ++j) q += std::pow(draws.normal(Source::walk, 0, j).x, 2);
            return std::sqrt(3 / q);
        }
        if (one_.at("tails") == "contaminated")
            return (draws.uniform(Source::detection, 0, 0) < 0.05 ? 3 : 1) / std::sqrt(1.4);
        return 1;
    }

    Trial draw(std::int64_t i) const {
        const KeyedDraws<double> draws(one_.at("seed").get<std::uint64_t>(), static_cast<std::uint64_t>(i),
                                       std::numeric_limits<double>::infinity());
        const double rho = one_.at("rho"), size = scale(draws) * one_.at("scale").get<double>(),
                     wobble = 0.8 + 0.4 * draws.uniform(Source::detection, 0, 1);
        Trial trial;
        Eigen::VectorXd w(n_);
        for (int k = 0; k < steps_; ++k) {
            for (int j = 0; j < n_; ++j) {
                const double g = draws.normal(Source::measurement, k, j).x;
                w[j] = k == 0 ? g : rho * w[j] + std::sqrt(1 - rho * rho) * g;
            }
            const double now = wobble * (1 - k / (2.0 * steps_));
            const Eigen::MatrixXd truth = correlation(one_.at("true").get<double>() * now, n_);
            trial.e.push_back(size * Eigen::VectorXd(truth.llt().matrixL() * w));
            trial.P.push_back(correlation(one_.at("claimed").get<double>() * now, n_));
            spoil(trial.e.back(), trial.P.back());
        }
        return trial;
    }

    void spoil(Eigen::VectorXd& e, Eigen::MatrixXd& P) const {
        e[0] += one_.at("bias").get<double>();
        if (one_.at("kind") == "exact") e[n_ - 1] = 0;
        if (one_.at("kind") != "singular") return;
        e[n_ - 1] = e[0];
        P.row(n_ - 1) = P.row(0);
        P.col(n_ - 1) = P.col(0);
        P(n_ - 1, n_ - 1) = 1;
    }

    /// NEES/dimension of a group; a component that is known exactly, or is another's copy, is left out.
    double nees(const Trial& trial, std::size_t k, std::vector<int> group) const {
        if (one_.at("kind") != "") std::erase(group, n_ - 1);
        const auto d = static_cast<Eigen::Index>(group.size());
        Eigen::VectorXd e(d);
        Eigen::MatrixXd P(d, d);
        for (Eigen::Index a = 0; a < d; ++a) {
            e[a] = trial.e[k][group[static_cast<std::size_t>(a)]];
            for (Eigen::Index b = 0; b < d; ++b)
                P(a, b) = trial.P[k](group[static_cast<std::size_t>(a)], group[static_cast<std::size_t>(b)]);
        }
        return e.dot(P.llt().solve(e)) / static_cast<double>(d);
    }

    void fill(double* row, const Trial& trial) const {
        for (const std::vector<int>& group : groups()) {
            double sum = 0;
            for (std::size_t k = 0; k < trial.e.size(); ++k) sum += nees(trial, k, group);
            *row++ = sum / steps_;
        }
        Eigen::VectorXd z = Eigen::VectorXd::Zero(n_);
        Eigen::MatrixXd S = Eigen::MatrixXd::Zero(n_, n_), C = S;
        for (std::size_t k = 0; k < trial.e.size(); ++k) {
            z += trial.e[k] / steps_;
            S += trial.e[k] * trial.e[k].transpose();
            C += trial.P[k];
        }
        for (int j = 0; j < n_; ++j) *row++ = z[j];
        for (const Eigen::MatrixXd* matrix : {&S, &C})
            for (int a = 0; a < n_; ++a)
                for (int b = 0; b <= a; ++b) *row++ = (*matrix)(a, b);
    }

    const nlohmann::json& one_;
    int n_, steps_, trials_;
};

/// Numbers of order 1 that are computed in two ways from a few hundred trials agree to 1e-10: rounding, times the
/// condition of P.
inline void check_close(double value, double expected) {
    CAPTURE(value, expected);
    CHECK(std::abs(value - expected) <= 1e-10 * std::max(1.0, std::abs(expected)));
}

inline void check_close(const Interval& value, const nlohmann::json& expected) {
    check_close(value.low, expected[0].get<double>());
    check_close(value.high, expected[1].get<double>());
}

}  // namespace credence::test
