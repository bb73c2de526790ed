"""ahrs: its extended Kalman filter of an attitude, on gyroscopes, accelerometers and magnetometers of its Sensors."""

import numpy as np
from ahrs import Sensors
from ahrs.filters import EKF
from common import nees
from scipy.spatial.transform import Rotation

import credence

GYRO = 1.0  # deg/s, standard deviation of a sample
P0 = 0.05**2 / 4 * np.eye(4)  # of the quaternion: 0.05 rad in each direction


def noises(sensors):
    """The variances of the EKF: of gyroscopes, and of accelerometers and magnetometers scaled to unit length."""
    gravity, field = sensors.reference_gravitational_vector, sensors.reference_magnetic_vector
    unit = [sensors.acc_noise / np.linalg.norm(gravity), sensors.mag_noise / np.linalg.norm(field)]
    return np.array([np.radians(GYRO), *unit]) ** 2


def run(rng, variances="its own", span=np.pi):
    sensors = Sensors(num_samples=101, freq=100.0, gyr_noise=GYRO, span=(-span, span), rng=rng)
    its_own = isinstance(variances, str) and variances == "its own"
    given = {} if its_own else {"noises": noises(sensors) if isinstance(variances, str) else variances}
    ekf = EKF(frequency=100.0, magnetic_ref=sensors.reference_magnetic_vector, P=P0, **given)
    ekf.mag = sensors.magnetometers  # update() expects magnetometers where the filter has some
    start = Rotation.from_quat(sensors.quaternions[0], scalar_first=True)
    q, told = (start * Rotation.from_rotvec(0.05 * rng.standard_normal(3))).as_quat(scalar_first=True), []
    for k in range(1, 101):
        q = ekf.update(q, sensors.gyroscopes[k], sensors.accelerometers[k], sensors.magnetometers[k])
        w, x, y, z = q
        turn = 2 * np.array([[-x, w, z, -y], [-y, -z, w, x], [-z, y, -x, w]])  # rotation vector of dq, in the body
        told.append((np.array(sensors.quaternions[k]), q, turn @ ekf.P @ turn.T))
    truth, estimate, covariance = zip(*told)
    shape = {"manifold": "SO3", "chart": "local", "quaternion": "wxyz", "component_names": ["rx", "ry", "rz"]}
    return credence.Run(truth=truth, estimate=estimate, covariance=covariance, **shape)


def own_nees(record):
    states = ([Rotation.from_quat(run, scalar_first=True) for run in record[name]] for name in ("truth", "estimate"))
    error = [(true.inv() * estimated).as_rotvec() for true, estimated in zip(*states)]
    return nees(np.array(error), record["covariance"])


if __name__ == "__main__":
    print(credence.simulate(run, trials=500))
