#pragma once
// The contract of an estimator, and the (extended) Kalman filter, with which most are compared.
//
// An estimator is a class template E<Layout, Real> that a trial keeps in its workspace. It holds the state that it
// needs from pose to pose beside the belief, and provides:
//
//   void start(const Layout&, const Belief&, const Truth&)
//       called at pose 0, with the initialised belief; sets all of the estimator's own state.
//   void predict(Belief&, const FilterParameters&, const Layout&, const Command<Real>&, const Truth&, int k)
//       turns the belief of pose k - 1 into the predicted one of pose k.
//   auto linearised(const Belief& predicted, const Layout&, const Truth&) const
//       returns a function (j, sighting) -> Linearised, with a member `frame`: the rotation from the body frame into
//       the frame of its rows and innovations.
//   void update(Belief&, const FilterParameters&, const Layout&, const Sighting<Real>*, const EdgeMeasurement&,
//               const Linearisation&, Update&)
//       turns the predicted belief into the updated one; `update`, an Update or derived from it, receives the
//       correction, the NIS of the first linearisation, its rows, and whether every S was positive definite.
//   void initialise(Belief&, const FilterParameters&, const Layout&, int j, const Sighting<Real>&, const Truth&)
//       called after the update: adds feature j to the belief in the lanes in which it is seen (for the first time),
//       replacing its earlier estimate. Only worlds in which features are not all known from the start, and that have a
//       heading, call it.
//
// Dimensions, units and frames are those of filter.hpp and update.hpp. The truth is that of pose k: an estimator that
// uses it cannot be implemented on a robot, and its documentation must say so. An estimator must not draw random
// numbers, must not branch on a Real (several trials run at once), and modifies only the belief, the update and itself.
// Its error is always evaluated as x^ - x, heading wrapped (src/slam/trial/step_evaluation.hpp), whatever chart its own
// equations use.

#include "slam/initialise.hpp"
#include "slam/update.hpp"

#include <type_traits>

namespace credence {
inline namespace CREDENCE_TARGET {

/// The extended Kalman filter, which in the translation model is the Kalman filter [docs/model.md, Filter].
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

    template <class EdgeMeasurement, class Linearisation, class Updating>
    void update(State& belief, const FilterParameters& filter, const Layout& layout, const Sighting<Real>* sightings,
                const EdgeMeasurement& edge_measurement, const Linearisation& linearised, Updating& update) {
        update_belief(belief, filter, layout, sightings, edge_measurement, linearised, update);
    }

    void initialise(State& belief, const FilterParameters& filter, const Layout& layout, int j,
                    const Sighting<Real>& sighting, const World&) {
        const Vector2<Real> position = point_at(belief.mean, Layout::position);
        initialise_feature(belief, filter, layout, j, sighting,
                           [&](const Vector2<Real>& place) { return place - position; });
    }
};

/// Whether E meets the contract above; where it does not, the compiler reports what is missing.
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
