#pragma once
// What the trials of a user's own world in lanes read, in every target of the engine.

#include <credence/detail/lane_pack.hpp>
#include "slam/trial/problem.hpp"

#include <cstddef>
#include <string>

namespace credence {

class LaneRecorder;

/// A component group's place in the state.
struct GroupPlace {
    int first = 0, count = 0;
    const int* components = nullptr;  ///< [count] where they are not contiguous and in order; else null
};

/// A scenario of a user's own world. Of the CommonView, what the folding of series reads is filled in.
struct OwnView : CommonView {
    const std::string *world = nullptr, *arm_name = nullptr;
    std::size_t arm = 0;
    int largest_innovation = 0;              ///< m
    int column_count = 0, own_column_count = 0;
    const char* whole = nullptr;             ///< [own_column_count] whether the column is of whole numbers
    const GroupPlace* groups = nullptr;      ///< [group_count]
    int nis = 0, squared_error = 0, variance = 0, standardised_error = 0;  ///< where each kind of series begins
    /// Whether a matrix [n, n] whose pivots leave it open is positive definite. The answer of one trial at a time.
    bool (*positive_definite)(const double* matrix, int n) = nullptr;
    /// Runs the world's function on a pack; it comes back too where all of the pack's trials have failed.
    void (*run)(const OwnView& view, LanePack& pack) = nullptr;
    const void* settings = nullptr;
    RunPack run_world = nullptr;
    /// Of a trial that is run again, in lane 0: `record` receives each of its steps [LaneRecorder].
    void (*record)(LaneRecorder& recorder, const LanePack& pack, const LaneStep& step, bool goes_on) = nullptr;
    LaneRecorder* recorder = nullptr;
    CountedTrial* counted = nullptr;  ///< likewise, where it is asked what P counts
    void (*count)(const LanePack& pack, int source, const double* variances, int stride) = nullptr;
};

}  // namespace credence
