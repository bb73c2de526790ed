#include "statistics/budget.hpp"

#include "base/nan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace credence {

namespace {

constexpr double largest_z = 3;  ///< of the check that the contributions meet the error

using Numbers = std::vector<double>;

double root(double square) { return square > 0 ? std::sqrt(square) : 0; }

/// Errors of a component about their mean over the trials at each step. [trials, steps] Those that are not there are 0,
/// and the others so much larger that the mean square is that of what is there.
struct Centred {
    Numbers value, mean;  ///< mean [steps]
};

Centred centred(Numbers values, std::size_t steps, const std::vector<char>& there) {
    const std::size_t trials = values.size() / steps;
    Numbers mean(steps);
    double degrees = 0;
    for (std::size_t k = 0; k < steps; ++k) {
        double count = 0;
        for (std::size_t i = k; i < values.size(); i += steps)
            if (there.empty() || there[i]) mean[k] += values[i], ++count;
        if (count > 0) mean[k] /= count, degrees += count - 1;
        for (std::size_t i = k; i < values.size(); i += steps)
            values[i] = there.empty() || there[i] ? values[i] - mean[k] : 0;
    }
    const double factor = degrees > 0 ? std::sqrt(static_cast<double>((trials - 1) * steps) / degrees) : 0;
    for (double& value : values) value *= factor;
    return {std::move(values), std::move(mean)};
}

/// The estimate of a mean square from squares of centred numbers [trials], and its standard error.
struct Estimate {
    double value = 0, standard_error = 0;
};

Estimate estimate_of(const Numbers& squares) {
    const auto count = static_cast<double>(squares.size());
    const double sum = std::accumulate(squares.begin(), squares.end(), 0.0);
    double deviations = 0;
    for (const double square : squares) deviations += (square - sum / count) * (square - sum / count);
    return {sum / (count - 1), std::sqrt(deviations / (count - 1) / count)};
}

/// Adds square(value index) / steps to each trial's sum.
template <class Square>
void add_squares(Numbers& sums, std::size_t steps, const Square& square) {
    for (std::size_t i = 0; i < sums.size(); ++i) {
        double sum = 0;
        for (std::size_t k = 0; k < steps; ++k) sum += square(i * steps + k);
        sums[i] += sum / static_cast<double>(steps);
    }
}

class PartOfErrors {
public:
    PartOfErrors(const BudgetErrors& errors, const ComponentGroup& members) : errors_(errors), own_(errors.trials) {
        for (int i = 0; i < members.count; ++i) members_.push_back(static_cast<std::size_t>(members.component(i)));
        part_.name = members.name;
        part_.unit = errors.components[members_.front()].unit;
        double square_of_mean = 0, there = 0;
        for (const std::size_t j : members_) {
            there += share_of(j);
            a_.push_back(read(0, j));
            b_.push_back(read(1, j));
            const Centred &a = a_.back(), &b = b_.back();
            add_squares(own_, errors.steps,
                        [&](std::size_t i) { return (a.value[i] * a.value[i] + b.value[i] * b.value[i]) / 2; });
            for (std::size_t k = 0; k < errors.steps; ++k)
                square_of_mean += std::pow((a.mean[k] + b.mean[k]) / 2, 2) / static_cast<double>(errors.steps);
        }
        part_.there = there / static_cast<double>(members_.size());
        variance_ = estimate_of(own_).value;
        if (part_.there > 0)
            square_of_mean_ = std::max(
                0.0, square_of_mean - variance_ / 2 / (part_.there * static_cast<double>(errors.trials)));
    }

    BudgetPart made() {
        Numbers met(errors_.trials);
        double interactions = 0;
        for (std::size_t s = 0; s < errors_.sources.size(); ++s) interactions += contribute(s, met);
        part_.mean = std::sqrt(square_of_mean_);
        part_.interactions = root(interactions);
        part_.rss = root(estimate_of(met).value + square_of_mean_);
        part_.rmse = std::sqrt(variance_ + square_of_mean_);
        for (std::size_t i = 0; i < met.size(); ++i) met[i] -= own_[i];
        const Estimate difference = estimate_of(met);
        part_.closes = std::abs(difference.value) <= std::max(largest_z * difference.standard_error, 1e-9 * variance_);
        compare_with_P();
        std::ranges::stable_sort(part_.contributions, std::greater(), &Contribution::with_others);
        return std::move(part_);
    }

private:
    Centred read(std::size_t run, std::size_t component) const {
        return centred(errors_.of(run, component), errors_.steps, there(component));
    }

