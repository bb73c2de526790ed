#pragma once
// Worlds that run in lanes and do what users' worlds may do, and what they must not: for lanes_long_test.cpp, which compares
// them with the same worlds one trial at a time.

#include <credence/own_world.hpp>

#include <vector>

/// A variable that the program initialises when it starts; in an object of a target, when that is chosen.
inline const std::vector<double> scales{1.0, 0.5, 2.0, 0.25, 1.5, 0.75};

/// States and innovations with random covariances, and in some trials, at some steps, trouble of each kind.
struct Troubled {
    static constexpr int largest = 6;

    struct Settings {
        int state = 3, rows = 2;
        double spread = 1;   ///< columns of the covariance's root shrink by up to e^-spread
        double trouble = 0;  ///< probability of a step
        int groups = 0;
        int mistake = 0;     ///< of the world itself; 0 for none
    };
    static constexpr const char* name = "troubled";
    static void keys(credence::OwnKeys<Settings>& keys) {
        keys.integer("state.size", &Settings::state, 1, largest, "n");
        keys.integer("state.rows", &Settings::rows, 0, largest, "m");
        keys.real("state.spread", &Settings::spread, 0, 100, "of the covariances");
        keys.real("state.trouble", &Settings::trouble, 0, 1, "probability");
        keys.integer("state.groups", &Settings::groups, 0, 4, "which groups");
        keys.integer("state.mistake", &Settings::mistake, 0, 9, "which mistake");
    }
    static std::vector<credence::Component> components(const Settings& s) {
        std::vector<credence::Component> all;
        for (int i = 0; i < s.state; ++i) all.push_back({"x" + std::to_string(i), "m"});
        return all;
    }
    static std::vector<credence::ComponentGroup> groups(const Settings& s) {
        if (s.groups == 0 || s.state == 1) return {};
        if (s.groups == 1) return {{"first", 0, 1}, {"rest", 1, s.state - 1}};
        if (s.groups == 2) return {{"last", s.state - 1, 1}};
        if (s.groups == 4) return {{"turned", 0, 2, {s.state - 1, 0}}, {"odd", 0, 1, {s.state / 2}}};
        return {{"whole", 0, s.state}, {"most", 0, s.state - 1}, {"others", 1, s.state - 1}};
    }
    static std::vector<std::string> arms(const Settings&) { return {"a", "b"}; }
    static int innovation_rows(const Settings& s) { return s.rows; }
    static std::vector<credence::Column> columns(const Settings&) {
        return {{"observations", "steps with any", "1", credence::ColumnType::integer, -1},
                {"sum", "of the errors", "m", credence::ColumnType::real, -2}};
    }

    template <class Real>
    using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1, 0, largest, 1>;
    template <class Real>
    using Square = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, 0, largest, largest>;

    template <class Real>
    static void run(const Settings& s, credence::OwnTrialOf<Real>& trial) {
        enum Source { state, innovation, kind, errors };
        using credence::select;
        constexpr double infinity = std::numeric_limits<double>::infinity();
        constexpr double nan = std::numeric_limits<double>::quiet_NaN();
        Real observations = 0, sum = 0;
        const int n = s.state, m = s.rows, end = s.mistake == 1 ? trial.poses() - 1 : trial.poses() + (s.mistake == 2);
        if (s.mistake == 3) trial.set(2, observations);
        if (s.mistake == 4) trial.normal(16, 0);
        if (s.mistake == 5) trial.uniform(0, -1);
        for (int k = 1; k < end; ++k) {
            Square<Real> P = covariance(s, trial, state, k, n), S = covariance(s, trial, innovation, k, m);
            Vector<Real> e = drawn(trial, errors, k, n), nu = drawn(trial, errors, k, m, 10);
            if (trial.arm() == 1) e = e * 1.25;
            const Real at = trial.uniform(kind, k);
            const auto is = [&](int which) {
                return credence::both(at >= s.trouble * which / 12, at < s.trouble * (which + 1) / 12);
            };
            e(0) = select(is(0), Real(nan), select(is(1), Real(1e13), select(is(2), Real(1e80), e(0))));
            P(n - 1, 0) = P(0, n - 1) = select(is(3), Real(infinity), P(n - 1, 0));
            P(n - 1, n - 1) = select(is(4), -P(n - 1, n - 1), P(n - 1, n - 1));
            for (int i = 0; i < n && n > 1; ++i)  // the last row becomes the first
                P(n - 1, i) = select(is(5), P(i == n - 1 ? 0 : i, 0), P(n - 1, i));
            if (m > 0) {
                nu(0) = select(is(6), Real(nan), select(is(7), Real(infinity), nu(0)));
                for (int i = 0; i < m; i += 2) nu(i) = select(is(8), Real(nan), nu(i));
                S(m - 1, m - 1) = select(is(9), -S(m - 1, m - 1), S(m - 1, m - 1));
                S(m - 1, 0) = S(0, m - 1) = select(is(10), Real(nan), S(m - 1, 0));
            }
            if (s.mistake == 6) P = Square<Real>::Identity(n + 1, n + 1);
            if (s.mistake == 7) S = Square<Real>::Identity(m + 1, m + 1);
            if (s.mistake == 8) nu = Vector<Real>::Zero(m + 1);
            const auto seen = credence::negated(is(11));
            if (m > 0 || s.mistake > 0)
                trial.step(e, P, nu, S, seen);
            else
                trial.step(e, P);
            observations += select(seen, Real(1), Real(0));
            sum += e(0);
        }
        trial.set(0, observations);
        trial.set(1, sum);
    }

private:
    /// Pairs of draws, one after the other.
    template <class Real>
    static Vector<Real> drawn(const credence::OwnTrialOf<Real>& trial, int source, int k, int size, int first = 0) {
        Vector<Real> all(size);
        for (int i = 0; i < size; ++i) all(i) = trial.normal(source, k, first + i / 2)(i % 2);
        return all;
    }
    /// L L' with an L whose columns shrink, so that the last pivots of hard ones are lost in rounding.
    template <class Real>
    static Square<Real> covariance(const Settings& s, const credence::OwnTrialOf<Real>& trial, int source, int k,
                                   int size) {
        Square<Real> L(size, size), P(size, size);
        for (int j = 0; j < size; ++j) {
            const Real scale = scales[static_cast<std::size_t>(j)] *
                               credence::exp(-s.spread * trial.uniform(source, k, 100 + j));
            for (int i = 0; i < size; ++i)
                L(i, j) = i < j ? Real(0) : i == j ? scale : scale * trial.normal(source, k, i * size + j)(0);
        }
        for (int i = 0; i < size; ++i)
            for (int j = 0; j < size; ++j) {
                P(i, j) = Real(0);
                for (int c = 0; c <= (i < j ? i : j); ++c) P(i, j) += L(i, c) * L(j, c);
            }
        return P;
    }
};

