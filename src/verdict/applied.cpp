#include "verdict/applied.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>

#include "base/nan.hpp"
#include "numeric/decompositions.hpp"
#include "verdict/judgement.hpp"

namespace credence {

namespace {

constexpr Eigen::Index most_together = 16;  ///< components of which correlations are tested
constexpr int most_exchanged = 32;          ///< components of which every pair is tried

/// Turns back what was written of a step; false where that is not known.
using Change = std::function<bool(const SampledStep& step, Eigen::VectorXd& e, Eigen::MatrixXd& P)>;

/// Changes of one kind are like each other, and the simplest of them changes fewest components.
struct Candidate {
    enum class Kind { degrees, exchange, factor, power, shift };
    Kind kind;
    int changed;
    bool joint;  ///< whether correlations are turned back, too
    std::string said;
    Change change;
};

/// Ratios over the units, each 1 where P is right: z^2 of every component, its mean in stretches of steps that double
/// in length, and NEES/n; and the products of whitened errors.
struct Fit {
    bool is_right = false;
    double distance = nan;        ///< the mean distance of the logarithm of z^2 from 0
    double bound = 0;             ///< how well z^2 is known, of the component of which it is known worst
    std::vector<double> squares;  ///< [n] of z^2
};

class Ratios {
public:
    Ratios(Eigen::Index n, bool joint)
        : n_(n), joint_(joint), size_(n + stretches + (joint ? 1 + n * (n + 1) / 2 : 0)) {}

    /// False where P is no covariance.
    bool add(const SampledStep& step, Eigen::VectorXd e, const Eigen::MatrixXd& P) {
        if (!(P.diagonal().minCoeff() > 0)) return false;
        auto& [sum, count] = units_[step.unit];
        if (sum.size() == 0) sum = count = Eigen::VectorXd::Zero(size_);
        Eigen::Index at = 0;
        const auto put = [&, &to = sum, &of = count](Eigen::Index place, double value) {
            to(place) += value;
            ++of(place);
        };
        const Eigen::VectorXd squares = e.cwiseAbs2().cwiseQuotient(P.diagonal());
        for (; at < n_; ++at) put(at, squares(at));
        put(n_ + std::min<Eigen::Index>(stretches - 1, std::bit_width(static_cast<unsigned>(step.step))),
            squares.mean());
        if (!joint_) return true;
        const CholeskyFactor factor(P);
        if (!factor.succeeded()) return false;
        factor.whiten(e);
        at = n_ + stretches;
        put(at++, e.squaredNorm() / static_cast<double>(n_));
        for (Eigen::Index i = 0; i < n_; ++i)
            for (Eigen::Index j = 0; j <= i; ++j) put(at++, e(i) * e(j));
        return true;
    }

