#include "study/budget.hpp"

#include <credence/detail/worlds.hpp>
#include <credence/error.hpp>
#include <credence/text.hpp>

#include "base/wording.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

const std::string other_key = "draws.other", errors_key = "draws.errors";

/// The scenario with other values of some keys.
Scenario with(const Scenario& scenario, const std::vector<Setting>& others) {
    const std::unique_ptr<Draft> draft = world_of(scenario).draft();
    for (const auto* settings : {&scenario.settings, &others})
        for (const Setting& setting : *settings)
            if (setting.key != world_key) draft->set(setting.key, setting.value);
    return draft->declare();
}

using Worlds = std::vector<const ScenarioResults*>;

bool is_own_world(const ScenarioResults& results) { return value_of(results.scenario, other_key).empty(); }

/// The worlds of each budget, A first.
std::vector<Worlds> worlds_in(const Study& study) {
    std::vector<Worlds> budgets;
    for (const ScenarioResults& results : study.scenarios) {
        if (value_of(results.scenario, errors_key).empty()) continue;
        if (is_own_world(results)) budgets.emplace_back();
        if (!budgets.empty()) budgets.back().push_back(&results);
    }
    const std::string remedy = "Make one by " + as_command({"run", "SCENARIO.ini", "--budget", "last"});
    if (budgets.empty()) throw InputError("cannot tell errors by their sources", "the study has no budget", remedy);
    for (const Worlds& worlds : budgets)
        if (worlds.size() < 4 || worlds.size() % 2 != 0)
            throw InputError("cannot tell errors by their sources",
                             "worlds of " + printable(worlds.front()->scenario.name) + " are missing", remedy);
    if (!study.complete || keep_of(study) != Keep::trials)
        throw InputError("cannot tell errors by their sources", "the study does not have all of its trials",
                         "Resume it, merge its shards, or run it with --keep trials");
    return budgets;
}

/// Values of a column in the trials that count, to [trials, steps] at a step.
void copy_counting(const ScenarioResults& results, std::size_t arm, std::size_t column,
                   const std::vector<char>& counting, std::size_t step, std::size_t steps, std::vector<double>& to) {
    const std::vector<double> values = column_values(results, results.arms[arm], column);
    std::size_t place = step;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (counting[i]) to[place] = values[i], place += steps;
}

ArmBudget budget_of(const Worlds& worlds, std::size_t arm, std::uint64_t root_seed) {
    const ScenarioResults& own = *worlds.front();
    const Scenario& scenario = own.scenario;
    ArmBudget budget{scenario.name, own.arms[arm].name};
    budget.at = value_of(scenario, errors_key) == "mean" ? KeptErrors::mean : KeptErrors::last;
    std::vector<char> counting(static_cast<std::size_t>(own.trials), 1);
    for (const ScenarioResults* world : worlds) {
        const std::vector<double> status = column_values(*world, world->arms[arm], status_column(world->columns));
        for (std::size_t i = 0; i < counting.size(); ++i) counting[i] = counting[i] && status[i] == 0;
    }
    budget.trials = std::ranges::count(counting, 1);
    budget.left_out = own.trials - budget.trials;
    if (budget.trials < 2)
        throw InputError("cannot tell the errors of " + printable(scenario.name + "/" + budget.arm) +
                             " by their sources",
                         std::to_string(budget.trials) + " of " + std::to_string(own.trials) +
                             " trials completed in every one of " + std::to_string(worlds.size()) + " worlds",
                         "Give more trials, or see what becomes of one by " + as_command({"replay"}));
    BudgetErrors errors;
    errors.trials = static_cast<std::size_t>(budget.trials);
    errors.steps = kept_steps(budget.at, own.steps()).size();
    errors.components = scenario.components;
    errors.groups = scenario.groups;
    for (std::size_t c = 2; c < worlds.size(); c += 2)
        errors.sources.push_back(value_of(worlds[c]->scenario, other_key));
    budget.sources = errors.sources;
    const std::size_t n = errors.components.size();
    const auto read = [&](const ScenarioResults& world, bool variances, std::size_t component) {
        const std::size_t cells = errors.steps * n,
                          first = world.columns.size() - 2 - cells * (is_own_world(world) ? 2 : 1);
        std::vector<double> values(errors.trials * errors.steps);
        for (std::size_t k = 0; k < errors.steps; ++k)
            copy_counting(world, arm, first + cells * variances + k * n + component, counting, k, errors.steps, values);
        return values;
    };
    errors.of = [&](std::size_t run, std::size_t component) { return read(*worlds[run], false, component); };
    const bool grows = std::ranges::count(own.all_series, "state_dimension", &Series::name) > 0;
    for (std::size_t j = 0; j < n; ++j) {
        std::vector<char> there(errors.trials * errors.steps, 1);
        for (const ScenarioResults* world : grows ? worlds : Worlds{}) {  // what is absent from the state has no error
            const std::vector<double> values = read(*world, false, j);
            for (std::size_t i = 0; i < values.size(); ++i) there[i] = there[i] && !std::isnan(values[i]);
        }
        double sum = 0, count = 0;
        const std::vector<double> variances = read(own, true, j);
        for (std::size_t i = 0; i < variances.size(); ++i)
            if (there[i]) sum += variances[i], ++count;
        errors.variance.push_back(count > 0 ? sum / count : 0);
        if (grows) errors.there.push_back(std::move(there));
    }
    CountedVariances counted = simulation_of(scenario)->counted(arm, root_seed, own.trials);
    budget.counted_trials = counted.trials;
    errors.counted = std::move(counted.sources);
    errors.counted_variance = std::move(counted.variance);
    budget.parts = budget_parts(errors);
    return budget;
}

}  // namespace

