#pragma once
// Module worlds: trials of a user's own world: what its function `run` draws from, and says what its filter says to.
//
//   n  components of the state, m  rows of an innovation; K poses, steps k = 1 ... K - 1
//
// In lanes: where `run` is a template on `Real`, the program runs several trials at once, one in each lane of the
// processor, with the draws, statistics and files of any other world.
//
//   template <class Real>
//   static void run(const Settings& settings, credence::OwnTrialOf<Real>& trial)
//
// Real is a scalar of Eigen's matrices (Eigen::Matrix<Real, 4, 1>), which mix with matrices of doubles. It is a double
// where trials run one at a time, and a number of each of several trials otherwise. These cannot take different
// branches, so that a filter is written without any on a Real:
//   Mask<Real> seen = trial.uniform(detection, k) < 0.9     comparisons give one answer for each trial
//   both(a, b), either(a, b), negated(a); any(mask), all(mask)
//   select(mask, yes, no)                                   of Reals, or of matrices; no may be 0
//   credence::sqrt, sin, cos, atan2, exp, log, abs, min, max, and wrapped, which brings an angle to [-pi, pi]
//   credence::cholesky(S), solve(S, b), inverse(S), determinant(S)
//                                                           of a symmetric positive definite S; Eigen's S.inverse() of
//                                                           up to 4 x 4 works too
// What branches, Eigen's LLT among it, is refused by the compiler with a sentence that says what to write. All of this
// gives the same bits for any number of lanes. Plain doubles, which Eigen adds in another order, agree to rounding.
//
// The lanes come from the CMake function credence_add_world(TARGET HEADER...), which compiles the header once for each
// instruction set. The header ends with CREDENCE_WORLD(World) for each of its worlds. Without it, trials run one at a
// time.

#include <credence/detail/lane_pack.hpp>
#include <credence/detail/symmetric.hpp>

#include <Eigen/Dense>

#include <concepts>
#include <limits>

namespace credence {

/// One trial under one arm: where its noise comes from, and where its errors go.
class OwnTrial {
public:
    /// Vectors and matrices of doubles of any size, fixed sizes among them, and expressions of these.
    using Vector = Eigen::Ref<const Eigen::VectorXd>;
    using Matrix = Eigen::Ref<const Eigen::MatrixXd>;

    virtual ~OwnTrial() = default;

    /// Place of the arm in the scenario's list.
    virtual std::size_t arm() const = 0;
    /// K
    virtual int poses() const = 0;

    /// Two independent standard normal draws, keyed by source (0 to 15), pose (from 0) and index (0 to 2^27 - 1):
    /// never by the order of calls, and the same under every arm. A draw that is not needed need not be asked for. A
    /// key beyond these ends the run with std::logic_error.
    virtual Eigen::Vector2d normal(int source, int pose, int index = 0) const = 0;
    /// Uniform on [0, 1), keyed likewise. Do not ask for both kinds under one key.
    virtual double uniform(int source, int pose, int index = 0) const = 0;

    /// What the filter says after the next step, the first call being step 1: error [n], estimate - truth in the chart
    /// in which the covariance P [n, n] lives, angles wrapped. Of P the lower triangle is read. To be called K - 1
    /// times. A trial with a P that is not positive definite, or a number that is not finite, has failed, which is
    /// data; it ends at once where a number is not finite, and may go on where a P is not positive definite.
    virtual void step(const Vector& error, const Matrix& P) = 0;
    /// The same with the step's innovation [m] and its predicted covariance S [m, m]; m may differ from step to step,
    /// up to what the world declares, and row i is the same measurement at every step: NaN where it was not observed.
    virtual void step(const Vector& error, const Matrix& P, const Vector& innovation, const Matrix& S) = 0;

    /// The value of the world's own column of that place, 0 where it is not set.
    virtual void set(std::size_t column, double value) = 0;

