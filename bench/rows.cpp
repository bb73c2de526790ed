#include "rows.hpp"

#include <cmath>
#include "worlds/deformable/deformable.hpp"
#include "worlds/deformable/keys.hpp"
#include "worlds/values.hpp"
#include <credence/text.hpp>

namespace credence::bench {

namespace {

struct Cell {
    const char *process, *path, *noise, *controller, *sigma_heading;

    bool is(const char* field, const char* value) const { return std::string(field) == value; }
};

/// The bar of a whole trial with draws and all statistics, on one core.
Bar bar_of(const Cell& cell) {
    const bool circle = cell.is(cell.path, "circle"), constant = cell.is(cell.noise, "constant");
    const bool fixed = cell.is(cell.controller, "fixed");
    if (cell.is(cell.process, "translation")) return fixed || !circle ? Bar{} : Bar{constant ? 1500.0 : 700.0, 0};
    if (fixed) return {60, 30};
    if (!cell.is(cell.sigma_heading, "0.001")) return circle ? Bar{400, 150} : Bar{200, 75};
    if (circle) return constant ? Bar{700, 260} : Bar{600, 220};
    return constant ? Bar{280, 105} : Bar{230, 90};
}

std::string cell_name(const Cell& cell) {
    std::string name = std::string(cell.process) + "-" + cell.path + "-" + cell.noise + "-" + cell.controller;
    const std::string sigma = cell.sigma_heading;
    return sigma == "0.001" ? name : name + "-sigma_head=" + sigma;
}

std::vector<Cell> cells() {
    std::vector<Cell> all;
    for (const char* process : {"heading", "translation"})
        for (const char* controller : {"fixed", "greedy"})
            for (const char* path : {"straight", "circle"})
                for (const char* noise : {"constant", "ranged"})
                    all.push_back({process, path, noise, controller, "0.001"});
    for (const char* sigma : {"0.01", "0.1"})
        for (const char* path : {"straight", "circle"}) all.push_back({"heading", path, "ranged", "greedy", sigma});
    return all;
}

/// M features: the reference study's first, then on a spiral about the robot, in range and apart from one another.
std::string positions(int M) {
    std::string text = "0.5 0.5, 0.9 0.8, 0.3 0.4";
    if (M < 3) return M == 1 ? "0.5 0.5" : "0.5 0.5, 0.9 0.8";
    for (int j = 3; j < M; ++j) {
        const double radius = 0.3 + 1.2 * std::sqrt(j / 64.0), angle = 2.39996 * j;
        text += ", " + to_text(radius * std::cos(angle)) + " " + to_text(radius * std::sin(angle));
    }
    return text;
}

}  // namespace

DeformableSettings scenario_with(const std::string& name, const std::vector<std::string>& keys_and_values) {
    DeformableSettings scenario;
    scenario.name = name;
    for (std::size_t i = 0; i + 1 < keys_and_values.size(); i += 2)
        set_key(scenario, keys_and_values[i], keys_and_values[i + 1]);
    scenario = resolved(scenario);
    validate(scenario);
    return scenario;
}

Row::Row(std::string row_name, const DeformableSettings& scenario, int trials_at_once, const Bar& expected)
    : name(std::move(row_name)),
      controller(scenario.arms.controllers.front()),
      trials(trials_at_once),
      problem(scenario),
      bar(expected) {}

const std::deque<Row>& seed_rows() {
    static const std::deque<Row> rows = [] {
        std::deque<Row> made;
        for (const Cell& cell : cells())
            made.emplace_back(cell_name(cell),
                              scenario_with("cell", {"model.process", cell.process, "features.path", cell.path,
                                                     "sensor.noise", cell.noise, "noise.heading", cell.sigma_heading,
                                                     "arms.controllers", cell.controller}),
                              block_size, bar_of(cell));
        return made;
    }();
    return rows;
}

const std::deque<Row>& growth_rows() {
    static const std::deque<Row> rows = [] {
        std::deque<Row> made;
        for (const char* controller : {"fixed", "greedy"})
            for (const int M : {1, 2, 3, 4, 6, 8, 16, 32, 64}) {
                if (M > 16 && controller == std::string("greedy")) continue;
                made.emplace_back(
                    "M=" + std::to_string(M) + "-" + controller,
                    scenario_with("growth", {"features.positions", positions(M), "arms.controllers", controller}),
                    M <= 8 ? block_size : 512 / M);
            }
        return made;
    }();
    return rows;
}

const std::deque<Row>& estimator_rows() {
    static const std::deque<Row> rows = [] {
        std::deque<Row> made;
        for (std::size_t e = 0; e < estimator_names().size(); ++e)
            for (const char* controller : {"fixed", "greedy"}) {
                const bool heading = process_of(static_cast<Estimator>(e)) == Process::heading;
                const std::string& estimator = estimator_names()[e];
                made.emplace_back(controller + ("." + estimator),
                                  scenario_with("estimator",
                                                {"model.process", heading ? "heading" : "translation",
                                                 "arms.estimators", estimator, "arms.controllers", controller}),
                                  block_size);
            }
        return made;
    }();
    return rows;
}

}  // namespace credence::bench
