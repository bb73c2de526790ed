#pragma once
// Module worlds: the adapter by which every world, ours and a user's own, becomes what engine, files and program know.

#include <credence/detail/deformable_settings.hpp>
#include <credence/detail/keys.hpp>
#include <credence/detail/worlds.hpp>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace credence {

/// A world made of a type T with
///   T::Settings                            a plain struct with name, title, length_unit, poses and budget, and its own
///   name()                                 what `scenario.world` says
///   keys()                                 std::vector<KeyOf<Settings>>, in the order in which they are shown
///   defaults()                             the settings that `credence show` prints where none are given
///   resolved(Settings)                     the settings with every default filled in; throws InputError where keys
///                                          contradict each other
///   describe(const Settings&, Scenario&)   enters components, groups and arms
///   sources(const Settings&)               the sources of draws, std::vector<DrawSource>
///   columns(const Settings&, const Scenario&), all_series(const Settings&, const Scenario&)
///   simulation(const Settings&, const Scenario&)
/// all of them const, the settings that they are given resolved.
template <class T>
class WorldOf : public World {
    using Settings = typename T::Settings;

public:
    std::string name() const override { return world_.name(); }
    std::vector<DescribedKey> keys() const override {
        std::vector<DescribedKey> described;
        const Settings defaults = world_.defaults();
        for (const KeyOf<Settings>& key : world_.keys())
            if (!key.hidden) described.push_back({key.name, key.get(defaults), key.help, key.choices, key.sigma_unit});
        return described;
    }
    std::unique_ptr<Draft> draft() const override { return std::make_unique<DraftOf>(*this); }
    std::vector<Column> columns(const Scenario& scenario) const override {
        const Settings settings = settings_of(scenario);
        return with_errors(world_.columns(settings, scenario), scenario.components, scenario.poses - 1,
                           settings.budget);
    }
    std::vector<DrawSource> sources(const Scenario& scenario) const override {
        return world_.sources(settings_of(scenario));
    }
    std::vector<Series> all_series(const Scenario& scenario) const override {
        return world_.all_series(settings_of(scenario), scenario);
    }
    std::unique_ptr<const Simulation> simulation(const Scenario& scenario) const override {
        return world_.simulation(settings_of(scenario), scenario);
    }

    /// Throws InputError where they contradict each other.
    Scenario scenario_of(const Settings& settings) const {
        const Settings resolved = world_.resolved(settings);
        Scenario scenario{name(), resolved.name, resolved.title, resolved.length_unit, resolved.poses, {}, {}, {}, {},
                          {}};
        if (name() != first_world) scenario.settings.push_back({world_key, name()});
        const Settings defaults = world_.defaults();
        for (const KeyOf<Settings>& key : world_.keys()) {
            const std::string value = key.get(resolved);
            if (key.hidden && value == key.get(defaults)) continue;
            scenario.settings.push_back({key.name, value, key.later && value == key.get(defaults)});
        }
        if constexpr (requires { resolved.planner.own; })
            for (const auto& [key, value] : resolved.planner.own) scenario.settings.push_back({key, value, false});
        world_.describe(resolved, scenario);
        scenario.baselines = baselines_among(scenario.arms);
        scenario.own_settings = std::make_shared<const Settings>(resolved);
        return scenario;
    }

    /// Throws InputError where the scenario's settings are not those of this world.
    Settings settings_of(const Scenario& scenario) const {
        if (scenario.own_settings && scenario.world == name())
            return *static_cast<const Settings*>(scenario.own_settings.get());
        Settings settings;
        for (const Setting& setting : scenario.settings)
            if (setting.key != world_key) set(settings, setting.key, setting.value);
        return world_.resolved(std::move(settings));
    }

private:
    void set(Settings& settings, const std::string& key, const std::string& value) const {
        if constexpr (requires { settings.planner.own; })
            if (is_planner_key(key)) {
                settings.planner.own[key] = planner_value(key, trimmed(value));
                return;
            }
        set_key(world_.keys(), settings, key, value);
    }

    class DraftOf : public Draft {
    public:
        explicit DraftOf(const WorldOf& world) : world_(world) {}
        void set(const std::string& key, const std::string& value) override {
            world_.set(settings_, key, value);
        }
        Scenario declare() const override { return world_.scenario_of(settings_); }

    private:
        const WorldOf& world_;
        Settings settings_;
    };

    T world_;
};

}  // namespace credence
