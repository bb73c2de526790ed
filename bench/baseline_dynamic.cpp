// Baseline A: plain dynamic Eigen, the formulas of docs/model.md as written.

#include "baseline_run.hpp"

namespace credence::bench {

namespace {

struct Plain {
    using State = Eigen::VectorXd;
    using Covariance = Eigen::MatrixXd;
    using Rows = Eigen::MatrixXd;
    using Measurement = Eigen::VectorXd;

    /// P <- F P F', F = I but for the rows r of the column theta, which are a.
    static void transition(Covariance& P, const Eigen::Vector2d& a) {
        Eigen::MatrixXd F = Eigen::MatrixXd::Identity(P.rows(), P.cols());
        F.block<2, 1>(1, 0) = a;
        P = F * P * F.transpose();
    }

    struct Gain {
        Eigen::MatrixXd PHt, S_inverse, K;

        Gain(const Covariance& P, const Rows& H, const Measurement& N) {
            PHt = P * H.transpose();
            Eigen::MatrixXd S = H * PHt;
            S.diagonal() += N;
            S_inverse = S.inverse();
            K = PHt * S_inverse;
        }
        void correct(State& x, const Measurement& nu) const { x += K * nu; }
        /// P - K S K' = P - K (P H')'
        void apply(Covariance& P) const { P -= K * PHt.transpose(); }
        double squared(const Measurement& nu) const { return nu.dot(S_inverse * nu); }
    };

    /// With an inverse, K (P H')' is not quite symmetric, and the asymmetry grows from step to step.
    static void settle(Covariance& P) { P = 0.5 * (P + P.transpose()).eval(); }

    static double squared_error(const Covariance& P, const State& error) { return error.dot(P.ldlt().solve(error)); }
};

}  // namespace

std::unique_ptr<Baseline> make_dynamic(const ProblemView& problem, Controller controller, Draws draws) {
    if (problem.process == Process::heading) return make_run<Plain, Process::heading>(problem, controller, draws);
    return make_run<Plain, Process::translation>(problem, controller, draws);
}

}  // namespace credence::bench
