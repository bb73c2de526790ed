"""GTSAM: pose SLAM by iSAM2 with a loop closure, with the numbers and the rule of its Pose2ISAM2Example.py."""

from math import pi, radians

import gtsam
import numpy as np
from common import nees

import credence
from credence import adapters

PRIOR, ODOMETRY = np.array([0.3, 0.3, radians(5)]), np.array([0.2, 0.2, radians(5)])  # m, m, rad
STEPS = [(2, 0, 0)] + [(2, 0, pi / 2)] * 4  # a square, whose last pose is the second again


def closes(odometry, estimate, last):
    """The pose that odometry from the last one leads back to, by the example's rule."""
    at = estimate.atPose2(last)
    x, y = at.translation() + at.rotation().matrix() @ odometry[:2]
    for k in range(1, last):
        pose = estimate.atPose2(k)
        near = max(abs(pose.x() - x), abs(pose.y() - y)) <= 0.8
        if near and abs(pose.theta() - at.theta() - odometry[2]) <= radians(25):
            return k


def run(rng, only_new_factors=False, marginals_of="graph"):
    prior, odometry = (gtsam.noiseModel.Diagonal.Sigmas(sigmas) for sigmas in (PRIOR, ODOMETRY))
    isam = gtsam.ISAM2(gtsam.ISAM2Params())
    graph, new, estimate = gtsam.NonlinearFactorGraph(), gtsam.NonlinearFactorGraph(), gtsam.Values()
    truth, told = {1: gtsam.Pose2(*(PRIOR * rng.standard_normal(3)))}, []
    new.push_back(gtsam.PriorFactorPose2(1, gtsam.Pose2(), prior))
    estimate.insert(1, gtsam.Pose2(0.5, 0.0, 0.2))
    initial = gtsam.Values(estimate)
    for last, step in enumerate(STEPS, start=1):
        measured = step + ODOMETRY * rng.standard_normal(3)
        now = closes(measured, estimate, last) or last + 1
        new.push_back(gtsam.BetweenFactorPose2(last, now, gtsam.Pose2(*measured), odometry))
        graph.push_back(new)
        if now > last:
            truth[now] = truth[last].compose(gtsam.Pose2(*step))
            initial.insert(now, estimate.atPose2(last).compose(gtsam.Pose2(*measured)))
        isam.update(new if only_new_factors else graph, initial)
        new, initial, estimate = gtsam.NonlinearFactorGraph(), gtsam.Values(), isam.calculateEstimate()
        marginals = gtsam.Marginals(graph, estimate) if marginals_of == "graph" else isam
        told.append((truth[now], estimate.atPose2(now), marginals.marginalCovariance(now)))
    return credence.Run.of_record(adapters.from_gtsam_poses(*([each] for each in zip(*told))))


def own_nees(record):
    trials = zip(record["truth"], record["estimate"])
    error = [[gtsam.Pose2(*e).localCoordinates(gtsam.Pose2(*t)) for t, e in zip(*poses)] for poses in trials]
    return nees(np.array(error), record["covariance"])


if __name__ == "__main__":
    print(credence.simulate(run, trials=1000))
