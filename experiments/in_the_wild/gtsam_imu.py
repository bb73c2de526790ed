"""GTSAM: preintegration of an IMU on a vertical loop, with the numbers of its PreintegrationExample.py."""

import gtsam
import numpy as np

import credence

GYRO, ACCELEROMETER, DT = np.radians(0.5) / 60, 0.1 / 60, 0.01  # rad/s/√Hz, m/s²/√Hz, s
BIAS = gtsam.imuBias.ConstantBias(np.array([0, 0.1, 0]), np.zeros(3))
GROUPS = {"rotation": range(3), "position": range(3, 6), "velocity": range(6, 9)}
LOOP = gtsam.ConstantTwistScenario(np.array([0, -np.radians(30), 0]), np.array([2.0, 0, 0]))


def parameters(scale=1.0):
    result = gtsam.PreintegrationParams.MakeSharedU(10)
    result.setGyroscopeCovariance((scale * GYRO) ** 2 * np.eye(3))
    result.setAccelerometerCovariance((scale * ACCELEROMETER) ** 2 * np.eye(3))
    result.setIntegrationCovariance(1e-7**2 * np.eye(3))
    return result


RUNNER = gtsam.ScenarioRunner(LOOP, parameters(), DT, BIAS)
OMEGA = np.array([RUNNER.actualAngularVelocity(k * DT) + BIAS.gyroscope() for k in range(1200)])
FORCE = np.array([RUNNER.actualSpecificForce(k * DT) + BIAS.accelerometer() for k in range(1200)])


def integrate(noise, seconds, scale=1.0):
    """The preintegration after each second; noise has a row of six numbers, of unit variance, for each sample."""
    preintegrated, result = gtsam.PreintegratedImuMeasurements(parameters(scale), BIAS), []
    force = FORCE + ACCELEROMETER / DT**0.5 * noise[:, :3]
    omega = OMEGA + GYRO / DT**0.5 * noise[:, 3:]
    for k in range(100 * seconds):
        preintegrated.integrateMeasurement(force[k], omega[k], DT)
        if (k + 1) % 100 == 0:
            predicted = preintegrated.predict(LOOP.navState(0), BIAS)
            result.append((preintegrated.preintegrated(), predicted, preintegrated.preintMeasCov()))
    return result


def run(rng, chart="state", seconds=12, scale=1.0):
    told = integrate(rng.standard_normal((1200, 6)), seconds, scale)
    if chart == "state":  # of predict(), at the estimate, against the scenario's truth
        error = [-state.localCoordinates(LOOP.navState(float(k))) for k, (_, state, _) in enumerate(told, start=1)]
    else:  # of preintegrated(), against the same sums without noise
        exact = integrate(np.zeros((1200, 6)), seconds)
        error = [increment - without_noise for (increment, _, _), (without_noise, _, _) in zip(told, exact)]
    covariance = [covariance for _, _, covariance in told]
    names = [f"{group[0]}{axis}" for group in GROUPS for axis in "xyz"]
    return credence.Run(error, covariance, groups=GROUPS, component_names=names)


if __name__ == "__main__":
    print(credence.simulate(run, trials=500))
