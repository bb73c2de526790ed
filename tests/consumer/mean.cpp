// 256 trials of the default scenario, and the mean of their trace(P) under each arm.
#include <credence/ini.hpp>
#include <credence/slam_columns.hpp>
#include <credence/statistics.hpp>
#include <credence/study.hpp>
#include <credence/text.hpp>

#include <iostream>

int main() {
    credence::Study study = credence::new_study({credence::read_scenario_text("", "defaults", "mine")}, 1);
    credence::RunOptions options;
    options.trials = 256;
    credence::run_study(study, options);
    const credence::ScenarioResults& results = study.scenarios.front();
    for (const credence::ArmResults& arm : results.arms) {
        const credence::Summary summary =
            credence::summarise(credence::figure_values(results, arm, credence::column_trace_P));
        std::cout << "mine," << arm.name << ",trace_P," << credence::to_text(summary.mean) << "\n";
    }
}
