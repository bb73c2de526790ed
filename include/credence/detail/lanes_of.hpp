#pragma once
// Module worlds: the objects of a program that run a user's own world in lanes, one for each target, and how the
// program finds those that it has. credence_add_world compiles each with CREDENCE_TARGET_OBJECT, CREDENCE_TARGET and
// CREDENCE_LANES, and the program with CREDENCE_HAS_TARGET_OBJECTS.

#include <credence/detail/own_simulation.hpp>

#include <memory>
#include <vector>

namespace credence {

/// Whether the program has a world's objects, so that nothing else of it need be compiled.
template <class World>
inline constexpr bool only_in_lanes = false;

}  // namespace credence

#ifdef CREDENCE_TARGET_OBJECT

#define CREDENCE_JOINED(a, b) a##b
#define CREDENCE_BOUND(side, target) CREDENCE_JOINED(side##credence_init_, target)
/// Bounds that the linker gives the section of the object's initialisers; null where it has none.
extern "C" {
[[gnu::weak]] extern void (*CREDENCE_BOUND(__start_, CREDENCE_TARGET)[])();
[[gnu::weak]] extern void (*CREDENCE_BOUND(__stop_, CREDENCE_TARGET)[])();
}

namespace credence {
inline namespace CREDENCE_TARGET {

/// Initialises the variables of the headers in this object, which happens only once its target is chosen.
inline void initialise_object() {
    static const bool once = [] {
        void (**const end)() = CREDENCE_BOUND(__stop_, CREDENCE_TARGET);
        for (void (**next)() = CREDENCE_BOUND(__start_, CREDENCE_TARGET); next != end; ++next) (*next)();
        return true;
    }();
    static_cast<void>(once);
}

/// How this object runs a world. Its explicit instantiations are the only symbols of the object that others see.
template <class World>
RunPack lanes_of() {
    initialise_object();
    return [](const void* settings, LanePack& pack) {
        OwnTrialOf<Lane<CREDENCE_LANES>> trial(pack);
        World::run(*static_cast<const typename World::Settings*>(settings), trial);
    };
}

}  // namespace CREDENCE_TARGET
}  // namespace credence

#define CREDENCE_WORLD(World)                                   \
    static_assert(credence::meets_the_world_contract<World>()); \
    template credence::RunPack credence::CREDENCE_TARGET::lanes_of<World>()

#else

namespace credence {

// Weak: a program that was built without an object for a target has a null pointer in its place.
namespace v4 {
template <class World>
[[gnu::weak]] RunPack lanes_of();
}
namespace v3 {
template <class World>
[[gnu::weak]] RunPack lanes_of();
}
inline namespace portable {
template <class World>
[[gnu::weak]] RunPack lanes_of();
}

/// How a world runs in one target; `run` is null where the program has no object for it.
struct LanesOfTarget {
    const char* target;
    RunPack (*run)();
};

template <class World>
std::vector<LanesOfTarget> linked_lanes() {
    return {{"v4", v4::lanes_of<World>}, {"v3", v3::lanes_of<World>}, {"portable", portable::lanes_of<World>}};
}

/// Trials in the lanes of the target that best_target() gives, or nullptr where the program has no object for it.
std::unique_ptr<const Simulation> lane_simulation(const Scenario& scenario, const OwnReport& report,
                                                  const std::vector<LanesOfTarget>& targets,
                                                  std::shared_ptr<const void> settings);

}  // namespace credence

#ifdef CREDENCE_HAS_TARGET_OBJECTS
#define CREDENCE_WORLD(World) \
    template <>               \
    inline constexpr bool credence::only_in_lanes<World> = true
#else
#define CREDENCE_WORLD(World) static_assert(true)
#endif

#endif
