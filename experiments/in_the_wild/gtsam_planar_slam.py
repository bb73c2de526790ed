"""GTSAM: planar SLAM by joint marginals, with the numbers of its PlanarSLAMExample.py."""

import gtsam
import numpy as np
from gtsam import Point2, Pose2
from gtsam.symbol_shorthand import L, X

import credence

PRIOR, ODOMETRY, SIGHT = np.array([0.3, 0.3, 0.1]), np.array([0.2, 0.2, 0.1]), np.array([0.1, 0.2])  # m, rad; rad, m
KEYS = [X(1), X(2), X(3), L(4), L(5)]
GROUPS = {"x1": range(3), "x2": range(3, 6), "x3": range(6, 9), "l1": range(9, 11), "l2": range(11, 13)}
NAMES = [f"{group}{axis}" for group, members in GROUPS.items() for axis in "xyt"[: len(members)]]
GUESS = [(-0.25, 0.20, 0.15), (2.30, 0.10, -0.20), (4.10, 0.10, 0.10), (1.80, 2.10), (4.10, 1.80)]


def run(rng):
    prior, odometry, sight = (gtsam.noiseModel.Diagonal.Sigmas(sigmas) for sigmas in (PRIOR, ODOMETRY, SIGHT))
    graph, truth, initial = gtsam.NonlinearFactorGraph(), gtsam.Values(), gtsam.Values()
    pose = Pose2.Expmap(PRIOR * rng.standard_normal(3))
    graph.add(gtsam.PriorFactorPose2(X(1), Pose2(), prior))
    for k in (1, 2, 3):
        truth.insert(X(k), pose)
        pose = pose.compose(Pose2(2, 0, 0))
        measured = Pose2(2, 0, 0).compose(Pose2.Expmap(ODOMETRY * rng.standard_normal(3)))
        if k < 3:
            graph.add(gtsam.BetweenFactorPose2(X(k), X(k + 1), measured, odometry))
    truth.insert(L(4), Point2(2, 2))
    truth.insert(L(5), Point2(4, 2))
    for seen_from, landmark in ((X(1), L(4)), (X(2), L(4)), (X(3), L(5))):
        at, point, noise = truth.atPose2(seen_from), truth.atPoint2(landmark), SIGHT * rng.standard_normal(2)
        bearing, distance = at.bearing(point).retract(noise[:1]), at.range(point) + noise[1]
        graph.add(gtsam.BearingRangeFactor2D(seen_from, landmark, bearing, distance, sight))
    for key, guess in zip(KEYS, GUESS):
        initial.insert(key, Pose2(*guess) if len(guess) == 3 else Point2(*guess))
    estimate = gtsam.LevenbergMarquardtOptimizer(graph, initial).optimize()
    back = estimate.localCoordinates(truth)  # in the chart of the marginals: tangent at the estimate
    marginals = gtsam.Marginals(graph, estimate)
    error = -np.concatenate([back.at(key) for key in KEYS])
    covariance = marginals.jointMarginalCovariance(KEYS).fullMatrix()
    return credence.Run(error[None], covariance[None], groups=GROUPS, component_names=NAMES)


if __name__ == "__main__":
    print(credence.simulate(run, trials=1000))
