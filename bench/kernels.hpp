#pragma once
// Parts of the engine by themselves, compiled once for each instruction set like the engine's targets.

#include "slam/trial/problem.hpp"
#include <cstdint>
#include <string>
#include <vector>

namespace credence::bench {

/// Each function returns a number that depends on all that it computed.
struct Kernels {
    const char* target = "";
    int lanes = 1;
    int chains = 1;                                    ///< independent chains of fused multiply-adds
    bool hardware_fma = false;                         ///< else an fma is a library call, and its rate not a peak
    double (*normals)(std::int64_t rounds) = nullptr;  ///< 2 `lanes` standard-normal draws each
    /// Predict, update and evaluate on a pack of `lanes` trials each; heading model, M = 3, every feature in sight.
    double (*filter_steps)(const ProblemView& problem, std::int64_t steps) = nullptr;
    double (*multiply_adds)(std::int64_t rounds) = nullptr;  ///< `chains` * `lanes` fused multiply-adds each
};

/// The kernels that this processor can run, the best first.
std::vector<Kernels> runnable_kernels();

}  // namespace credence::bench
