#pragma once
// A planner of one's own: it takes the control after which P is small and much is new [docs/planner.md].

#include <credence/planner.hpp>

struct Curious {
    static constexpr const char* name = "curious";

    struct Settings {
        double weight = 0.001;  ///< what a new cell is worth (length^2)
    };

    static void keys(credence::OwnKeys<Settings>& keys) {
        keys.real("planner.curious.weight", &Settings::weight, 0, 10, "what a new cell is worth (length^2)");
    }

    static double cost(const Settings& settings, const credence::PlannerBelief&, const credence::Prospect& then) {
        return then.trace - settings.weight * then.new_cells;
    }
};
