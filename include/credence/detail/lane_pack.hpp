#pragma once
// Module worlds: a pack of trials of a user's own world, as the engine and the world's function share it. They are
// compiled apart, for one target of several, so what they share is numbers and pointers to functions.
//
//   n  components of the state, m  rows of an innovation; numbers of each lane are adjacent: [..., lanes]

#include <cstddef>
#include <cstdint>
#include <string>

namespace credence {

/// What the filters say after a step. Matrices are stored by columns; of P and S the lower triangles are read.
struct LaneStep {
    const double* error = nullptr;       ///< [n, lanes]
    const double* P = nullptr;           ///< [n, n, lanes]
    int rows = 0;                        ///< of the innovation
    const double* innovation = nullptr;  ///< [rows, lanes], NaN where not observed
    const double* S = nullptr;           ///< [rows, rows, lanes]
};

/// What P counts for each source in one trial.
class CountedTrial;

/// Several trials under one arm, and what the engine does for them in the same target.
struct LanePack {
    const std::string *world = nullptr, *arm_name = nullptr;
    std::size_t arm = 0;
    std::int64_t first_trial = 0;  ///< that of lane 0
    int trials = 0;                ///< that the pack has, in its first lanes
    int poses = 0, state_size = 0, largest_innovation = 0;
    std::size_t own_column_count = 0;
    double* own_columns = nullptr;  ///< [own_column_count, lanes]
    int steps = 0;                  ///< taken so far
    const double* all_series = nullptr;  ///< [series, K - 1, lanes], those of the steps taken
    void (*normal)(const LanePack&, int source, int pose, int index, double* draw) = nullptr;   ///< draw [2, lanes]
    void (*uniform)(const LanePack&, int source, int pose, int index, double* draw) = nullptr;  ///< draw [lanes]
    /// Evaluates a step. False where every trial of the pack has failed.
    bool (*step)(LanePack&, const LaneStep&) = nullptr;
    CountedTrial* counted = nullptr;  ///< of the trial in lane 0, where it is asked for
    /// Takes in the diagonal of a P_s, or of the whole of P at the end of a step: n numbers, one each `stride`.
    void (*count)(const LanePack&, int source, const double* variances, int stride) = nullptr;
};

/// A user's world in one target: it runs a pack, of as many trials as the target has lanes.
using RunPack = void (*)(const void* settings, LanePack& pack);

/// Throws std::logic_error that says what the world did wrong.
[[noreturn]] void refuse(const LanePack& pack, const char* what);
/// Leaves the world's function, once every trial of the pack has failed.
[[noreturn]] void leave(const LanePack& pack);
inline constexpr int whole_of_P = -1;
/// The index of a draw as a key has it. Two keys that the counter could not tell apart would be one draw; they end the
/// run with std::logic_error.
int rare_index(const std::string& world, int source, int pose, int index);
/// The same, at once for the usual keys. (Inline everywhere: no target may share a function with another one.)
[[gnu::always_inline]] inline int key_index(const std::string& world, int source, int pose, int index) {
    const bool usual = ((source & ~15) | (index & ~0xffff)) == 0 && pose >= 0;
    return usual ? index : rare_index(world, source, pose, index);
}

}  // namespace credence
