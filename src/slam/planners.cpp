#include <credence/detail/planner_batch.hpp>

#include <credence/detail/draws.hpp>
#include <credence/error.hpp>
#include <credence/text.hpp>

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

std::vector<PlannerKey> planner_keys() {
    std::vector<PlannerKey> all;
    for (const auto& [name, known] : registry())
        for (PlannerKey& key : known.planner->keys()) all.push_back(std::move(key));
    return all;
}

std::vector<std::shared_ptr<const Planner>> planners_of(const DeformableSettings& settings) {
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
