#pragma once
// The oracle of lanes.

#include <credence/detail/own_simulation.hpp>

#include <functional>
#include <memory>

namespace credence {

/// The trials of own_simulation, to rounding, each evaluated by itself as a step of a record is.
std::unique_ptr<const Simulation> one_at_a_time_simulation(const Scenario& scenario, const OwnReport& report,
                                                           std::function<void(OwnTrial&)> run);

}  // namespace credence