    /// Whether each is what it should be within Student's bounds, at 0.1 % for all of them together.
    Fit fit(double tolerance) const {
        constexpr double level = 0.001;
        Fit found{true, 0, 0, {}};
        Eigen::Index row = 0, column = 0;
        for (Eigen::Index i = 0; i < size_; ++i) {
            double count = 0, sum = 0, square_sum = 0;
            for (const auto& [unit, sums] : units_)
                if (sums.second(i) > 0) {
                    const double value = sums.first(i) / sums.second(i);
                    ++count, sum += value, square_sum += value * value;
                }
            const bool is_product = i > n_ + stretches;
            const double expected = is_product && row != column ? 0 : 1;
            if (is_product && ++column > row) ++row, column = 0;
            const Moments ratio = moments_from_sums(static_cast<std::int64_t>(count), sum, square_sum);
            if (i < n_) found.squares.push_back(ratio.mean);
            if (count < (tolerance > 0 ? 1 : 2)) continue;
            const double bound = count < 2 ? 0 : t_quantile(level / static_cast<double>(size_), count - 1),
                         allowed = std::max(tolerance, count < 2 ? 0 : bound * ratio.standard_error);
            if (!(std::abs(ratio.mean - expected) <= allowed)) found.is_right = false;
            if (i >= n_) continue;
            found.bound = std::max(found.bound, allowed);
            found.distance += std::abs(std::log(ratio.mean)) / static_cast<double>(n_);
        }
        return found;
    }

private:
    static constexpr Eigen::Index stretches = 20;
    Eigen::Index n_;
    bool joint_;
    Eigen::Index size_;
    std::map<std::int64_t, std::pair<Eigen::VectorXd, Eigen::VectorXd>> units_;  ///< sums and counts
};

Fit fit_of(const SampledSteps& sample, bool joint, const Change& change) {
    Ratios ratios(sample.steps.front().e.size(), joint);
    for (const SampledStep& step : sample.steps) {
        Eigen::VectorXd e = step.e;
        Eigen::MatrixXd P = step.P;
        if (change(step, e, P) && !ratios.add(step, e, P)) return {};
    }
    return ratios.fit(sample.tolerance);
}

/// Errors of some components in degrees beside P in rad^2, or the other way round.
void add_degrees(const std::vector<double>& squares, const std::vector<Component>& components,
                 std::vector<Candidate>& all) {
    for (const double degrees : {180 / std::numbers::pi, std::numbers::pi / 180}) {
        std::vector<std::string> names;
        Eigen::VectorXd factor = Eigen::VectorXd::Ones(std::ssize(components));
        for (std::size_t j = 0; j < components.size(); ++j) {
            const auto& [name, unit] = components[j];
            if (!(unit.empty() || unit == "rad" || unit == "deg")) continue;
            if (!(std::abs(std::log(squares[j] / (degrees * degrees))) < 1)) continue;
            names.push_back(name);
            factor(static_cast<Eigen::Index>(j)) = 1 / degrees;
        }
        if (names.empty()) continue;
        all.push_back({Candidate::Kind::degrees, static_cast<int>(names.size()), true,
                       "errors of " + first_of(names) +
                           (degrees > 1 ? " are 57 times P's sigma: is the error in degrees, and P in rad²?"
                                        : " are 1/57 of P's sigma: is P in squared degrees, the error in rad?"),
                       [=](const SampledStep&, Eigen::VectorXd& e, Eigen::MatrixXd&) {
                           e = e.cwiseProduct(factor);
                           return true;
                       }});
    }
}

/// P is a power of what it should be, or a factor, of which the spectrum of directions tells more.
void add_powers(const std::vector<double>& squares, std::vector<Candidate>& all) {
    const double factor = std::accumulate(squares.begin(), squares.end(), 0.0) / static_cast<double>(squares.size());
    all.push_back({Candidate::Kind::factor, std::numeric_limits<int>::max(), false, "",
                   [=](const SampledStep&, Eigen::VectorXd&, Eigen::MatrixXd& P) {
                       P *= factor;
                       return true;
                   }});
    const auto add = [&](const std::string& power, bool joint, const std::string& what, const Change& change) {
        all.push_back({Candidate::Kind::power, 1, joint,
                       "the mean-square errors are P's variances to the power " + power + ": does P hold " + what + "?",
                       change});
    };
    const auto raised = [](double power) {
        return [power](const SampledStep&, Eigen::VectorXd&, Eigen::MatrixXd& P) {
            P.diagonal() = P.diagonal().array().pow(power).matrix().eval();
            return true;
        };
    };
    add("2", false, "standard deviations, where variances belong", raised(2));
    add("1/2", false, "squared variances", raised(0.5));
    add("-1", true, "the inverse of the covariance, an information matrix",
        [](const SampledStep&, Eigen::VectorXd&, Eigen::MatrixXd& P) {
            const CholeskyFactor factor(P);
            if (!factor.succeeded()) return false;
            P = factor.solve_upper(factor.solve_lower(Eigen::MatrixXd::Identity(P.rows(), P.cols())));
            return true;
        });
}

/// P of the step before or after.
void add_shifts(std::vector<Candidate>& all) {
    const auto add = [&](Eigen::MatrixXd SampledStep::*beside, const std::string& said) {
        all.push_back({Candidate::Kind::shift, 1, true, said,
                       [=](const SampledStep& step, Eigen::VectorXd&, Eigen::MatrixXd& P) {
                           P = step.*beside;
                           return P.size() > 0;
                       }});
    };
    add(&SampledStep::before, "the errors are as large as P of the step before says: is P a step early?");
    add(&SampledStep::after, "the errors are as large as P of the step after says: is P a step late?");
}

/// In which order components may lie: two of them exchanged, the last ones first, the components of both halves in
/// turn, or reversed.
std::set<std::vector<int>> orders_of(int n) {
    std::vector<int> own(static_cast<std::size_t>(n));
    std::iota(own.begin(), own.end(), 0);
    std::set<std::vector<int>> orders{{own.rbegin(), own.rend()}};
    if (n > most_exchanged) return orders;
    for (std::size_t i = 0; i < own.size(); ++i) {
        std::vector<int> order = own;
        std::rotate(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(i), order.end());
        orders.insert(order);
        for (std::size_t j = 0; j < i; ++j) {
            order = own;
            std::swap(order[i], order[j]);
            orders.insert(order);
        }
    }
    if (n % 2 == 1) return orders;
    std::vector<int> in_turn, apart(own);
    for (int i = 0; i < n; ++i) in_turn.push_back(i / 2 + i % 2 * (n / 2));
    for (int i = 0; i < n; ++i) apart[static_cast<std::size_t>(in_turn[static_cast<std::size_t>(i)])] = i;
    orders.insert({in_turn, apart});
    return orders;
}

/// Of those orders in which the errors of every component that moves are about as large as P says.
void add_exchanges(const SampledSteps& sample, const std::vector<Component>& components, std::vector<Candidate>& all) {
    const auto n = static_cast<int>(components.size());
    Eigen::MatrixXd ratio = Eigen::MatrixXd::Zero(n, n);
    for (const SampledStep& step : sample.steps)
        ratio += step.e.cwiseAbs2() * step.P.diagonal().cwiseInverse().transpose();
    ratio /= static_cast<double>(sample.steps.size());
    const auto name = [&](int j) { return components[static_cast<std::size_t>(j)].name; };
    std::set<std::vector<int>> orders = orders_of(n);
    std::vector<int> nearest;
    for (int i = 0; i < n; ++i) {
        int& best = nearest.emplace_back(0);
        for (int j = 1; j < n; ++j)
            if (std::abs(std::log(ratio(i, j))) < std::abs(std::log(ratio(i, best)))) best = j;
    }
    if (std::set(nearest.begin(), nearest.end()).size() == nearest.size()) orders.insert(nearest);
    for (const std::vector<int>& order : orders) {
        std::vector<std::string> moved, to;
        bool is_near = true, goes_back = true;
        int changed = 0;
        for (int i = 0; i < n; ++i) {
            const int j = order[static_cast<std::size_t>(i)];
            is_near = is_near && (i == j || std::abs(std::log(ratio(i, j))) < 1);
            goes_back = goes_back && order[static_cast<std::size_t>(j)] == i;
            changed += i != j;
        }
        for (int i = 0; i < n; ++i)
            if (const int j = order[static_cast<std::size_t>(i)]; goes_back ? i < j : i != j)
                moved.push_back(name(i)), to.push_back(name(j));
        if (!is_near || changed == 0) continue;
        all.push_back({Candidate::Kind::exchange, changed, true,
                       "errors of " + first_of(moved) + " are as large as P says of " + first_of(to) +
                           (goes_back ? ", and the other way round: are they exchanged?" : ": is P in another order?"),
                       [order](const SampledStep& step, Eigen::VectorXd&, Eigen::MatrixXd& P) {
                           P = step.P(order, order);
                           return true;
                       }});
    }
}

}  // namespace

std::string applied_cause(const SampledSteps& sample, const std::vector<Component>& components) {
    if (sample.steps.empty() || components.empty()) return {};
    const auto is_correlated = [](const SampledStep& step) {
        return (step.P - Eigen::MatrixXd(step.P.diagonal().asDiagonal())).cwiseAbs().maxCoeff() > 0;
    };
    const bool joint = std::ssize(components) <= most_together && std::ranges::any_of(sample.steps, is_correlated);
    const Fit given = fit_of(sample, joint, [](const auto&...) { return true; });
    if (given.is_right || given.squares.empty()) return {};
    double worst = 0;
    for (const double square : given.squares) worst = std::max(worst, std::abs(std::log(square)));
    std::vector<Candidate> all;
    add_degrees(given.squares, components, all);
    add_powers(given.squares, all);
    add_shifts(all);
    add_exchanges(sample, components, all);
    const auto explains_nothing = [&](const Candidate& one) {
        const Fit fit = fit_of(sample, joint && one.joint, one.change);
        return !fit.is_right || !(fit.distance < given.distance / 2) || !(std::log1p(fit.bound) < worst);
    };
    std::erase_if(all, explains_nothing);
    // A start that is wrong looks like P of the step beside it, whose steps are alike later on.
    SampledSteps later = sample;
    const int last = std::ranges::max(sample.steps, {}, &SampledStep::step).step;
    std::erase_if(later.steps, [&](const SampledStep& step) { return step.step < last / 5; });
    if (fit_of(later, joint, [](const auto&...) { return true; }).is_right)
        std::erase_if(all, [](const Candidate& one) { return one.kind == Candidate::Kind::shift; });
    std::ranges::sort(all, {}, &Candidate::changed);
    const auto is_unlike = [&](const Candidate& one) {
        if (one.kind == Candidate::Kind::factor) return all.front().kind == Candidate::Kind::power;
        return one.kind != all.front().kind;
    };
    if (all.empty() || std::ranges::any_of(all, is_unlike)) return {};
    return all.size() > 1 && all[1].changed == all[0].changed ? "" : all.front().said;
}

}  // namespace credence
