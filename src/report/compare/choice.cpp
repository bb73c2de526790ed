// Selects the arms that are compared, and checks that trials of different files share their draws and their world.

#include "report/compare/choice.hpp"

#include "base/wording.hpp"

#include <algorithm>
#include <credence/error.hpp>
#include <credence/text.hpp>
#include <set>

namespace credence {

namespace {

/// The names of all arms of a file, each once.
std::vector<std::string> arm_names(const StudyFile& file) {
    std::vector<std::string> names;
    for (const ScenarioResults& results : file.study.scenarios)
        for (const ArmResults& arm : results.arms)
            if (std::ranges::count(names, arm.name) == 0) names.push_back(arm.name);
    return names;
}

std::string contents(const StudyFile& file) {
    std::vector<std::string> scenarios;
    for (const ScenarioResults& results : file.study.scenarios) scenarios.push_back(results.scenario.name);
    return file.path + " has " + joined(arm_names(file)) + " in " + joined(scenarios);
}

/// The arm that a name denotes: its own name, or that of the only arm of a controller; nullptr for none.
const ArmResults* named_arm(const ScenarioResults& results, const std::string& name, const ArmsChoice& choice) {
    const std::vector<const ArmResults*> meant = arms_meant(results, name);
    if (meant.size() > 1) {
        std::vector<std::string> names;
        for (const ArmResults* arm : meant) names.push_back(arm->name);
        throw invalid_value(as_option("arms"), choice.text,
                            name + " in scenario " + results.scenario.name + " is " + joined(names, " or "),
                            "Give the arm's whole name");
    }
    return meant.empty() ? nullptr : meant.front();
}

/// Collects the pairs of two files, or of one file with itself.
class Chooser {
public:
    Chooser(const std::vector<StudyFile>& files, std::vector<std::string>& left_out)
        : files_(files), left_out_(left_out) {
        std::vector<std::string> paths;
        for (const StudyFile& file : files) paths.push_back(file.path);
        labels_ = file_labels(paths);
    }

    std::vector<ChosenPair> take() { return std::move(pairs_); }

    void planned_against_baselines() {
        for (const ScenarioResults& results : files_[0].study.scenarios) {
            const std::size_t before = pairs_.size();
            for (const ArmResults& arm : results.arms) {
                const ArmResults* first = &results.arms.front();
                const ArmResults* baseline = files_[0].is_record ? first : baseline_of(results, arm);
                if (baseline != nullptr && baseline != &arm) add(0, results, arm, 0, results, *baseline);
            }
            if (pairs_.size() == before) leave_out(results, "no planned arm has one to compare with");
        }
        if (pairs_.empty())
            throw InputError("nothing to compare in " + files_[0].path,
                             "no arm has that of a simpler controller and the same estimator beside it",
                             remedy_of_one() + ": " + contents(files_[0]));
    }

    /// Pairs every arm of a later file with the first file's arm of the same name.
    void same_arms(std::size_t later) {
        const std::size_t before = pairs_.size();
        for_matches(later, 0, [&](const ScenarioResults& a, const ScenarioResults& b) {
            const std::size_t had = pairs_.size();
            for (const ArmResults& arm : a.arms)
                for (const ArmResults& other : b.arms)
                    if (arm.name == other.name) add(later, a, arm, 0, b, other);
            if (pairs_.size() == had) leave_out(a, "no arm has the same name in both files");
        });
        if (pairs_.size() == before)
            throw InputError("cannot compare " + files_[later].path + " with " + files_[0].path,
                             "no scenario of the same name has an arm of the same name",
                             "Give " + as_option("arms", "A,B") + " or other files: " + contents(files_[0]) + "; " +
                                 contents(files_[later]));
    }

