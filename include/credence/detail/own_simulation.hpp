#pragma once
// Module worlds: what the engine makes of the trials of a user's own world.

#include <credence/own_trial.hpp>
#include <credence/detail/world.hpp>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace credence {

/// What a user's own world says of a scenario beside its settings.
struct OwnReport {
    std::vector<Column> columns{};      ///< its own; others are there in every world
    int largest_innovation = 0;         ///< m; 0: the trials give no innovations
    BudgetSettings budget{};
    std::vector<std::string> sources{};  ///< of its draws, by name
};

/// Columns of such a world: trace_P, its own, squared_error, nees_ratio, nis_ratio, mean_trace_P, log_score, status,
/// status_pose.
std::vector<Column> own_columns(const Scenario& scenario, const OwnReport& report);
std::vector<Series> own_series(const Scenario& scenario, const OwnReport& report);

/// Makes trials of a function that runs one, which is called from several threads at once. Draws and evaluation are
/// those of lanes, in the target that best_target() gives.
std::unique_ptr<const Simulation> own_simulation(const Scenario& scenario, const OwnReport& report,
                                                 std::function<void(OwnTrial&)> run);

/// Throws InputError where a declaration cannot be stored, read back or judged: names that no file can have, or that
/// are there twice; keys of sections that mean something else in every world; a group beyond the state; a column of the
/// type status; rows of an innovation that are negative or more than 2000.
void check_declared(const Scenario& scenario, const OwnReport& report);

}  // namespace credence
