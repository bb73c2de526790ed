// Whether trials of different files share their draws and their world.

#include <credence/error.hpp>

#include "base/wording.hpp"
#include "report/compare/choice.hpp"

#include <algorithm>

namespace credence {

void check_same_draws(const std::vector<StudyFile>& files) {
    const StudyFile& first = files.front();
    for (const StudyFile& file : files)
        if (file.study.root_seed != first.study.root_seed)
            throw InputError("cannot compare " + file.path + " with " + first.path,
                             "its root seed is " + std::to_string(file.study.root_seed) + ", not " +
                                 std::to_string(first.study.root_seed) + ": their trials do not share their draws",
                             "Run both with the same " + as_option("seed"));
}

void check_same_world(const ChosenPair& pair) {
    for (const StudyFile* file : {&pair.file_a, &pair.file_b})
        if (keep_of(file->study) == Keep::aggregates)
            throw InputError("cannot compare " + pair.file_a.path + " with " + pair.file_b.path + " trial by trial",
                             file->path + " keeps aggregates: no trials, and differences of its own arms only",
                             "Run it with " + as_option("keep", "trials") + ", or compare arms of one file");
    const Scenario &a = pair.a.results.scenario, &b = pair.b.results.scenario;
    for (const KeyDifference& difference : key_differences(a, b))
        if (!keeps_the_draws(difference.key))
            throw InputError("cannot compare " + pair.file_a.path + " with " + pair.file_b.path,
                             "scenario " + a.name + " is another world: " + difference.key + " is " +
                                 printable(difference.a) + " in " + pair.file_a.path + " and " +
                                 printable(difference.b) + " in " + pair.file_b.path,
                             "Compare runs that differ in filter, control, planner, arms or sensor only");
}

void check_same_units(const ChosenPair& pair) {
    for (const Column& column : pair.a.results.columns) {
        // Those of a record's state are told by its components' units, if both records have these [same_runs.hpp].
        if (pair.file_a.is_record && (column.name.ends_with("trace_P") || column.name == "pose_error")) continue;
        const auto same = std::ranges::find(pair.b.results.columns, column.name, &Column::name);
        if (same != pair.b.results.columns.end() && same->unit != column.unit)
            throw InputError("cannot compare " + pair.file_a.path + " with " + pair.file_b.path,
                             column.name + " is in " + printable(column.unit) + " in " + pair.file_a.path + " and in " +
                                 printable(same->unit) + " in " + pair.file_b.path,
                             "Give both in the same units");
    }
}

bool of_different_worlds(const ComparedPair& pair) {
    return std::any_of(pair.differences.begin(), pair.differences.end(),
                       [](const KeyDifference& difference) { return is_of_the_sensor(difference.key); });
}

std::vector<KeyDifference> shown_differences(const Scenario& a, const Scenario& b) {
    std::vector<KeyDifference> differences = key_differences(a, b);
    std::erase_if(differences, [](const KeyDifference& difference) { return is_description(difference.key); });
    return differences;
}

}  // namespace credence
