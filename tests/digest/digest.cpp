// A digest of a small study: one line of 64 bits for each world and arm, from the modules base to worlds only. Every
// compiler, optimisation, lane width, instruction set and processor must print the lines of expected.txt.
//   credence_digest [TARGET...]    the targets to run (default: all that this processor runs); they must agree

#include <algorithm>
#include <bit>
#include "worlds/deformable/deformable.hpp"
#include <credence/error.hpp>
#include "worlds/explore/explore.hpp"
#include "worlds/deformable/keys.hpp"
#include <credence/text.hpp>
#include <cstdio>
#include <exception>

#include "worlds.hpp"

namespace credence {

// The lane widths without an instruction set of their own: Lane<W> as compiled for any processor.
#ifdef CREDENCE_DIGEST_WIDTHS
CREDENCE_DECLARE_TARGET(w2)
CREDENCE_DECLARE_TARGET(w4)
CREDENCE_DECLARE_TARGET(w8)
#endif

namespace digest {
namespace {

// A block far from the first one, so that the upper half of the trial's number is in the keys of the draws; its last
// octet is not full.
constexpr std::uint64_t root_seed = 0x9e3779b97f4a7c15u;
constexpr std::int64_t block_index = 20'000'003;
constexpr int trials = 37;
// Of the first block, whose trials are detailed.
constexpr int detailed_count = 11;

/// FNV-1a over the bytes of 64-bit words, lowest byte first on any processor.
class Digest {
public:
    void add(std::uint64_t word) {
        for (int byte = 0; byte < 8; ++byte) state_ = (state_ ^ (word >> 8 * byte & 0xff)) * 0x100000001b3u;
    }
    /// All NaNs are one: their sign and payload are the processor's taste (x86 makes negative ones, ARM positive ones),
    /// and the results file has one NaN as well.
    void add(double value) {
        add(value == value ? std::bit_cast<std::uint64_t>(value) : std::uint64_t{0x7ff8000000000000u});
    }
    template <class Number>
    void add(const std::vector<Number>& values) {
        add(std::uint64_t{values.size()});
        for (const Number value : values) add(static_cast<double>(value));
    }
    std::uint64_t value() const { return state_; }

private:
    std::uint64_t state_ = 0xcbf29ce484222325u;
};

std::vector<Target> all_units() {
    std::vector<Target> targets = runnable_targets();
#ifdef CREDENCE_DIGEST_WIDTHS
    targets.push_back(CREDENCE_LIST_TARGET(w2, 2));
    targets.push_back(CREDENCE_LIST_TARGET(w4, 4));
    targets.push_back(CREDENCE_LIST_TARGET(w8, 8));
#endif
    return targets;
}

std::vector<Target> asked_units(const std::vector<std::string>& names) {
    const std::vector<Target> all = all_units();
    if (names.empty()) return all;
    std::vector<Target> asked;
    for (const std::string& name : names) {
        const auto found =
            std::find_if(all.begin(), all.end(), [&](const Target& target) { return target.name == name; });
        if (found == all.end()) throw InputError("no unit " + name + " that this processor runs.");
        asked.push_back(*found);
    }
    return asked;
}

std::vector<World> all_worlds() {
    std::vector<World> worlds = seed_worlds();
    for (const auto& more : {graph_worlds(), noise_worlds(), arm_worlds(), disturbed_worlds(), fragile_worlds()})
        worlds.insert(worlds.end(), more.begin(), more.end());
    return worlds;
}

DeformableSettings settings_of(const World& world) {
    DeformableSettings scenario;
    scenario.name = world.name;
    set_key(scenario, "scenario.poses", short_poses);
    for (const auto& [key, value] : world.settings) set_key(scenario, key, value);
    scenario = resolved(scenario);
    validate(scenario);
    return scenario;
}

/// The lines of one scenario, an arm each. `simulation(unit)` runs it on a target.
template <class SimulationOn>
std::vector<std::string> lines(const Scenario& scenario, const SimulationOn& simulation, const Target& target) {
    const auto on_target = simulation(target);
    const std::vector<Column> columns = world_of(scenario).columns(scenario);
    const std::size_t arms = scenario.arms.size();
    const Block block = run_block(on_target, columns, arms, root_seed, block_index, trials);
    const Block details = run_block(on_target, columns, arms, root_seed, 0, detailed_count);
    std::vector<std::string> lines;
    for (std::size_t a = 0; a < arms; ++a) {
        const ArmBlock& arm = block.arms[a];
        Digest digest;
        for (const auto* values : {&arm.columns, &arm.sums, &arm.square_sums, &arm.run_square_sums})
            digest.add(*values);
        digest.add(arm.covered);
        digest.add(arm.cells);
        const ArmBlock& detail = details.arms[a];
        digest.add(detail.errors);
        digest.add(detail.nees);
        for (const auto* values : {&detail.product_sums, &detail.product_square_sums, &detail.product_counts})
            digest.add(*values);
        char text[100];
        std::snprintf(text, sizeof text, " %d %016llx", arm.counted, static_cast<unsigned long long>(digest.value()));
        lines.push_back(scenario.name + " " + scenario.arms[a] + text);
    }
    return lines;
}

/// Prints every line of a scenario from the first target, and on the error stream those from another target that
/// differ.
/// otherwise.
template <class SimulationOn>
bool agree_on(const std::vector<Target>& targets, const Scenario& scenario, const SimulationOn& simulation) {
    bool agree = true;
    const std::vector<std::string> first = lines(scenario, simulation, targets.front());
    std::printf("%s\n", joined(first, "\n").c_str());
    for (std::size_t u = 1; u < targets.size(); ++u) {
        const std::vector<std::string> other = lines(scenario, simulation, targets[u]);
        for (std::size_t a = 0; a < first.size(); ++a) {
            if (other[a] == first[a]) continue;
            std::fprintf(stderr, "%s has %s\n", targets[u].name.c_str(), other[a].c_str());
            agree = false;
        }
    }
    return agree;
}

bool all_agree(const std::vector<Target>& targets) {
    bool agree = true;
    for (const World& world : all_worlds()) {
        const Problem problem(settings_of(world));
        const auto simulation = [&](const Target& target) { return DeformableSimulation(problem, target); };
        agree = agree_on(targets, scenario_of(problem.scenario()), simulation) && agree;
    }
    for (const ExploreSettings& settings : {small_loop(), small_rooms()}) {
        const auto simulation = [&](const Target& target) { return ExploreSimulation(settings, target); };
        agree = agree_on(targets, scenario_of(settings), simulation) && agree;
    }
    return agree;
}

int run(const std::vector<std::string>& names) {
    const std::vector<Target> targets = asked_units(names);
    const bool agree = all_agree(targets);
    std::fprintf(stderr, "units:");
    for (const Target& target : targets) std::fprintf(stderr, " %s", target.name.c_str());
    std::fprintf(stderr, agree ? "\n" : " (they do not agree)\n");
    return agree ? 0 : 1;
}

}  // namespace
}  // namespace digest
}  // namespace credence

int main(int argc, char** argv) {
    try {
        return credence::digest::run(std::vector<std::string>(argv + 1, argv + argc));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "credence_digest: %s\n", error.what());
        return 2;
    }
}
