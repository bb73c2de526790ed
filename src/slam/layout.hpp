#pragma once
// The indices of the state's components. x = [theta, r_x, r_y, f_1x, f_1y, ...] (heading model) or the same without
// theta (translation model) [docs/model.md, Two process models].

#include <credence/detail/each.hpp>
#include <credence/detail/deformable_settings.hpp>

namespace credence {

inline constexpr int any_count = 0;

/// Layout of a state with a number of features that is known at compile time, or with any number up to 64
/// (`any_count`). Sizes and indices are `Known` where they can be.
template <Process process, int compiled_features>
struct Layout {
    static constexpr bool has_heading = process == Process::heading;
    static constexpr bool written_out = compiled_features != any_count;  ///< whether loops over features are unrolled
    /// In the translation model P = P_1 (x) I_2: both axes have the same covariances, and none with each other. Where
    /// the loops are written out one axis is computed; the bits are those of computing both.
    static constexpr bool by_axis = !has_heading && written_out;
    static constexpr Known<0> heading{};
    static constexpr Known<has_heading ? 1 : 0> position{};
    static constexpr Known<position + 2> pose_size{};
    static constexpr int feature_capacity = compiled_features == any_count ? largest_feature_count : compiled_features;
    static constexpr int capacity = pose_size + 2 * feature_capacity;

    /// Index of feature j's first component.
    template <int j>
    static constexpr Known<pose_size + 2 * j> feature(Known<j>) { return {}; }
    static constexpr int feature(int j) { return pose_size + 2 * j; }

    constexpr explicit Layout(int features) : features_(features) {}
    /// M
    constexpr auto features() const {
        if constexpr (compiled_features == any_count)
            return features_;
        else
            return Known<compiled_features>{};
    }
    /// n
    constexpr auto size() const { return feature(features()); }

    /// Component groups that are evaluated by themselves, numbered in the order of state_groups (slam_columns.hpp).
    static constexpr Known<0> group_all{};
    static constexpr Known<1> group_pose{};
    static constexpr Known<2> group_heading{};   ///< heading model only
    static constexpr Known<3> group_position{};  ///< heading model only
    static constexpr Known<has_heading ? 4 : 2> group_features{};
    template <int j>
    static constexpr Known<group_features + 1 + j> group_feature(Known<j>) { return {}; }
    static constexpr int group_feature(int j) { return group_features + 1 + j; }
    static constexpr int largest_group_count = group_features + 1 + feature_capacity;
    constexpr auto group_count() const { return group_feature(features()); }

private:
    int features_;
};

}  // namespace credence
