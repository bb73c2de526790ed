#include <credence/detail/planner_batch.hpp>

#include <credence/detail/draws.hpp>
#include <credence/error.hpp>
#include <credence/text.hpp>

#include <algorithm>
#include <limits>

namespace credence {

namespace {

struct Known {
    std::shared_ptr<const Planner> planner;
    std::string version;
};

std::map<std::string, Known>& registry() {
    static auto& all = *new std::map<std::string, Known>;  // a run in another thread needs it while the process exits
    return all;
}

/// NAME of planner.NAME.key.
std::string planner_of(const std::string& key) {
    const std::size_t begin = key.find('.') + 1;
    return key.substr(begin, key.find('.', begin) - begin);
}

}  // namespace

double PlannerBatch::uniform(int place, int index) const {
    const auto number = static_cast<std::uint64_t>(trial[place]);
    return KeyedDraws<double>(root_seed, number, std::numeric_limits<double>::infinity(), other)
        .uniform(Source::control, step, 1 + index);  // 0 is that of the controller `random`
}

void add_planner(const std::string& name, std::shared_ptr<const Planner> planner, const std::string& version) {
    registry()[name] = {std::move(planner), version};
}

void remove_planner(const std::string& name) { registry().erase(name); }

bool is_planner_key(const std::string& key) {
    return key.starts_with("planner.") && std::ranges::count(key, '.') == 2;
}

std::string planner_value(const std::string& key, const std::string& value) {
    const auto found = registry().find(planner_of(key));
    if (found == registry().end()) return value;
    std::vector<std::string> names;
    for (const PlannerKey& own : found->second.planner->keys()) {
        if (own.name == key) return own.read(value);
        names.push_back(own.name);
    }
    throw InputError("unknown key " + key + " (its planner has " + (names.empty() ? "none" : joined(names)) +
                     "). Leave it out.");
}

std::vector<std::shared_ptr<const Planner>> planners_of(const DeformableSettings& settings) {
    for (const auto& [key, value] : settings.planner.own)
        if (std::ranges::count(settings.arms.planners, planner_of(key), &OwnPlanner::name) == 0)
            throw InputError("unknown key " + key + " (arms.planners has no " + planner_of(key) + "). Leave it out, or "
                             "add the planner.");
    std::vector<std::shared_ptr<const Planner>> planners;
    for (const OwnPlanner& own : settings.arms.planners) {
        const auto found = registry().find(own.name);
        if (found == registry().end())
            throw invalid_value("arms.planners", own.name, "this program has no such planner",
                                "Use the program that has it, or give Python's `planners` a function of that name");
        const auto& [planner, version] = found->second;
        if (version != own.version)
            throw invalid_value("arms.planners", own.name, "it was another function when the study began",
                                "Give the one that it was, or begin a new study");
        const std::shared_ptr<const Planner> with = planner->with(settings.planner.own);
        planners.push_back(with ? with : planner);
    }
    return planners;
}

}  // namespace credence
