// What the planner's fast forms compute on the way to their choice: costs, and bounds below them.

#include "catch.hpp"
#include "filter_samples.hpp"

#include "slam/planning/planner.hpp"

#include <memory>

namespace credence::test::planner_cost_long_test {

namespace {

/// A planner before its step, on one sample.
template <class Layout>
struct Planner {
    const ProblemView& view;
    Layout layout;
    Belief<double, Layout::capacity> base, next;
    std::unique_ptr<PlannerWorkspace<Layout, double>> work = std::make_unique<PlannerWorkspace<Layout, double>>();
    std::unique_ptr<MeasurementElimination<Layout, double>> room =
        std::make_unique<MeasurementElimination<Layout, double>>();
    Rotation<double> heading{1, 0};

    Planner(const Problem& problem, const Sample& sample, Layout at) : view(problem.view()), layout(at) {
        const auto belief = belief_of<Layout>(sample.x, sample.P);
        prepare_candidates(belief, view.filter, layout, 2, base);
        prepare_still(belief, view.filter, layout, 2, work->still);
        enter_measurement_space(work->still, view.filter, layout, view.control.weights, work->space);
        if constexpr (Layout::has_heading) heading = rotation(sample.x[0]);
    }

    Vector2<double> move(int i) const {
        const Point& v = view.control.candidates[i].move;
        return world_move<Layout>(heading, Vector2<double>{v.x, v.y});
    }
    double plain(int i) {
        return candidate_cost(base, command_from<double>(view.control.candidates[i]), view.control, view.filter,
                              view.sensor, layout, next);
    }
    /// The criterion has weights of its own.
    Weights eigenvalue_weights() const {
        return weights_of(Criterion::max_eigenvalue, view.control.weights.heading);
    }
    /// The largest eigenvalue of a candidate's P+, plainly.
    double plain_eigenvalue(int i) {
        plain(i);
        return largest_eigenvalue(next.covariance, layout, eigenvalue_weights());
    }
    /// The tangent of the bound on it along the eigenvector of the reference.
    EigenvalueTangent<Layout, double> eigenvalue_tangent(int reference) {
        const Weights weights = eigenvalue_weights();
        EigenvalueTangent<Layout, double> tangent;
        double x[Layout::capacity];
        plain(reference);
        largest_eigenvalue_below(above_eigenvalues(next.covariance, layout, weights), true, next.covariance, weights,
                                 layout, work->screening.covariance, x);
        touch_along(x, move(reference), base, heading, view.filter, view.sensor, layout, weights,
                    least_feature_variance(view.filter), work->screening.covariance, tangent);
        return tangent;
    }
    double cost(int i) {
        return cost_in_measurement_space(work->space, move(i), view.filter, view.sensor, layout, *room);
    }
};

const std::vector<Settings> worlds{
    {},
    {{"planner.heading_weight", "7"}},
    {{"planner.criterion", "pose_trace"}, {"planner.heading_weight", "0.3"}, {"noise.heading", "0.1"}},
    {{"planner.criterion", "features_trace"}, {"sensor.noise", "ranged"}},
    {{"sensor.noise", "ranged"}, {"filter.measurement", "0.5"}},
    {{"edges.graph", "chain"}, {"noise.heading", "0.3"}, {"sensor.sigma", "0.2"}},
    {{"edges.graph", "none"}, {"sensor.range_max", "inf"}, {"filter.measurement", "2"}, {"noise.heading", "0.1"}}};

/// v_j of a candidate where the noise is constant.
template <class Layout>
std::vector<double> values(const Planner<Layout>& planner, int i) {
    const ValueParameters parameters = value_parameters(planner.view.sensor, planner.view.filter);
    const Vector2<double> there = planner.work->space.position + planner.move(i);
    std::vector<double> v;
    for (int j = 0; j < 3; ++j) {
        const bool seen = in_range(planner.view.sensor, squared_range(there, planner.work->space.feature[j]));
        v.push_back(seen ? parameters.constant : 0);
    }
    return v;
}

}  // namespace

TEST_CASE("planner: the cost in the space of the measurements is the plain one") {
    for (const Settings& world : worlds)
        with_both(world, [&](const Problem& problem, const Sample& sample, auto layout) {
            CAPTURE(described(world));
            Planner planner(problem, sample, layout);
            for (int i = 0; i < planner.view.control.candidate_count; i += 5)
                // cond(S) is below 1e5: 6 rows * 1e5 * 2^-53 = 7e-11 of the trace before, at most some times the cost.
                CHECK(relative(planner.cost(i), planner.plain(i)) < 1e-9);
        });
}

TEST_CASE("planner: every visible set is priced as the candidates that see it") {
    for (const char* factor : {"1", "0.5", "2"})
        with_samples<Layout<Process::translation, 3>>(
            "translation", {{"filter.measurement", factor}},
            [&](const Problem& problem, const Sample& sample, auto layout) {
                Planner planner(problem, sample, layout);
                VisibleSets<double>& sets = planner.work->sets;
                gather_sets(planner.work->still, planner.view.control, planner.view.sensor, layout, sets);
                price_sets(planner.work->space, planner.view.filter, planner.view.sensor, layout, *planner.room, sets);
                unsigned seen_somewhere = 0;  // sets, as bits
                for (int i = 0; i < planner.view.control.candidate_count; ++i) {
                    int set = 0;
                    for (int j = 0; j < 3; ++j) set |= sets.seeing[j][i] << j;
                    seen_somewhere |= 1u << set;
                    CHECK(relative(sets.cost[set], planner.plain(i)) < 1e-9);  // as above
                }
                for (int set = 0; set < 8; ++set) CHECK(sets.offered[set] == (seen_somewhere >> set & 1));
            });
}

TEST_CASE("planner: no candidate costs less than its bound") {
    for (const Settings& world : worlds)
        with_both(world, [&](const Problem& problem, const Sample& sample, auto layout) {
            CAPTURE(described(world));
            Planner planner(problem, sample, layout);
            const ProblemView& view = planner.view;
            const int count = std::min(view.control.candidate_count, screening_chunk);
            auto& screening = planner.work->screening;
            const ValueParameters parameters = value_parameters(view.sensor, view.filter);
            const auto& still = planner.work->still;
            const auto check = [&](auto ranged) {
                value_candidates<ranged()>(still, planner.heading, view.control, view.filter, view.sensor, layout,
                                           parameters, 0, count, screening);
                for (const int reference : {0, count / 3, count - 1}) {  // any reference will do
                    const auto tangent =
                        tangent_at(planner.work->space.position + planner.move(reference), still, planner.heading,
                                   view.filter, view.sensor, layout, view.control.weights, parameters.kappa, screening);
                    const auto eigenvalue = planner.eigenvalue_tangent(reference);
                    for (int i = 0; i < count; i += 3) {
                        const auto value = [&](int j) { return value_of<ranged()>(screening, parameters, i, j); };
                        const Point& move = view.control.candidates[i].move;
                        CHECK(tangent.bound(move, layout, value) <= planner.plain(i) * (1 + 1e-9));
                        CHECK(eigenvalue.bound(move, layout, value) <= planner.plain_eigenvalue(i) * (1 + 1e-9));
                    }
                }
            };
            if (view.sensor.noise == RangeNoise::ranged)
                check(std::true_type{});
            else
                check(std::false_type{});
        });
}

TEST_CASE("planner: the bound touches the cost at its reference, and its slope is the cost's") {
    // Without fresh heading noise to speak of, and another sensor that differs by one part in 10^4 of its sigma.
    const Settings world{{"noise.heading", "1e-9"}, {"sensor.range_max", "inf"}, {"sensor.sigma", "0.3"}};
    Settings nearly = world;
    nearly.push_back({"filter.measurement", "1.0001"});
    with_both(world, [&](const Problem& problem, const Sample& sample, auto layout) {
        Settings settings{{"model.process", layout.has_heading ? "heading" : "translation"},
                          {"features.path", "circle"},
                          {"features.sway_amplitude", "0.4"}};
        settings.insert(settings.end(), nearly.begin(), nearly.end());
        const Problem other(scenario_with(settings));
        Planner planner(problem, sample, layout), beside(other, sample, layout);
        auto& screening = planner.work->screening;
        const double kappa = least_feature_variance(planner.view.filter);
        for (int i = 0; i < planner.view.control.candidate_count; i += 7) {
            const auto tangent =
                tangent_at(planner.work->space.position + planner.move(i), planner.work->still, planner.heading,
                           planner.view.filter, planner.view.sensor, layout, planner.view.control.weights, kappa,
                           screening);
            const auto bound_of = [&](auto& of, const auto& touching) {
                const auto v = values(of, i);
                return touching.bound(planner.view.control.candidates[i].move, layout, [&](int j) { return v[j]; });
            };
            const auto bound = [&](auto& of) { return bound_of(of, tangent); };
            // The eigenvector is off by up to 1e-4, and the bound by the square of that.
            CHECK(relative(bound_of(planner, planner.eigenvalue_tangent(i)), planner.plain_eigenvalue(i)) < 1e-7);
            const double here = bound(planner), there = bound(beside);
            CHECK(relative(here, planner.cost(i)) < 1e-9);
            // A tangent is off by the square of the distance: 1e-4 of the change.
            const double change = beside.cost(i) - planner.cost(i);
            CHECK(std::abs(there - here - change) < 1e-3 * std::abs(change));
        }
    });
}

}  // namespace credence::test::planner_cost_long_test
