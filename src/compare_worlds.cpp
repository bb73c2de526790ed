// Whether trials of different files share their draws and their world.

#include <credence/error.hpp>
#include <credence/scenario_keys.hpp>

#include "compare_choice.hpp"

namespace credence {

namespace {

/// Whether scenarios of different files may differ in a key and still have the same truth and the same draws. Every
/// other key shapes the world.
bool may_differ(const std::string& key) {
    if (key == "scenario.name" || key == "scenario.title") return true;
    const std::string section = key.substr(0, key.find('.'));
    for (const char* free : {"filter", "control", "planner", "arms", "published"})
        if (section == free) return true;
    return false;
}

}  // namespace

void check_same_draws(const std::vector<StudyFile>& files) {
    const StudyFile& first = files.front();
    for (const StudyFile& file : files)
        if (file.study.root_seed != first.study.root_seed)
            throw InputError("cannot compare " + file.path + " with " + first.path + " (its root seed is " +
                             std::to_string(file.study.root_seed) + ", not " + std::to_string(first.study.root_seed) +
                             ": their trials do not share their draws). Run both with the same --seed.");
}

void check_same_world(const ChosenPair& pair) {
    const Scenario &a = pair.a.results.scenario, &b = pair.b.results.scenario;
    for (const ScenarioKey& key : scenario_keys())
        if (!may_differ(key.name) && key.get(a) != key.get(b))
            throw InputError("cannot compare " + pair.file_a.path + " with " + pair.file_b.path + " (scenario " +
                             a.name + " is another world: " + key.name + " is " + printable(key.get(a)) + " in " +
                             pair.file_a.path + " and " + printable(key.get(b)) + " in " + pair.file_b.path +
                             "). Compare runs that differ in filter, control, planner or arms only.");
}

std::vector<KeyDifference> key_differences(const Scenario& a, const Scenario& b) {
    std::vector<KeyDifference> differences;
    for (const ScenarioKey& key : scenario_keys())
        if (key.name != "scenario.title" && !key.name.starts_with("published.") && key.get(a) != key.get(b))
            differences.push_back({key.name, key.get(a), key.get(b)});
    return differences;
}

}  // namespace credence
