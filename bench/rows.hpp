#pragma once
// The measured scenarios, with one arm each.

#include "slam/trial/problem.hpp"
#include <deque>
#include <string>
#include <vector>

namespace credence::bench {

/// What a row is expected to reach on a core that executes AVX-512 in full width, as a multiple of the baselines; 0 for
/// nothing.
struct Bar {
    double A = 0, B = 0;
};

/// One arm of one scenario, prepared. `trials` of a block are run at once.
struct Row {
    std::string name;
    Controller controller = Controller::fixed;
    int trials = 0;
    Problem problem;
    Bar bar;

    Row(std::string row_name, const DeformableSettings& scenario, int trials_at_once, const Bar& expected = {});
    Row(const Row&) = delete;
    int features() const { return problem.view().features; }
    /// Steps of all the trials that are run at once.
    int steps() const { return trials * (problem.view().poses - 1); }
};

/// The reference study's cells (process, path, noise, controller), and greedy planning with more heading noise.
const std::deque<Row>& seed_rows();

/// Growth with the number of features: M = 1 ... 64 on the fixed path, up to 16 planned; heading model, straight.
const std::deque<Row>& growth_rows();

/// Every estimator on the fixed path and on the planned one; straight, constant sigma, in its own process model.
const std::deque<Row>& estimator_rows();

/// The defaults with keys set: name and value in turns. Resolved and validated.
DeformableSettings scenario_with(const std::string& name, const std::vector<std::string>& keys_and_values);

}  // namespace credence::bench
