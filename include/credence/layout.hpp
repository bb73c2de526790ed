#pragma once
// Room 3: where the state's parts lie. x = [theta, r_x, r_y, f_1x, f_1y, ...] (heading model) or the same without theta
// (translation model) [model.md, Two process models].

#include <credence/scenario.hpp>

namespace credence {

inline constexpr int any_count = 0;

/// Layout of a state with a number of features known to the compiler, or any number up to 64 (`any_count`).
template <Process process, int compiled_features>
struct Layout {
    static constexpr bool has_heading = process == Process::heading;
    static constexpr int heading = 0;
    static constexpr int position = has_heading ? 1 : 0;
    static constexpr int pose_size = position + 2;
    static constexpr int feature_capacity = compiled_features == any_count ? largest_feature_count : compiled_features;
    static constexpr int capacity = pose_size + 2 * feature_capacity;

    /// Index of feature j's first component.
    static constexpr int feature(int j) { return pose_size + 2 * j; }

    constexpr explicit Layout(int features) : features_(features) {}
    /// M
    constexpr int features() const { return compiled_features == any_count ? features_ : compiled_features; }
    /// n
    constexpr int size() const { return pose_size + 2 * features(); }

private:
    int features_;
};

}  // namespace credence