std::vector<Scenario> budget_scenarios(const Scenario& scenario, KeptErrors kept) {
    const std::string cannot = "cannot make a budget of " + printable(scenario.name);
    for (const std::string& key : {other_key, errors_key})
        if (!value_of(scenario, key).empty())
            throw InputError(cannot, "it has " + key + ", as the worlds of a budget do", "Leave that out");
    const std::vector<DrawSource> sources = world_of(scenario).sources(scenario);
    if (sources.empty())
        throw InputError(cannot, "world " + printable(scenario.world) + " names no sources of its draws",
                         "Give it `static constexpr const char* sources[]` [own_world.hpp]");
    if (sources.size() < 2) throw InputError(cannot, "all of its error is of " + sources.front().name, {});
    std::vector<Scenario> worlds;
    const auto add = [&](const std::string& suffix, const std::vector<std::string>& other) {
        std::vector<Setting> settings{{"scenario.name", scenario.name + suffix},
                                      {errors_key, kept_errors_names()[static_cast<std::size_t>(kept)]}};
        if (!other.empty()) settings.push_back({other_key, joined(other)});
        worlds.push_back(with(scenario, settings));
    };
    std::vector<std::string> all;
    for (const DrawSource& source : sources) all.push_back(source.name);
    add("", {});
    worlds.front().sweep = scenario.sweep;
    add("-B", all);
    for (const std::string& name : all) {
        std::vector<std::string> rest = all;
        std::erase(rest, name);
        add("-C-" + name, {name});
        add("-D-" + name, rest);
    }
    return worlds;
}

void check_part(const std::vector<Component>& components, const std::vector<ComponentGroup>& groups,
                const std::string& name) {
    std::vector<std::string> names;
    for (const ComponentGroup& group : groups_of_one_unit(components, groups)) names.push_back(group.name);
    if (std::ranges::find(names, name) == names.end())
        throw invalid_value(as_option("of"), name, "there is no such component, or group of one unit",
                            "Take " + joined(names));
}

std::vector<ArmBudget> budgets_of(const Study& study) {
    std::vector<ArmBudget> budgets;
    for (const Worlds& worlds : worlds_in(study))
        for (std::size_t arm = 0; arm < worlds.front()->arms.size(); ++arm)
            budgets.push_back(budget_of(worlds, arm, study.root_seed));
    return budgets;
}

}  // namespace credence