/// A filter of nine states or more, whose products Eigen computes by its kernels for larger matrices, and which are too
/// large for its stack from 46 on, of doubles from 129 on.
template <int n>
struct WideOf {
    struct Settings {
        double period = 0.1;
    };
    static constexpr const char* name = n == 9 ? "wide" : n == 48 ? "wide48" : "wide132";
    static void keys(credence::OwnKeys<Settings>& keys) {
        keys.real("wide.period", &Settings::period, 0, 1, "of a step");
    }
    static std::vector<credence::Component> components(const Settings&) {
        std::vector<credence::Component> all;
        for (int i = 0; i < n; ++i) all.push_back({"x" + std::to_string(i), "m"});
        return all;
    }
    static std::vector<credence::ComponentGroup> groups(const Settings&) {
        return {{"position", 0, 3}, {"velocity", 3, 3}};
    }
    static std::vector<std::string> arms(const Settings&) { return {"kf"}; }
    static int innovation_rows(const Settings&) { return 3; }
    static std::vector<credence::Column> columns(const Settings&) { return {}; }

    template <class Real>
    static void run(const Settings& s, credence::OwnTrialOf<Real>& trial) {
        using State = Eigen::Matrix<Real, n, 1>;
        using Square = Eigen::Matrix<Real, n, n>;
        Square F = Square::Identity();
        F.template block<3, 3>(0, 3).diagonal().setConstant(s.period);
        F.template block<3, 3>(3, 6).diagonal().setConstant(s.period);
        Eigen::Matrix<double, 3, n> H = Eigen::Matrix<double, 3, n>::Zero();
        H.template leftCols<3>().setIdentity();
        State x, estimate = State::Zero();
        for (int i = 0; i < n; ++i) x(i) = trial.normal(0, 0, i)(0);
        Square P = Square::Identity();
        for (int k = 1; k < trial.poses(); ++k) {
            x = F * x;
            estimate = F * estimate;
            P = F * P * F.transpose();
            for (int i = 6; i < n; ++i) {
                x(i) += 0.1 * trial.normal(1, k, i)(0);
                P(i, i) += 0.01;
            }
            Eigen::Matrix<Real, 3, 1> nu = H * (x - estimate);
            for (int i = 0; i < 3; ++i) nu(i) += trial.normal(2, k, i)(0);
            const Eigen::Matrix<Real, 3, 3> S = H * P * H.transpose() + Eigen::Matrix3d::Identity();
            const Eigen::Matrix<Real, n, 3> K = P * H.transpose() * credence::inverse(S);
            estimate += K * nu;
            const Square I_KH = Square::Identity() - K * H;
            P = I_KH * P * I_KH.transpose() + K * K.transpose();
            trial.step(estimate - x, P, nu, S);
        }
    }
};

CREDENCE_WORLD(Troubled);
CREDENCE_WORLD(WideOf<9>);
CREDENCE_WORLD(WideOf<48>);
CREDENCE_WORLD(WideOf<132>);
