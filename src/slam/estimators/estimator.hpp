#pragma once
// What an estimator is, and the one that most are compared with.
//
// An estimator is a class template E<Layout, Real> that a trial carries in its workspace. It holds what it must remember
// from pose to pose beside the belief, and provides:
//
//   void start(const Layout&, const Belief&, const Truth&)
//       at pose 0, with the belief as initialised: sets everything that is remembered.
//   void predict(Belief&, const FilterParameters&, const Layout&, const Command<Real>&, const Truth&, int k)
//       the belief of pose k - 1 becomes the predicted one of pose k.
//   auto linearised(const Belief& predicted, const Layout&, const Truth&) const
//       a function (j, sighting) -> Linearised, with a member `frame`: the rotation from the body frame into the one in
//       which its rows and innovations are.
//   void update(Belief&, const FilterParameters&, const Layout&, const Sighting<Real>*, const EdgeMeasurement&,
//               const Linearisation&, Update&)
//       the predicted belief becomes the updated one; `update` gets the correction, the NIS of the first linearisation,
//       its rows, and whether every S was positive definite.
//   void initialise(Belief&, const FilterParameters&, const Layout&, int j, const Sighting<Real>&, const Truth&)
//       after the update, feature j enters the belief where it is seen for the first time, in place of whatever was
//       believed of it; in a world where features are not all known from the start, and with a heading.
//
// Shapes, units and frames are those of filter.hpp and update.hpp. The truth is that of pose k: an estimator that looks
// at it cannot be had in the world, and says so. An estimator must not draw, must not branch on a Real (several trials
// run at once), and writes nothing but the belief, the update and itself. What the judge takes as its error is
// x^ - x, heading wrapped [judge.hpp], whatever chart its own mathematics live in.

#include "slam/initialise.hpp"
#include "slam/update.hpp"

#include <type_traits>

namespace credence {
inline namespace CREDENCE_TARGET {

/// The extended Kalman filter, and in the translation model the Kalman filter [model.md, Filter].
template <class Layout, class Real>
struct KalmanFilter {
    using State = Belief<Real, Layout::capacity>;
    using World = Truth<Real, Layout::feature_capacity>;

    void start(const Layout&, const State&, const World&) {}

    void predict(State& belief, const FilterParameters& filter, const Layout& layout, const Command<Real>& command,
                 const World&, int k) {
        predict_robot(belief, filter, layout, command);
        predict_features(belief, filter, layout, k);
    }

    AtMean<Layout, Real> linearised(const State& predicted, const Layout&, const World&) const {
        return AtMean<Layout, Real>(predicted.mean);
    }

    template <class EdgeMeasurement, class Linearisation>
    void update(State& belief, const FilterParameters& filter, const Layout& layout, const Sighting<Real>* sightings,
                const EdgeMeasurement& edge_measurement, const Linearisation& linearised,
                Update<Real, Layout::capacity>& update) {
        update_belief(belief, filter, layout, sightings, edge_measurement, linearised, update);
    }

    void initialise(State& belief, const FilterParameters& filter, const Layout& layout, int j,
                    const Sighting<Real>& sighting, const World&) {
        const Vector2<Real> position = point_at(belief.mean, Layout::position);
        initialise_feature(belief, filter, layout, j, sighting,
                           [&](const Vector2<Real>& place) { return place - position; });
    }
};

/// Whether E provides what is written above; where not, the compiler says what is missing.
template <class E, class Layout, class Real>
constexpr bool meets_the_contract() {
    using State = Belief<Real, Layout::capacity>;
    using World = Truth<Real, Layout::feature_capacity>;
    using EdgeMeasurement = Vector2<Real> (*)(int);
    static_assert(std::is_default_constructible_v<E>, "an estimator is default constructible: a workspace holds it");
    static_assert(requires(E e, const Layout layout, const State state, const World world) {
        e.start(layout, state, world);
    }, "an estimator has start(layout, belief, truth)");
    static_assert(requires(E e, State state, const FilterParameters filter, const Layout layout,
                           const Command<Real> command, const World world) {
        e.predict(state, filter, layout, command, world, 1);
    }, "an estimator has predict(belief, filter, layout, command, truth, k)");
    static_assert(requires(const E e, const Layout layout, const State state, const World world,
                           const Sighting<Real> sighting) {
        e.linearised(state, layout, world)(0, sighting).rows;
        e.linearised(state, layout, world)(0, sighting).innovation;
        e.linearised(state, layout, world).frame;
    }, "an estimator has linearised(belief, layout, truth) const, which gives a function (j, sighting) -> Linearised "
       "with a member frame");
    static_assert(requires(E e, State state, const FilterParameters filter, const Layout layout, const World world,
                           const Sighting<Real>* sightings, const EdgeMeasurement edge,
                           Update<Real, Layout::capacity> update) {
        e.update(state, filter, layout, sightings, edge, e.linearised(state, layout, world), update);
    }, "an estimator has update(belief, filter, layout, sightings, edge_measurement, linearised, update)");
    static_assert(requires(E e, State state, const FilterParameters filter, const Layout layout, const World world,
                           const Sighting<Real> sighting) {
        e.initialise(state, filter, layout, 0, sighting, world);
    }, "an estimator has initialise(belief, filter, layout, j, sighting, truth)");
    return true;
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
