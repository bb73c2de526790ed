#pragma once
// Module slam: the list of all estimators: ESTIMATOR(name, process, type), one line each. The name is used in
// arms.estimators and in arms; then the process model that it is for, and its class template, which
// src/slam/estimators/estimators.hpp includes.

#define CREDENCE_ESTIMATORS(ESTIMATOR)             \
    ESTIMATOR(ekf, heading, KalmanFilter)          \
    ESTIMATOR(kf, translation, KalmanFilter)       \
    ESTIMATOR(ideal, heading, IdealFilter)         \
    ESTIMATOR(fej, heading, FirstEstimatesFilter)  \
    ESTIMATOR(riekf, heading, RightInvariantFilter) \
    ESTIMATOR(iekf, heading, IteratedFilter)
