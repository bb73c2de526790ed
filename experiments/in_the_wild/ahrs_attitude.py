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


def trial(rng, variances="its own", span=np.pi):
    sensors = Sensors(num_samples=101, freq=100.0, gyr_noise=GYRO, span=(-span, span), rng=rng)
    given = {"noises": noises(sensors)} if variances == "simulated" else {}
    ekf = EKF(frequency=100.0, magnetic_ref=sensors.reference_magnetic_vector, P=P0, **given)
    ekf.mag = sensors.magnetometers  # update() expects magnetometers where the filter has some
    start = Rotation.from_quat(sensors.quaternions[0], scalar_first=True)
    q, told = (start * Rotation.from_rotvec(0.05 * rng.standard_normal(3))).as_quat(scalar_first=True), []
    for k in range(1, 101):
        q = ekf.update(q, sensors.gyroscopes[k], sensors.accelerometers[k], sensors.magnetometers[k])
        w, x, y, z = q
        turn = 2 * np.array([[-x, w, z, -y], [-y, -z, w, x], [-z, y, -x, w]])  # rotation vector of dq, in the body
        told.append((np.array(sensors.quaternions[k]), q, turn @ ekf.P @ turn.T))
    return tuple(map(np.array, zip(*told)))


def record(trials):
    truth, estimate, covariance = map(np.array, zip(*trials))
    shape = {"manifold": "SO3", "chart": "local", "quaternion": "wxyz", "component_names": ["rx", "ry", "rz"]}
    return {"truth": truth, "estimate": estimate, "covariance": covariance, **shape}


def own_nees(trials):
    truth, estimate = ([Rotation.from_quat(trial[i], scalar_first=True) for trial in trials] for i in (0, 1))
    error = [(true.inv() * estimated).as_rotvec() for true, estimated in zip(truth, estimate)]
    return nees(np.array(error), np.array([covariance for _, _, covariance in trials]))


if __name__ == "__main__":
    print(credence.judge(**record([trial(np.random.default_rng([1, i])) for i in range(500)])))
