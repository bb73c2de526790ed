#pragma once
// The estimators of estimator_list.hpp, chosen by name.

#include "slam/estimators/first_estimates.hpp"
#include "slam/estimators/ideal.hpp"
#include "slam/estimators/iterated.hpp"
#include "slam/estimators/right_invariant.hpp"

namespace credence {

/// An estimator as something to pass: tag::type<Layout, Real>.
template <template <class, class> class Type>
struct EstimatorTag {
    template <class Layout, class Real>
    using type = Type<Layout, Real>;
};

inline namespace CREDENCE_TARGET {

/// The process model's own estimator, which alone runs where features are written out.
constexpr Estimator own_estimator(Process process) {
    return process == Process::heading ? Estimator::ekf : Estimator::kf;
}

/// Calls use(EstimatorTag) with the one of that name for this process.
template <Process process, class Use>
auto with_estimator(Estimator estimator, const Use& use) {
    switch (estimator) {
#define CREDENCE_ESTIMATOR(name, of, Type)                                                 \
    case Estimator::name:                                                                  \
        if constexpr (process == Process::of) return use(EstimatorTag<Type>{});            \
        break;
        CREDENCE_ESTIMATORS(CREDENCE_ESTIMATOR)
#undef CREDENCE_ESTIMATOR
    }
    return use(EstimatorTag<KalmanFilter>{});
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
