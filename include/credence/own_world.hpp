#pragma once
// Module worlds: the world contract: what a type provides so that its trials run through the engine, and are judged,
// stored, reported and compared like those of the worlds that are here already. experiments/own_filter is an example.
//
// A world is a type W with
//
//   struct W::Settings { ... };
//       a plain struct with its defaults: the scenario's settings, copyable. `poses` and what a scenario is called are
//       not among them: every world has scenario.name, scenario.title, scenario.length_unit and scenario.poses.
//   static constexpr const char* W::name
//       letters, digits, _ and -: what `scenario.world` says in a scenario file.
//   static void W::keys(OwnKeys<Settings>&)
//       the keys of the scenario file, see OwnKeys: `section.key`, in any section but sweep and published.
//   static std::vector<Component> W::components(const Settings&)
//       name and unit of each component of the state, [n], n up to 1000. Names and units have no blanks.
//   static std::vector<ComponentGroup> W::groups(const Settings&)
//       groups of components that are judged by themselves, such as {"position", 0, 2}; the whole is judged anyway.
//   static std::vector<std::string> W::arms(const Settings&)
//       the filters that every trial runs under, with the same draws.
//   static int W::innovation_rows(const Settings&)
//       m, the most rows of an innovation, up to 2000; 0 where trials give none.
//   static void W::run(const Settings&, OwnTrial& trial)
//       one trial under trial.arm(): the truth, the measurements, the filter; trial.step(...) after each step. All
//       randomness comes from trial.normal and trial.uniform; the same key is the same draw under every arm.
//   or template <class Real> static void W::run(const Settings&, OwnTrialOf<Real>& trial)
//       the same for several trials at once, see own_trial.hpp.
// and, if it has use for them,
//   static std::vector<Column> W::columns(const Settings&)        columns of its own, set by trial.set; a trial that
//       sets one of the type integer to anything else than a whole number of 32 bits has failed
//   static void W::validate(const Settings&)                      throws InputError where settings contradict each
//   other
//   static constexpr const char* W::sources[]                     the names of the sources 0, 1 ... (up to 15) that its
//   trials draw from, for `credence budget`; what of P they count, run may say by trial.counts [CountedCovariance]
//
// run is called from several threads at once and must not keep anything from call to call, read clocks or files, or
// draw from anywhere else: a block of trials is a pure function of scenario, root seed and index. Trial 0 runs twice
// when a study begins, and is refused where it does not repeat itself. Its series are the same bits on one machine for
// any number of threads; over machines they are so where its own arithmetic is. What run throws ends the study, with
// what is committed kept; the message names the trial.

#include <credence/detail/lanes_of.hpp>
#include <credence/detail/own_simulation.hpp>
#include <credence/detail/world_of.hpp>
#include <credence/error.hpp>
#include <credence/detail/own_keys.hpp>
#include <credence/own_trial.hpp>

#include <concepts>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace credence {

/// Whether W's trials can run in lanes: its run is a template on the scalar.
template <class W>
concept RunsInLanes = requires(const typename W::Settings settings, OwnTrialOf<double>& trial) {
    W::template run<double>(settings, trial);
};

/// Whether W provides what is written above; where not, the compiler says what is missing.
template <class W>
constexpr bool meets_the_world_contract() {
    static_assert(requires { typename W::Settings; }, "a world has a type Settings");
    using Settings = typename W::Settings;
    static_assert(std::default_initializable<Settings> && std::copyable<Settings>,
                  "a world's Settings have defaults and can be copied");
    static_assert(requires { { W::name } -> std::convertible_to<std::string>; }, "a world has a static name");
    static_assert(requires(OwnKeys<Settings> keys) { W::keys(keys); }, "a world has static keys(OwnKeys<Settings>&)");
    static_assert(requires(const Settings s) { { W::components(s) } -> std::same_as<std::vector<Component>>; },
                  "a world has static components(const Settings&), a vector of Component");
    static_assert(requires(const Settings s) { { W::groups(s) } -> std::same_as<std::vector<ComponentGroup>>; },
                  "a world has static groups(const Settings&), a vector of ComponentGroup");
    static_assert(requires(const Settings s) { { W::arms(s) } -> std::same_as<std::vector<std::string>>; },
                  "a world has static arms(const Settings&), a vector of names");
    static_assert(requires(const Settings s) { { W::innovation_rows(s) } -> std::convertible_to<int>; },
                  "a world has static innovation_rows(const Settings&), a number");
    static_assert(RunsInLanes<W> || requires(const Settings s, OwnTrial& trial) { W::run(s, trial); },
                  "a world has static run(const Settings&, OwnTrial&), or as a template run(const Settings&, "
                  "OwnTrialOf<Real>&)");
    static_assert(!requires { W::keys(OwnKeys<Settings>()); },
                  "a world's keys(OwnKeys<Settings>&) adds to the list that it is given, not to a copy");
    static_assert(!requires(Settings s) { W::columns(s); } || requires(const Settings s) {
                      { W::columns(s) } -> std::same_as<std::vector<Column>>;
                  }, "a world's columns(const Settings&) takes settings that are const, and gives a vector of Column");
    static_assert(!requires(Settings s) { W::validate(s); } || requires(const Settings s) { W::validate(s); },
                  "a world's validate(const Settings&) takes settings that are const");
    return true;
}