    /// Whether it is asked what P counts for each source, as `credence budget` does of some trials.
    virtual bool counting() const { return false; }
    /// That it counts P_s [n, n] for this source at the step that is said next; over the sources P_s adds up to P.
    virtual void counts(int, const Matrix&) {}
};

inline namespace CREDENCE_TARGET {

/// Trials of one pack under one arm: where their noise comes from, and where their errors go. What is said of OwnTrial
/// holds for each of them.
template <class Real>
class OwnTrialOf {
public:
    explicit OwnTrialOf(LanePack& pack) : pack_(pack) {}

    std::size_t arm() const { return pack_.arm; }
    int poses() const { return pack_.poses; }

    Eigen::Matrix<Real, 2, 1> normal(int source, int pose, int index = 0) const {
        double draw[2 * lanes<Real>];
        pack_.normal(pack_, source, pose, key_index(*pack_.world, source, pose, index), draw);
        return {load<Real>(draw), load<Real>(draw + lanes<Real>)};
    }
    Real uniform(int source, int pose, int index = 0) const {
        double draw[lanes<Real>];
        pack_.uniform(pack_, source, pose, key_index(*pack_.world, source, pose, index), draw);
        return load<Real>(draw);
    }

    /// A trial whose P is not positive definite, or whose numbers are not finite, has failed: it goes on in its lane,
    /// and is counted as failed. The function ends where all have.
    template <class Error, class Covariance>
    void step(const Eigen::MatrixBase<Error>& error, const Eigen::MatrixBase<Covariance>& P) {
        const auto& e = as_reals(error.derived());
        const auto& p = as_reals(P.derived());
        take(e, p, LaneStep{});
    }
    /// The innovation's rows are NaN in the lanes in which they were not observed.
    template <class Error, class Covariance, class Innovation, class InnovationCovariance>
    void step(const Eigen::MatrixBase<Error>& error, const Eigen::MatrixBase<Covariance>& P,
              const Eigen::MatrixBase<Innovation>& innovation, const Eigen::MatrixBase<InnovationCovariance>& S) {
        const auto& e = as_reals(error.derived());
        const auto& p = as_reals(P.derived());
        const auto& nu = as_reals(innovation.derived());
        const auto& s = as_reals(S.derived());
        if (nu.rows() > pack_.largest_innovation) refuse(pack_, "an innovation longer than innovation_rows");
        if (s.rows() != nu.rows() || s.cols() != nu.rows()) refuse(pack_, "an S of another size than its innovation");
        take(e, p, {nullptr, nullptr, static_cast<int>(nu.rows()), numbers(nu), numbers(s)});
    }
    /// The same for an innovation that only some trials have.
    template <class Error, class Covariance, class Innovation, class InnovationCovariance>
    void step(const Eigen::MatrixBase<Error>& error, const Eigen::MatrixBase<Covariance>& P,
              const Eigen::MatrixBase<Innovation>& innovation, const Eigen::MatrixBase<InnovationCovariance>& S,
              Mask<Real> observed) {
        constexpr double nan = std::numeric_limits<double>::quiet_NaN();
        step(error, P, select(observed, innovation, Innovation::Constant(innovation.rows(), 1, nan)), S);
    }
    /// The same for an innovation that all trials have, or none.
    template <class Error, class Covariance, class Innovation, class InnovationCovariance, std::same_as<bool> Bool>
    void step(const Eigen::MatrixBase<Error>& error, const Eigen::MatrixBase<Covariance>& P,
              const Eigen::MatrixBase<Innovation>& innovation, const Eigen::MatrixBase<InnovationCovariance>& S,
              Bool observed) {
        if (observed) step(error, P, innovation, S);
        else step(error, P);
    }

    bool counting() const { return pack_.counted != nullptr; }
    template <class Covariance>
    void counts(int source, const Eigen::MatrixBase<Covariance>& P_s) {
        if (!counting()) return;
        if (P_s.rows() != pack_.state_size) refuse(pack_, "a P_s of another size than the state");
        pack_.count(pack_, source, numbers(as_reals(P_s.diagonal())), lanes<Real>);
    }

    void set(std::size_t column, const Real& value) {
        if (column >= pack_.own_column_count) refuse(pack_, "a column that it does not have is set");
        store(value, pack_.own_columns + column * static_cast<std::size_t>(lanes<Real>));
    }

private:
    /// A matrix of Reals in memory: the one that is given, or the value of an expression.
    template <int rows, int columns, int most_rows, int most_columns>
    static const auto& as_reals(const Eigen::Matrix<Real, rows, columns, 0, most_rows, most_columns>& matrix) {
        return matrix;
    }
    template <class Expression>
    static auto as_reals(const Expression& matrix) {
        using Value = Eigen::Matrix<Real, Expression::RowsAtCompileTime, Expression::ColsAtCompileTime, 0,
                                    Expression::MaxRowsAtCompileTime, Expression::MaxColsAtCompileTime>;
        return Value(matrix.template cast<Real>());
    }
    template <class Matrix>
    static const double* numbers(const Matrix& matrix) { return reinterpret_cast<const double*>(matrix.data()); }

    template <class Error, class Covariance>
    void take(const Error& error, const Covariance& P, LaneStep step) {
        const int n = pack_.state_size;
        if (error.rows() != n || P.rows() != n || P.cols() != n)
            refuse(pack_, "an error or P of another size than the state");
        if (pack_.steps == pack_.poses - 1) refuse(pack_, "a trial took more steps than it has");
        step.error = numbers(error);
        step.P = numbers(P);
        if (!pack_.step(pack_, step)) leave(pack_);
    }

    LanePack& pack_;
};

/// One trial at a time, where no lanes are.
template <>
class OwnTrialOf<double> {
public:
    explicit OwnTrialOf(OwnTrial& trial) : trial_(trial) {}

    std::size_t arm() const { return trial_.arm(); }
    int poses() const { return trial_.poses(); }
    Eigen::Vector2d normal(int source, int pose, int index = 0) const { return trial_.normal(source, pose, index); }
    double uniform(int source, int pose, int index = 0) const { return trial_.uniform(source, pose, index); }
    void step(const OwnTrial::Vector& error, const OwnTrial::Matrix& P) { trial_.step(error, P); }
    void step(const OwnTrial::Vector& error, const OwnTrial::Matrix& P, const OwnTrial::Vector& innovation,
              const OwnTrial::Matrix& S, bool observed = true) {
        if (observed)
            trial_.step(error, P, innovation, S);
        else
            trial_.step(error, P);
    }
    void set(std::size_t column, double value) { trial_.set(column, value); }
    bool counting() const { return trial_.counting(); }
    void counts(int source, const OwnTrial::Matrix& P_s) { trial_.counts(source, P_s); }

private:
    OwnTrial& trial_;
};

/// What P counts for each of `count` sources: P = sum of P_s, propagated with the filter's own gains, which are 0 in
/// the lanes that measure nothing. For trial.counts, before each step, where trial.counting(). [docs/budget.md]
template <class Real, int n, int count>
struct CountedCovariance {
    Eigen::Matrix<Real, n, n> parts[count];

    CountedCovariance() {
        for (auto& part : parts) part.setZero();
    }
    /// P_s <- F P_s F'. Then add Q_s to the part of its source.
    template <class DerivedF>
    void predict(const Eigen::MatrixBase<DerivedF>& F) {
        for (auto& part : parts) part = Eigen::Matrix<Real, n, n>(F * part * F.transpose());
    }
    /// P_s <- (I - K H) P_s (I - K H)', + K R K' of the source that the measurement's noise is. K [n, m]
    template <class DerivedK, class DerivedH, class DerivedR>
    void update(const Eigen::MatrixBase<DerivedK>& K, const Eigen::MatrixBase<DerivedH>& H,
                const Eigen::MatrixBase<DerivedR>& R, int source) {
        const Eigen::Matrix<Real, n, n> kept = Eigen::Matrix<double, n, n>::Identity() - K * H;
        predict(kept);
        parts[source] += K * R * K.transpose();
    }
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