    void chosen(const ArmsChoice& choice) {
        for_matches(choice.a.file, choice.b.file, [&](const ScenarioResults& in_a, const ScenarioResults& in_b) {
            const ArmResults* a = named_arm(in_a, choice.a.arm, choice);
            const ArmResults* b = named_arm(in_b, choice.b.arm, choice);
            if (a != nullptr && a == b)
                throw invalid_value(as_option("arms"), choice.text, "both are the same arm", "Give two arms");
            if (a != nullptr && b != nullptr)
                add(choice.a.file, in_a, *a, choice.b.file, in_b, *b);
            else
                leave_out(in_a, "no arm " + (a == nullptr ? choice.a.arm : choice.b.arm));
        });
        if (pairs_.empty()) refuse(choice);
    }

private:
    void add(std::size_t file_a, const ScenarioResults& in_a, const ArmResults& a, std::size_t file_b,
             const ScenarioResults& in_b, const ArmResults& b) {
        const auto label = [&](std::size_t file, const ArmResults& arm) {
            if (!files_[file].label.empty()) return files_[file].label;
            return files_.size() == 1 ? arm.name : labels_[file] + ":" + arm.name;
        };
        const ChosenPair pair{{in_a, a, label(file_a, a)}, {in_b, b, label(file_b, b)}, files_[file_a], files_[file_b]};
        if (file_a != file_b) check_same_world(pair), check_same_units(pair);
        pairs_.push_back(pair);
    }

    /// An option that compares two arms of the only file, or what to do where no scenario of it has two.
    std::string remedy_of_one() const {
        for (const ScenarioResults& results : files_[0].study.scenarios)
            if (results.arms.size() > 1)
                return "Choose two arms, such as " +
                       as_option("arms", results.arms[0].name + "," + results.arms[1].name);
        return "Give a further file to compare its arm with";
    }

    void leave_out(const ScenarioResults& results, const std::string& why) {
        left_out_.push_back(results.scenario.name + " (" + why + ")");
    }

    /// Calls `match` for the scenarios of the same name.
    template <class Match>
    void for_matches(std::size_t file_a, std::size_t file_b, const Match& match) {
        std::set<std::string> matched;
        for (const ScenarioResults& a : files_[file_a].study.scenarios)
            for (const ScenarioResults& b : files_[file_b].study.scenarios)
                if (a.scenario.name == b.scenario.name) matched.insert(a.scenario.name), match(a, b);
        const auto leave_unmatched = [&](std::size_t file, std::size_t other) {
            for (const ScenarioResults& results : files_[file].study.scenarios)
                if (matched.count(results.scenario.name) == 0) leave_out(results, "not in " + files_[other].path);
        };
        leave_unmatched(file_a, file_b);
        leave_unmatched(file_b, file_a);
    }

    [[noreturn]] void refuse(const ArmsChoice& choice) const {
        std::string why = "no scenario has both", nearest;
        for (const ArmChoice& side : {choice.a, choice.b}) {
            std::vector<std::string> names = arm_names(files_[side.file]);
            for (std::size_t i = names.size(); i-- > 0;) names.push_back(controller_of(names[i]));
            if (std::ranges::count(names, side.arm) > 0) continue;
            why = "no scenario of " + files_[side.file].path + " has " + side.arm;
            nearest = did_you_mean(side.arm, names);
            break;
        }
        std::string there = contents(files_[choice.a.file]);
        if (choice.a.file != choice.b.file) there += "; " + contents(files_[choice.b.file]);
        throw invalid_value(as_option("arms"), choice.text, why, nearest + "The arms there are: " + there);
    }

    const std::vector<StudyFile>& files_;
    std::vector<std::string>& left_out_;
    std::vector<std::string> labels_;
    std::vector<ChosenPair> pairs_;
};

}  // namespace

std::vector<ChosenPair> chosen_pairs(const std::vector<StudyFile>& files, const std::optional<ArmsChoice>& choice,
                                     std::vector<std::string>& left_out) {
    check_same_draws(files);
    Chooser chooser(files, left_out);
    if (choice)
        chooser.chosen(*choice);
    else if (files.size() == 1)
        chooser.planned_against_baselines();
    else
        for (std::size_t later = 1; later < files.size(); ++later) chooser.same_arms(later);
    return chooser.take();
}

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
    return std::ranges::any_of(pair.differences, is_of_the_sensor, &KeyDifference::key);
}

std::vector<KeyDifference> shown_differences(const Scenario& a, const Scenario& b) {
    std::vector<KeyDifference> differences = key_differences(a, b);
    std::erase_if(differences, [](const KeyDifference& difference) { return is_description(difference.key); });
    return differences;
}

}  // namespace credence