/// A user's own world as WorldOf takes it.
template <class W>
class OwnWorld {
    static_assert(meets_the_world_contract<W>());

public:
    using Settings = OwnSettings<typename W::Settings>;

    OwnWorld() {
        if (!sources().empty()) keys_.budget(sources());
        W::keys(keys_);
    }

    std::string name() const { return W::name; }
    const std::vector<KeyOf<Settings>>& keys() const { return keys_.list(); }
    Settings defaults() const { return {}; }
    Settings resolved(const Settings& settings) const {
        if constexpr (requires { W::validate(settings.own); }) W::validate(settings.own);
        return settings;
    }
    void describe(const Settings& settings, Scenario& scenario) const {
        scenario.components = W::components(settings.own);
        scenario.groups = {{"all", 0, static_cast<int>(scenario.components.size())}};
        for (ComponentGroup& group : W::groups(settings.own)) scenario.groups.push_back(std::move(group));
        scenario.arms = W::arms(settings.own);
        check_declared(scenario, report_of(settings.own));
        Settings read_back;  // a default that its own key refuses would make files that no one can read
        for (const KeyOf<Settings>& key : keys_.list()) key.set(read_back, key.get(settings));
    }
    std::vector<DrawSource> sources(const Settings& = {}) const {
        if constexpr (requires { W::sources; })
            return own_sources({std::begin(W::sources), std::end(W::sources)});
        else
            return {};
    }
    std::vector<Column> columns(const Settings& settings, const Scenario& scenario) const {
        return own_columns(scenario, report_of(settings.own));
    }
    std::vector<Series> all_series(const Settings& settings, const Scenario& scenario) const {
        return own_series(scenario, report_of(settings.own));
    }
    std::unique_ptr<const Simulation> simulation(const Settings& settings, const Scenario& scenario) const {
        OwnReport report = report_of(settings.own);
        report.budget = settings.budget;
        for (DrawSource& source : sources()) report.sources.push_back(std::move(source.name));
        if constexpr (RunsInLanes<W>) {
#ifndef CREDENCE_TARGET_OBJECT
            if (auto in_lanes = lane_simulation(scenario, report, linked_lanes<W>(),
                                                std::make_shared<const typename W::Settings>(settings.own)))
                return in_lanes;
#endif
        }
        if constexpr (only_in_lanes<W>)
            throw std::logic_error("world " + name() + ": credence_add_world was not given its header");
        else
            return own_simulation(scenario, report, [own = settings.own](OwnTrial& trial) { run_one(own, trial); });
    }

private:
    static void run_one(const typename W::Settings& settings, OwnTrial& trial) {
        if constexpr (RunsInLanes<W>) {
            OwnTrialOf<double> one(trial);
            W::run(settings, one);
        } else {
            W::run(settings, trial);
        }
    }

    static OwnReport report_of(const typename W::Settings& settings) {
        OwnReport report{{}, W::innovation_rows(settings)};
        if constexpr (requires { W::columns(settings); }) report.columns = W::columns(settings);
        return report;
    }

    OwnKeys<typename W::Settings> keys_;
};

/// Adds W to the worlds that there are: in main, before anything else.
template <class W>
void add_own_world() {
    add_world(std::make_unique<WorldOf<OwnWorld<W>>>());
}

}  // namespace credence
