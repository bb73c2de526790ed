// Planners of one's own in the worlds `deformable` and `explore`: what they are told against the built-in planner and
// against Eigen, and the same bits from every target. Those in Python: python/tests/test_planners.py.

#include <credence/error.hpp>
#include <credence/ini.hpp>
#include <credence/planner.hpp>
#include "engine/octets.hpp"
#include "worlds/deformable/deformable.hpp"
#include "worlds/explore/explore.hpp"

#include "catch.hpp"
#include "support.hpp"

#include <Eigen/Dense>

#include <atomic>
#include <cmath>

namespace credence::test::own_planner_test {

using Catch::Contains;

namespace {

/// The planner is there while the object exists.
struct Added {
    std::string name;
    Added(const std::string& of, std::shared_ptr<const Planner> planner, const std::string& version = {}) : name(of) {
        add_planner(name, std::move(planner), version);
    }
    ~Added() { remove_planner(name); }
};

struct Trace {
    static constexpr const char* name = "trace";
    struct Settings {};
    static double cost(const Settings&, const PlannerBelief&, const Prospect& then) { return then.trace; }
};

struct LogDet {
    static constexpr const char* name = "log_det";
    struct Settings {};
    static double cost(const Settings&, const PlannerBelief&, const Prospect& then) { return then.log_det; }
};

/// Rooms with a narrow view.
ExploreSettings rooms() {
    ExploreSettings s;
    s.poses = 13;
    s.walls = {{{-2, 1}, {2, 1}}, {{2, 1}, {2, -3}}};
    s.features.extent = 8;
    s.features.count = 7;
    s.sensor.range_max = 3;
    s.view = 2.5;
    s.box = {{-4, -4}, {4, 4}};
    s.explorers = {Explorer::greedy};
    return s;
}

template <class Make>
std::vector<double> columns_of(const Make& simulation, std::size_t arm, std::size_t trials = 256,
                               std::int64_t first = 0) {
    BlockMemory memory;
    memory.octets.prepare(simulation.shape(), trials, false);
    simulation.simulate(arm, memory.octets.batch(5, first, memory.room.of_size(simulation.workspace_size(arm))));
    return memory.octets.columns;
}

/// The share of trials whose trace_P is the same under both arms.
template <class Make>
double same_share(const Make& simulation) {
    const std::vector<double> a = columns_of(simulation, 0), b = columns_of(simulation, 1);
    const std::size_t columns = static_cast<std::size_t>(simulation.shape().column_count);
    int same = 0;
    for (std::size_t trial = 0; trial < 256; ++trial) {
        const std::size_t at = trial / octet * columns * octet + trial % octet;
        same += std::abs(a[at] - b[at]) <= 1e-9 * a[at];
    }
    return same / 256.0;
}

}  // namespace

TEST_CASE("own planners: by the trace and by log det they go the built-in planner's way") {
    const Added trace("trace", std::make_shared<CostPlanner<Trace>>());
    const Added log_det("log_det", std::make_shared<CostPlanner<LogDet>>());
    for (const Criterion criterion : {Criterion::trace, Criterion::log_det}) {
        const std::string name = criterion == Criterion::trace ? "trace" : "log_det";
        CAPTURE(name);
        ExploreSettings explore = rooms();
        explore.planner.criterion = criterion;
        explore.arms.planners = {{name, ""}};
        CHECK(same_share(ExploreSimulation(resolved(explore))) >= 0.95);  // rounding may part equal candidates
        for (const Process process : {Process::heading, Process::translation}) {
            DeformableSettings circle = scenario_with({{"features.path", "circle"}});
            circle.process = process;
            circle.poses = 8;
            circle.planner.criterion = criterion;
            circle.arms.controllers = {Controller::greedy};
            circle.arms.planners = {{name, ""}};
            const Problem problem(resolved(circle));
            CHECK(same_share(DeformableSimulation(problem)) >= 0.95);
        }
    }
}

TEST_CASE("own planners: what they are told holds together") {
    struct Watch : Planner, ProspectVisitor {
        mutable const PlannerBatch* now = nullptr;
        mutable int prospects = 0, absent = 0;
        void choose(const PlannerBatch& batch) const override {
            now = &batch;
            batch.visit_prospects(const_cast<Watch&>(*this));
            for (int b = 0; b < batch.trials; ++b)
                batch.control[b] = batch.candidate[static_cast<int>(batch.uniform(b, 0) * batch.candidates)];
        }
        void visit(int b, int candidate, bool, const Prospect& then) override {
            const PlannerBelief belief = now->belief(b);
            const int n = belief.components;
            using Matrix = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>>;
            std::vector<int> there{0, 1, 2};
            for (int j = 0; j < belief.features; ++j)
                if (belief.known[j]) there.insert(there.end(), {3 + 2 * j, 4 + 2 * j});
                else ++absent;
            const Eigen::MatrixXd P = Matrix(then.covariance, n, n)(there, there);
            ++prospects;
            if (prospects % 7 != 0) return;
            CHECK(then.log_det == Approx(std::log(P.determinant())).epsilon(1e-6));
            CHECK(then.trace == Approx(P.trace()).epsilon(1e-9));
            const double angle = belief.mean[0];
            const Point move = then.control.move;
            CHECK(then.control == now->candidate[candidate]);
            CHECK(then.mean[0] == Approx(angle + then.control.turn).margin(1e-12));
            CHECK(then.mean[1] == Approx(belief.mean[1] + std::cos(angle) * move.x - std::sin(angle) * move.y)
                                      .margin(1e-12));
            for (int j = 0; j < belief.features; ++j) {
                CHECK((belief.known[j] || !then.seen[j]));
                CHECK(belief.known[j] == std::isfinite(belief.mean[3 + 2 * j]));
                if (!then.seen[j]) continue;
                CHECK(std::hypot(then.mean[3 + 2 * j] - then.mean[1], then.mean[4 + 2 * j] - then.mean[2]) <= 3 + 1e-9);
            }
        }
    };
    const auto watch = std::make_shared<Watch>();
    const Added added("watch", watch);
    ExploreSettings settings = rooms();
    settings.poses = 6;
    settings.arms.planners = {{"watch", ""}};
    columns_of(ExploreSimulation(resolved(settings)), 1, 20);
    CHECK(watch->prospects == 20 * 5 * candidate_count(resolved(settings)));
    CHECK(watch->absent > 0);
}

TEST_CASE("own planners: the same bits from every target, and for any company") {
    const Added added("trace", std::make_shared<CostPlanner<Trace>>());
    ExploreSettings settings = rooms();
    settings.arms.planners = {{"trace", ""}};
    std::vector<double> first;
    for (const Target& target : runnable_targets()) {
        CAPTURE(target.name);
        const ExploreSimulation simulation(resolved(settings), target);
        const std::vector<double> all = columns_of(simulation, 1, 72);
        if (first.empty()) first = all;
        CHECK(same_bits(all, first));
        const std::vector<double> later = columns_of(simulation, 1, 8, 64);
        CHECK(same_bits(later, {all.end() - static_cast<std::ptrdiff_t>(later.size()), all.end()}));
        simulation.check_repeats(5);
    }
}

TEST_CASE("own planners: a control that is not finite fails its trial, and one that is no function is refused") {
    struct Lost : Planner {
        void choose(const PlannerBatch& batch) const override {
            for (int b = 0; b < batch.trials; ++b) {
                batch.control[b] = batch.candidate[0];
                if (batch.trial[b] == 9 && batch.step == 3) batch.control[b].turn = std::nan("");
            }
        }
    };
    struct Changing : Planner {
        mutable std::atomic<int> calls = 0;
        void choose(const PlannerBatch& batch) const override {
            const int candidate = calls++ % batch.candidates;
            for (int b = 0; b < batch.trials; ++b) batch.control[b] = batch.candidate[candidate];
        }
    };
    const Added lost("lost", std::make_shared<Lost>());
    const Added changing("changing", std::make_shared<Changing>());
    ExploreSettings settings = rooms();
    settings.arms.planners = {{"lost", ""}};
    const ExploreSimulation simulation(resolved(settings));
    const std::vector<double> columns = columns_of(simulation, 1, 16);
    const std::size_t count = static_cast<std::size_t>(simulation.shape().column_count);
    for (std::size_t trial = 0; trial < 16; ++trial) {
        const double* of = columns.data() + trial / octet * count * octet + trial % octet;
        CHECK((of[(count - 2) * octet] == static_cast<int>(Status::non_finite)) == (trial == 9));
        if (trial == 9) CHECK(of[(count - 1) * octet] == 3);
    }
    settings.arms.planners = {{"changing", ""}};
    CHECK_THAT(refusal([&] { ExploreSimulation(resolved(settings)).check_repeats(5); }),
               Contains("changing.ekf") && Contains("goes another way a second time"));
}

TEST_CASE("own planners: names, versions and keys are those of the scenario") {
    const auto declared = [](const std::string& lines) {
        return read_scenario_text("[scenario]\nworld = explore\n[arms]\n" + lines, "test", "test");
    };
    const Added added("trace", std::make_shared<CostPlanner<Trace>>(), "a1");
    const Scenario scenario = declared("controllers = fixed\nplanners = trace:a1, absent\n");
    CHECK(scenario.arms == std::vector<std::string>{"fixed.ekf", "trace.ekf", "absent.ekf"});
    CHECK(read_scenario_text(scenario_text(scenario), "test", "other").settings == scenario.settings);
    CHECK_THAT(refusal([&] { simulation_of(scenario); }), Contains("arms.planners=absent (this program has no such"));
    CHECK_THAT(refusal([&] { simulation_of(declared("planners = trace:b2\n")); }),
               Contains("it was another function when the study began"));
    CHECK_THAT(refusal([&] { declared("planners = frontier\n"); }), Contains("there is a controller frontier already"));
    CHECK_THAT(refusal([&] { declared("planners = a, a\n"); }), Contains("there is a controller a already"));
    CHECK_THAT(refusal([&] { declared("planners = a.b\n"); }), Contains("only letters"));
    CHECK_THAT(refusal([&] { declared("planners = trace:a1\n[planner]\ntrace.weight = 1\n"); }),
               Contains("unknown key planner.trace.weight (its planner has none)"));
    const Scenario other = declared("planners = trace:a1\n[planner]\nelsewhere.weight = 1\n");
    CHECK(read_scenario_text(scenario_text(other), "test", "other").settings == other.settings);
    CHECK_THAT(refusal([&] { simulation_of(other); }), Contains("(arms.planners has no elsewhere)"));
}

}  // namespace credence::test::own_planner_test
