#pragma once
// The running sums of a batch of trials that run one after the other.

#include "oracle/evaluated_trial.hpp"
#include <credence/detail/batch.hpp>

namespace credence {

/// Adds a trial to a batch's running sums, at its place among eight.
class BatchSums {
public:
    BatchSums(const Case& of, const Batch& batch) : case_(of), batch_(batch) {}

    void add(int trial, const EvaluatedTrial& evaluated, const std::vector<double>& row) {
        const std::size_t i = index_of(trial), place = i % octet, steps = case_.steps();
        for (std::size_t c = 0; c < row.size(); ++c)
            batch_.columns[(i / octet * row.size() + c) * octet + place] = row[c];
        const std::size_t padded = index_of((batch_.trials + octet - 1) / octet * octet);
        for (std::size_t k = 0; k < steps; ++k) batch_.nees[k * padded + i] = evaluated.all_series()[k];
        if (batch_.errors != nullptr)
            for (std::size_t c = 0, n = case_.scenario.components.size(); c < n; ++c)
                for (std::size_t k = 0; k < steps; ++k)
                    batch_.errors[(c * steps + k) * padded + i] = evaluated.errors()[k * n + c];
        if (batch_.moments != nullptr) {
            const std::vector<double> moments = evaluated.moments();
            for (std::size_t c = 0; c < moments.size(); ++c) batch_.moments[c * padded + i] = moments[c];
        }
        if (evaluated.has_failed()) return;
        RunningSums to = batch_;
        if (!evaluated.is_counted()) to = batch_.of_diverged(batch_.owner);
        for (std::size_t f = 0; f < case_.all_series.list.size(); ++f) add_figure(f, place, evaluated, to);
        for (std::size_t b = 0; b < case_.scenario.groups.size(); ++b) add_coverage(b, evaluated, to);
        if (!evaluated.is_counted()) return;
        if (batch_.errors != nullptr) add_products(place, evaluated.products());
    }

private:
    void add_figure(std::size_t f, std::size_t place, const EvaluatedTrial& evaluated, const RunningSums& to) {
        const std::size_t steps = case_.steps();
        double run = 0;
        for (std::size_t cell = f * steps; cell < (f + 1) * steps; ++cell) {
            const double value = evaluated.all_series()[cell];
            to.sums[cell * octet + place] += value;
            to.square_sums[cell * octet + place] += value * value;
            run += value;
        }
        to.run_square_sums[f * octet + place] += run * run;
    }

    void add_coverage(std::size_t b, const EvaluatedTrial& evaluated, const RunningSums& to) {
        for (std::size_t cell = b * case_.steps(); cell < (b + 1) * case_.steps(); ++cell)
            for (std::size_t level = 0; level < coverage_level_count; ++level)
                to.covered[cell * coverage_level_count + level] +=
                    evaluated.all_series()[cell] < case_.coverage_bounds[b * coverage_level_count + level];
    }

    void add_products(std::size_t place, const LagProducts& products) {
        for (std::size_t lag = 0; lag < products.sum.size(); ++lag) {
            batch_.product_sums[lag * octet + place] += products.sum[lag];
            batch_.product_square_sums[lag * octet + place] += products.sum[lag] * products.sum[lag];
            batch_.product_counts[lag * octet + place] += products.count[lag];
        }
    }

    const Case& case_;
    const Batch& batch_;
};

}  // namespace credence
