#include "study_support.hpp"

#include <bit>

namespace credence {

namespace {

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i]) && !(a[i] != a[i] && b[i] != b[i]))
            return false;
    return true;
}

bool same_sums(const std::vector<ExactSum>& a, const std::vector<ExactSum>& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t k = 0; k < a.size(); ++k)
        if (!same_bits(a[k].parts(), b[k].parts())) return false;
    return true;
}

bool same_moments(const ExactMoments& a, const ExactMoments& b) {
    return a.count == b.count && same_sums({a.sum, a.square_sum}, {b.sum, b.square_sum});
}

bool same_trials(const TrialTotals& a, const TrialTotals& b) {
    if (a.statuses != b.statuses || a.columns.size() != b.columns.size()) return false;
    if (!std::equal(a.columns.begin(), a.columns.end(), b.columns.begin(), same_moments)) return false;
    for (std::size_t arm = 0; arm < a.differences.size(); ++arm)
        for (std::size_t c = 0; c < a.columns.size(); ++c) {
            const DifferenceTotals &one = a.differences[arm][c], &other = b.differences[arm][c];
            if (!same_moments(one.difference, other.difference) || one.below != other.below || one.above != other.above)
                return false;
        }
    return true;
}

bool same_columns(const ScenarioResults& a, const ScenarioResults& b, std::size_t arm) {
    if (a.keep == Keep::aggregates) return true;
    for (std::size_t c = 0; c < a.columns.size(); ++c)
        if (!same_bits(column_values(a, a.arms[arm], c), column_values(b, b.arms[arm], c))) return false;
    return true;
}

bool same_series(const std::vector<SeriesTotals>& a, const std::vector<SeriesTotals>& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t f = 0; f < a.size(); ++f)
        if (!same_sums(a[f].sum, b[f].sum) || !same_sums(a[f].square_sum, b[f].square_sum) ||
            !same_bits(a[f].run_square_sum.parts(), b[f].run_square_sum.parts()) || a[f].covered != b[f].covered)
            return false;
    return true;
}

bool same_totals(const Totals& a, const Totals& b) {
    return same_trials(a.trials, b.trials) && same_series(a.series, b.series) &&
           same_series(a.diverged, b.diverged) && a.cells == b.cells &&
           same_sums(a.products.sum, b.products.sum) && same_sums(a.products.square_sum, b.products.square_sum) &&
           a.products.count == b.products.count;
}

bool same_arm(const ArmResults& a, const ArmResults& b) {
    return a.name == b.name && same_totals(a.totals, b.totals) && same_bits(a.errors, b.errors) &&
           same_bits(a.nees, b.nees);
}

}  // namespace

std::vector<DeformableSettings> small_scenarios() {
    DeformableSettings straight;
    straight.name = "heading-straight";
    straight.poses = 8;
    DeformableSettings circle;
    circle.name = "translation-circle";
    circle.poses = 8;
    circle.process = Process::translation;
    circle.features.path = Path::circle;
    circle.sensor.noise = RangeNoise::ranged;
    circle.planner.speeds = 2;
    return {resolved(straight), resolved(circle)};
}

Study small_study(std::uint64_t root_seed, std::int64_t trials, int threads) {
    Study study = new_study(small_scenarios(), root_seed);
    run_study(study, {trials, threads, {}});
    return study;
}

bool same_results(const Study& a, const Study& b) {
    if (a.scenarios.size() != b.scenarios.size()) return false;
    for (std::size_t s = 0; s < a.scenarios.size(); ++s) {
        if (a.scenarios[s].keep != b.scenarios[s].keep || a.scenarios[s].trials != b.scenarios[s].trials ||
            a.scenarios[s].blocks != b.scenarios[s].blocks) return false;
        const WithTotals in_a(a.scenarios[s]), in_b(b.scenarios[s]);
        for (std::size_t i = 0; i < a.scenarios[s].arms.size(); ++i)
            if (!same_arm((*in_a).arms[i], (*in_b).arms[i]) ||
                !same_columns(a.scenarios[s], b.scenarios[s], i))
                return false;
    }
    return true;
}

}  // namespace credence
