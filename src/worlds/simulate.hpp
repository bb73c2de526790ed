#pragma once
// The interface between the engine and its targets: the same source, compiled once for each instruction set.

#include <credence/detail/batch.hpp>
#include "slam/trial/problem.hpp"

#include <cstddef>
#include <string>

namespace credence {

// What the targets of the other worlds do not read: worlds/own/lanes/view.hpp, worlds/explore/problem.hpp.
struct OwnView;
struct ExploreView;
struct ExploreArm;

/// Simulates a batch of an arm. The same bits from every target.
using SimulateFunction = void (*)(const ProblemView&, const Arm&, const Batch&);

/// A target by name: v4 (AVX-512), v3 (AVX2 and FMA) or portable; with the number of trials it runs at once.
struct Target {
    std::string name;
    int lanes = 1;
    SimulateFunction simulate = nullptr;
    std::size_t (*workspace_size)(const ProblemView&, const Arm&) = nullptr;
    void (*simulate_explore)(const ExploreView&, const ExploreArm&, const Batch&) = nullptr;
    std::size_t (*explore_workspace_size)(const ExploreView&, const ExploreArm&) = nullptr;
    void (*simulate_own)(const OwnView&, const Batch&) = nullptr;
    std::size_t (*own_workspace_size)(const OwnView&) = nullptr;
};

/// What a target compiled from the sources target.cpp of src/worlds offers under its name, and its entry in a list of
/// targets.
#define CREDENCE_DECLARE_TARGET(name)                    \
    namespace name {                                   \
    void simulate(const ProblemView&, const Arm&, const Batch&); \
    std::size_t workspace_size(const ProblemView&, const Arm&); \
    void simulate_explore(const ExploreView&, const ExploreArm&, const Batch&); \
    std::size_t explore_workspace_size(const ExploreView&, const ExploreArm&); \
    void simulate_own(const OwnView&, const Batch&); \
    std::size_t own_workspace_size(const OwnView&); \
    }
#define CREDENCE_LIST_TARGET(name, lanes) \
    Target{#name, lanes, name::simulate, name::workspace_size, name::simulate_explore, \
           name::explore_workspace_size, name::simulate_own, name::own_workspace_size}

/// Environment variable that names the target to run, for tests.
inline constexpr const char* force_target_variable = "CREDENCE_FORCE_TARGET";

/// Every target that was built and that this processor can run, the best one first.
std::vector<Target> runnable_targets();

/// The target that runs where none is named: the first runnable one, or the one that CREDENCE_FORCE_TARGET names.
/// Throws InputError where that is not one of runnable_targets; programs that compute call this before anything else.
Target best_target();

}  // namespace credence
