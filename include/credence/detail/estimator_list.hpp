#pragma once
// Module slam: every estimator there is: ESTIMATOR(name, process, type), one line each. Its name in arms.estimators and in
// arms, the process model that it is for, and the class template that it is, which estimators.hpp includes.

#define CREDENCE_ESTIMATORS(ESTIMATOR)             \
    ESTIMATOR(ekf, heading, KalmanFilter)          \
    ESTIMATOR(kf, translation, KalmanFilter)       \
    ESTIMATOR(ideal, heading, IdealFilter)         \
    ESTIMATOR(fej, heading, FirstEstimatesFilter)  \
    ESTIMATOR(riekf, heading, RightInvariantFilter) \
    ESTIMATOR(iekf, heading, IteratedFilter)