    const std::vector<char>& there(std::size_t component) const {
        static const std::vector<char> all;
        return errors_.there.empty() ? all : errors_.there[component];
    }
    double share_of(std::size_t component) const {
        const std::vector<char>& own = there(component);
        return own.empty() ? 1 : static_cast<double>(std::ranges::count(own, 1)) / static_cast<double>(own.size());
    }

    /// Adds the contribution of a source, and (V + T)/2 of each trial to `met`. Returns (T - V)/2.
    double contribute(std::size_t s, Numbers& met) {
        Numbers alone(errors_.trials), total(errors_.trials);
        for (std::size_t m = 0; m < members_.size(); ++m) {
            const Centred c = read(2 + 2 * s, members_[m]), d = read(3 + 2 * s, members_[m]);
            const auto x = [&](std::size_t i) { return a_[m].value[i] - c.value[i]; };
            const auto y = [&](std::size_t i) { return d.value[i] - b_[m].value[i]; };
            add_squares(alone, errors_.steps, [&](std::size_t i) { return x(i) * y(i) / 2; });
            add_squares(total, errors_.steps, [&](std::size_t i) { return (x(i) * x(i) + y(i) * y(i)) / 4; });
        }
        for (std::size_t i = 0; i < met.size(); ++i) met[i] += (alone[i] + total[i]) / 2;
        const Estimate V = estimate_of(alone);
        const double T = estimate_of(total).value,
                     half = t_quantile(0.05, static_cast<double>(errors_.trials - 1)) * V.standard_error;
        part_.contributions.push_back({errors_.sources[s], V.value >= 0 ? std::sqrt(V.value) : nan,
                                       {root(V.value - half), root(V.value + half)},
                                       variance_ > 0 ? V.value / variance_ : nan, std::sqrt(T), nan, nan});
        return (T - V.value) / 2;
    }

    /// The variance of these components among those of all.
    double sum_of(const Numbers& variance) const {
        return std::accumulate(members_.begin(), members_.end(), 0.0,
                               [&](double sum, std::size_t j) { return sum + variance[j]; });
    }

    /// What P says, and counts for each source: the split of some trials, of what P says in all.
    void compare_with_P() {
        part_.p_says = part_.ratio = nan;
        if (errors_.variance.empty()) return;
        const double says = sum_of(errors_.variance);
        part_.p_says = std::sqrt(says);
        if (says > 0) part_.ratio = part_.rmse * part_.rmse / says;
        double whole = 0;
        for (const Numbers& variance : errors_.counted_variance) whole += sum_of(variance);
        if (!(whole > 0)) return;
        for (Contribution& one : part_.contributions) one.p_counts = 0;
        for (std::size_t s = 0; s < errors_.counted.size(); ++s) {
            const double counts = sum_of(errors_.counted_variance[s]) / whole * says;
            auto one = std::ranges::find(part_.contributions, errors_.counted[s], &Contribution::source);
            if (one == part_.contributions.end()) {
                if (!(counts > 0)) continue;
                part_.contributions.push_back({errors_.counted[s], 0, {}, 0, 0, 0, nan});  // counted, and not drawn
                one = part_.contributions.end() - 1;
            }
            one->p_counts = root(counts);
            if (counts > 0) one->ratio = (std::isnan(one->alone) ? 0 : one->alone * one->alone) / counts;
        }
    }

    const BudgetErrors& errors_;
    std::vector<std::size_t> members_;
    std::vector<Centred> a_, b_;
    Numbers own_;  ///< [trials] squares of A and B, mean
    double variance_ = 0, square_of_mean_ = 0;
    BudgetPart part_;
};

}  // namespace

std::vector<ComponentGroup> groups_of_one_unit(const std::vector<Component>& components,
                                               std::vector<ComponentGroup> groups) {
    for (std::size_t j = 0; j < components.size(); ++j) groups.push_back({components[j].name, static_cast<int>(j), 1});
    std::erase_if(groups, [&](const ComponentGroup& group) {
        const auto unit = [&](int i) { return components[static_cast<std::size_t>(group.component(i))].unit; };
        bool is_of_one = true;
        for (int i = 1; i < group.count; ++i) is_of_one = is_of_one && unit(i) == unit(0);
        return !is_of_one;
    });
    return groups;
}

std::vector<BudgetPart> budget_parts(const BudgetErrors& errors) {
    std::vector<BudgetPart> parts;
    for (const ComponentGroup& group : groups_of_one_unit(errors.components, errors.groups))
        parts.push_back(PartOfErrors(errors, group).made());
    return parts;
}

}  // namespace credence
