#pragma once
// All draws of a trial at one pose, computed together: the steps of one draw depend on each other, and those of several
// overlap in the processor.

#include <credence/detail/draws.hpp>
#include "slam/layout.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// The index of a source among others; not a constant expression for a source that is not listed.
template <Source... others>
constexpr int place_among(Source source) {
    constexpr Source listed[]{others...};
    int place = 0;
    while (listed[place] != source) ++place;
    return place;
}

/// The standard-normal pairs of one pose: one of each of `feature_sources` for every feature, and the robot's.
template <class Layout, class Real, Source... feature_sources>
class PoseDraws {
public:
    explicit PoseDraws(const Layout& layout) : layout_(layout) {}

    /// Draws the pairs of pose k, whether or not the trial uses them.
    template <class Noise>
    CREDENCE_INLINE void draw(const Noise& noise, int k) {
        DrawKey keys[capacity];
        DrawKey* next = keys;
        for (const Source source : sources)
            each(zero, layout_.features(), [&](auto j) { *next++ = {source, pose_of(source, k), j}; });
        *next++ = {Source::odometry_position, k, 0};
        if constexpr (Layout::has_heading) *next = {Source::odometry_heading, k, 0};
        draw_all(noise, keys, robot() + robot_draws, draws_);
    }

    /// The pairs of one source. [M]
    template <Source source>
    const Vector2<Real>* of_features() const {
        return draws_ + layout_.features() * Known<place_among<feature_sources...>(source)>{};
    }
    template <Source source>
    Vector2<Real>* of_features() {
        return draws_ + layout_.features() * Known<place_among<feature_sources...>(source)>{};
    }
    const Vector2<Real>& position() const { return draws_[robot()]; }
    const Real& heading() const { return draws_[robot() + one].x; }  ///< heading model only

private:
    static constexpr Source sources[]{feature_sources...};
    static constexpr Known<sizeof...(feature_sources)> source_count{};
    static constexpr Known<Layout::has_heading ? 2 : 1> robot_draws{};
    static constexpr int capacity = source_count * Layout::feature_capacity + robot_draws;

    /// The walk to a pose is drawn on leaving the pose before; pose 0 does not use its own draw [docs/model.md, Truth].
    static constexpr int pose_of(Source source, int k) { return source == Source::walk && k > 0 ? k - 1 : k; }

    /// Index of the robot's first draw: after the features'.
    auto robot() const { return layout_.features() * source_count; }

    Layout layout_;
    Vector2<Real> draws_[capacity];
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
