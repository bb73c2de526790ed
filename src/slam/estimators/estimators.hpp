#pragma once
// Selects an estimator of estimator_list.hpp by name.

#include "slam/estimators/first_estimates.hpp"
#include "slam/estimators/ideal.hpp"
#include "slam/estimators/iterated.hpp"
#include "slam/estimators/right_invariant.hpp"

namespace credence {

/// An estimator as a tag that can be passed as an argument: tag::type<Layout, Real>.
template <template <class, class> class Type>
struct EstimatorTag {
    template <class Layout, class Real>
    using type = Type<Layout, Real>;
};

inline namespace CREDENCE_TARGET {

/// The process model's own estimator, the only one for which loops over features are written out.
constexpr Estimator own_estimator(Process process) {
    return process == Process::heading ? Estimator::ekf : Estimator::kf;
}

/// Calls use(EstimatorTag) with the tag of the named estimator for this process.
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
