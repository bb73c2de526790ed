#pragma once
// NEES with the error in the invariant chart, beside that of the Euclidean one [docs/theory/estimators.md, NEES].
//
//   e = x^ - x [n], Euclidean, heading wrapped; the error of the right-invariant filter's chart, mapped to the space in
//   which P is kept, is (e_theta, V(-e_theta)^-1 e_p for every point p), V as in right_invariant.hpp

#include "slam/estimators/right_invariant.hpp"

namespace credence {

inline namespace CREDENCE_TARGET {

/// The error in the invariant chart: V(-a)^-1 = V(a) / |V(a)|^2, V being a rotation times a factor. [n].
template <class Layout, class Real>
void invariant_error(const Layout& layout, const Real* error, Real* invariant) {
    const Real turn = error[Layout::heading];
    const Rotation<Real> V = chord(turn);
    const Real shrink = Real(1) / fma(V.cosine, V.cosine, V.sine * V.sine);
    const Rotation<Real> inverse{V.cosine * shrink, V.sine * shrink};
    const int n = layout.size();
    invariant[Layout::heading] = turn;
    for (int point = Layout::position; point < n; point += 2) {
        const Vector2<Real> straight = rotate(inverse, point_at(error, point));
        invariant[point] = straight.x;
        invariant[point + 1] = straight.y;
    }
}

template <class Real>
struct InvariantNees {
    Real all{}, pose{};
};

/// NEES of the whole state and of the pose, with the same P as in the Euclidean chart.
template <class Layout, class Real, int capacity>
[[gnu::noinline]] InvariantNees<Real> nees_in_invariant_chart(const Belief<Real, capacity>& belief,
                                                              const Layout& layout, const Real* error,
                                                              Elimination<Real, capacity>& work) {
    Real invariant[capacity];
    invariant_error(layout, error, invariant);
    InvariantNees<Real> nees;
    const auto whole = [&](int last) {  // rolled loops: few scenarios ask for this chart
        Real value{};
        nested_squared_errors<Layout::by_axis>(belief.covariance, invariant, 0, last, work,
                                               [&](int, const SquaredError<Real>& sum) { value = sum.value; });
        return value;
    };
    nees.all = whole(layout.size());
    nees.pose = whole(Layout::pose_size);
    return nees;
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
