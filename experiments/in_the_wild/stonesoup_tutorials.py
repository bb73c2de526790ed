"""Stone Soup: tutorials 1 (Kalman filter), 2 (extended) and 3 (unscented), with their models and numbers."""

from datetime import datetime, timedelta

import numpy as np
from stonesoup.models.measurement.linear import LinearGaussian
from stonesoup.models.measurement.nonlinear import CartesianToBearingRange
from stonesoup.models.transition.linear import CombinedLinearGaussianTransitionModel, ConstantVelocity
from stonesoup.predictor.kalman import ExtendedKalmanPredictor, KalmanPredictor, UnscentedKalmanPredictor
from stonesoup.types.detection import Detection
from stonesoup.types.hypothesis import SingleHypothesis
from stonesoup.types.state import GaussianState, State
from stonesoup.updater.kalman import ExtendedKalmanUpdater, KalmanUpdater, UnscentedKalmanUpdater

import credence
from credence import adapters

START, SECOND = datetime(2026, 1, 1), timedelta(seconds=1)
MEAN, P0 = np.array([0, 1, 0, 1]), np.diag([1.5, 0.5, 1.5, 0.5])  # x, its speed, y, its speed
MOTION = CombinedLinearGaussianTransitionModel([ConstantVelocity(0.05), ConstantVelocity(0.05)])
POSITION = LinearGaussian(4, (0, 2), 5 * np.eye(2))
RADAR = CartesianToBearingRange(4, (0, 2), np.diag([np.radians(5) ** 2, 1]), translation_offset=np.array([[50], [0]]))
TUTORIALS = {
    "kf": (POSITION, KalmanPredictor, KalmanUpdater),
    "ekf": (RADAR, ExtendedKalmanPredictor, ExtendedKalmanUpdater),
    "ukf": (RADAR, UnscentedKalmanPredictor, UnscentedKalmanUpdater),
}


def run(rng, kind, start="known"):
    sensor, predictor, updater = TUTORIALS[kind]
    predictor, updater = predictor(MOTION), updater(sensor)
    np.random.seed(rng.integers(2**32))  # the tutorials draw from NumPy's global generator
    truth = State((MEAN if start == "known" else rng.multivariate_normal(MEAN, P0)).reshape(4, 1), START)
    posterior, told = GaussianState(MEAN.reshape(4, 1), P0, START), []
    for k in range(21):
        if k > 0:
            truth = State(MOTION.function(truth, noise=True, time_interval=SECOND), START + k * SECOND)
        detection = Detection(sensor.function(truth, noise=True), truth.timestamp, measurement_model=sensor)
        prediction = predictor.predict(posterior, timestamp=detection.timestamp)
        posterior = updater.update(SingleHypothesis(prediction, detection))
        told.append((truth, posterior))
    names = {"component_names": ["x", "vx", "y", "vy"]}
    return credence.Run.of_record(adapters.from_stonesoup(*([each] for each in zip(*told))) | names)


if __name__ == "__main__":
    print(credence.simulate(run, trials=1000, arms={"kf": {"kind": "kf"}}))
