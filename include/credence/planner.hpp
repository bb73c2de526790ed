#pragma once
// Module worlds: planners of one's own: they choose the controls of arms beside those of the built-in controllers, in
// the worlds `deformable` and `explore` [docs/planner.md]. experiments/planner has one in C++ and one in Python.
//
// A planner by a cost, least among the candidates that no wall forbids, is a type P with
//
//   static constexpr const char* P::name
//       letters, digits, _ and -: what `arms.planners` says in a scenario file, and the first part of its arms' names.
//   struct P::Settings { ... };  static void P::keys(OwnKeys<Settings>&)
//       a plain struct with its defaults, and the keys `planner.NAME.key` of the scenario file, see OwnKeys.
//   static double P::cost(const Settings&, const PlannerBelief& now, const Prospect& then)
//       of one candidate. It is called from several threads at once, and depends on nothing but its arguments.
//
// and `CREDENCE_PLANNER(P);` in one source of a program of one's own, whose main calls credence::program. Any other
// planner derives from Planner.

#include <credence/detail/own_keys.hpp>
#include <credence/detail/planner_batch.hpp>

#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace credence {

/// The planner of a cost.
template <class P>
class CostPlanner : public Planner {
    using Settings = typename P::Settings;
    using All = OwnSettings<Settings>;

public:
    explicit CostPlanner(const Settings& settings = {}) : settings_(settings) {}

    void choose(const PlannerBatch& batch) const override {
        struct Least : ProspectVisitor {
            const Settings& settings;
            const PlannerBatch& batch;
            double least[64];
            Least(const Settings& of, const PlannerBatch& all) : settings(of), batch(all) {
                for (int b = 0; b < batch.trials; ++b) {
                    least[b] = std::numeric_limits<double>::infinity();
                    batch.control[b] = {};  // the robot stays where every candidate is forbidden
                }
            }
            void visit(int b, int, bool allowed, const Prospect& then) override {
                if (!allowed) return;
                const double cost = P::cost(settings, batch.belief(b), then);
                if (cost <= least[b]) batch.control[b] = then.control, least[b] = cost;
            }
        } visitor(settings_, batch);
        batch.visit_prospects(visitor);
    }
    std::vector<PlannerKey> keys() const override {
        std::vector<PlannerKey> all;
        for (const KeyOf<All>& key : own_keys())
            all.push_back({key.name, [key](const std::string& value) {
                               All settings;
                               key.set(settings, value);
                               return key.get(settings);
                           }});
        return all;
    }
    std::shared_ptr<const Planner> with(const std::map<std::string, std::string>& values) const override {
        All settings;
        settings.own = settings_;
        for (const KeyOf<All>& key : own_keys())
            if (const auto found = values.find(key.name); found != values.end()) key.set(settings, found->second);
        return std::make_shared<CostPlanner>(settings.own);
    }

private:
    static std::vector<KeyOf<All>> own_keys() {
        OwnKeys<Settings> keys;
        if constexpr (requires { P::keys(keys); }) P::keys(keys);
        return {keys.list().begin() + static_cast<std::ptrdiff_t>(basic_keys().size()), keys.list().end()};
    }

    Settings settings_;
};

}  // namespace credence

/// Adds the planner of a cost to those of the program.
#define CREDENCE_PLANNER(Type) \
    static const bool credence_has_##Type = \
        (credence::add_planner(Type::name, std::make_shared<credence::CostPlanner<Type>>()), true)
