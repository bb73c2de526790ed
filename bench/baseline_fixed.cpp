// Baseline B: sizes known to the compiler where they are fixed, bounded where they are not; Cholesky instead of an
// inverse; nothing on the heap.

#include "baseline_run.hpp"

namespace credence::bench {

namespace {

template <Process process, int M>
struct Fixed {
    static constexpr int n = (process == Process::heading ? 3 : 2) + 2 * M, most_rows = 2 * M + M * (M - 1);
    using State = Eigen::Matrix<double, n, 1>;
    using Covariance = Eigen::Matrix<double, n, n>;
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, n, 0, most_rows, n>;
    using Measurement = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_rows, 1>;

    /// P <- F P F', F = I but for the rows r of the column theta, which are a.
    static void transition(Covariance& P, const Eigen::Vector2d& a) {
        const Eigen::Matrix<double, 1, n> theta = P.row(0);
        P.template middleRows<2>(1).noalias() += a * theta;
        const State theta_column = P.col(0);
        P.template middleCols<2>(1).noalias() += theta_column * a.transpose();
    }

    /// S = L L', W = L^-1 H P: K nu = W' L^-1 nu and K S K' = W' W.
    struct Gain {
        using Columns = Eigen::Matrix<double, Eigen::Dynamic, n, 0, most_rows, n>;
        using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_rows, most_rows>;
        Columns W;
        Eigen::LLT<Square> S;

        Gain(const Covariance& P, const Rows& H, const Measurement& N) {
            W.noalias() = H * (P);
            Square S_sum = W * (H.transpose());
            S_sum.diagonal() += N;
            S.compute(S_sum);
            S.matrixL().solveInPlace(W);
        }
        void correct(State& x, const Measurement& nu) const { x.noalias() += W.transpose() * S.matrixL().solve(nu); }
        void apply(Covariance& P) const { P.noalias() -= W.transpose() * (W); }
        double squared(const Measurement& nu) const { return S.matrixL().solve(nu).squaredNorm(); }
    };

    static void settle(Covariance&) {}

    static double squared_error(const Covariance& P, const State& error) { return error.dot(P.llt().solve(error)); }
};

template <int M>
std::unique_ptr<Baseline> make(const ProblemView& problem, Controller controller, Draws draws) {
    return make_run<Fixed<Process::heading, M>, Process::heading>(problem, controller, draws);
}

}  // namespace

std::unique_ptr<Baseline> make_fixed(const ProblemView& problem, Controller controller, Draws draws) {
    if (problem.process == Process::translation) {
        if (problem.features != 3) return nullptr;
        return make_run<Fixed<Process::translation, 3>, Process::translation>(problem, controller, draws);
    }
    switch (problem.features) {
        case 1:
            return make<1>(problem, controller, draws);
        case 2:
            return make<2>(problem, controller, draws);
        case 3:
            return make<3>(problem, controller, draws);
        case 4:
            return make<4>(problem, controller, draws);
        case 6:
            return make<6>(problem, controller, draws);
        case 8:
            return make<8>(problem, controller, draws);
        default:
            return nullptr;
    }
}

}  // namespace credence::bench
